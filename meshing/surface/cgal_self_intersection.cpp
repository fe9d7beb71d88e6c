#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "iga/core/error.h"
#include "meshing/surface/self_intersection.h"

namespace couture::meshing {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;

struct Box {
    Vector3 low = Vector3::Zero();
    Vector3 high = Vector3::Zero();

    void add(const Box& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
    [[nodiscard]] bool overlaps(const Box& other) const {
        return (low.array() <= other.high.array()).all() &&
               (other.low.array() <= high.array()).all();
    }
};

/// Boxes in a binary tree, halved along the longest side.
class BoxTree {
  public:
    explicit BoxTree(const std::vector<Box>& boxes) : boxes_(boxes), items_(boxes.size()) {
        std::iota(items_.begin(), items_.end(), 0);
        if (!items_.empty()) build(0, items_.size());
    }

    /// Numbers above `first` of boxes that overlap its own, ascending.
    void find_later(int first, std::vector<int>& found) const {
        found.clear();
        if (!items_.empty()) find_later(0, first, found);
        std::sort(found.begin(), found.end());
    }

  private:
    struct Node {
        Box box;
        std::size_t begin = 0;
        std::size_t end = 0;
        /// Largest number in it.
        int last = 0;
        /// The first child follows its parent; 0: a leaf.
        std::size_t second_child = 0;
    };
    static constexpr std::size_t leaf_size = 4;

    void build(std::size_t begin, std::size_t end) {
        const std::size_t number = nodes_.size();
        nodes_.push_back({boxes_[items_[begin]], begin, end, 0, 0});
        for (std::size_t i = begin; i < end; ++i) {
            nodes_[number].box.add(boxes_[items_[i]]);
            nodes_[number].last = std::max(nodes_[number].last, items_[i]);
        }
        if (end - begin <= leaf_size) return;
        int axis = 0;
        (nodes_[number].box.high - nodes_[number].box.low).maxCoeff(&axis);
        const std::size_t middle = begin + (end - begin) / 2;
        const auto key = [&](int i) { return boxes_[i].low[axis] + boxes_[i].high[axis]; };
        const auto at = [&](std::size_t i) {
            return items_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [&](int i, int j) {
            return key(i) < key(j) || (key(i) == key(j) && i < j);
        });
        build(begin, middle);
        nodes_[number].second_child = nodes_.size();
        build(middle, end);
    }

    void find_later(std::size_t number, int first, std::vector<int>& found) const {
        const Node& node = nodes_[number];
        if (node.last <= first || !node.box.overlaps(boxes_[first])) return;
        if (node.second_child != 0) {
            find_later(number + 1, first, found);
            find_later(node.second_child, first, found);
            return;
        }
        for (std::size_t i = node.begin; i < node.end; ++i) {
            const int item = items_[i];
            if (item > first && boxes_[item].overlaps(boxes_[first])) found.push_back(item);
        }
    }

    const std::vector<Box>& boxes_;
    std::vector<int> items_;
    std::vector<Node> nodes_;
};

class Crossings {
  public:
    explicit Crossings(const TriangleSoup& soup) : soup_(soup) {}

    [[nodiscard]] bool is_flat(int t) const {
        const auto [a, b, c] = soup_.triangles[t];
        return CGAL::collinear(point(a), point(b), point(c));
    }

    [[nodiscard]] bool do_cross(int s, int t) const {
        // Shared vertices first.
        std::array<int, 3> a = soup_.triangles[s];
        std::array<int, 3> b = soup_.triangles[t];
        int n_shared = 0;
        for (int i = 0; i < 3; ++i) {
            const auto same = std::find(b.begin() + n_shared, b.end(), a[i]);
            if (same == b.end()) continue;
            std::swap(a[i], a[n_shared]);
            std::iter_swap(same, b.begin() + n_shared);
            ++n_shared;
        }
        if (n_shared == 3) return false;
        if (n_shared == 2) {
            // In one plane, on the same side of the common edge.
            const Point p = point(a[0]);
            const Point q = point(a[1]);
            return CGAL::coplanar(p, q, point(a[2]), point(b[2])) &&
                   CGAL::coplanar_orientation(p, q, point(a[2]), point(b[2])) == CGAL::POSITIVE;
        }
        const Triangle first(point(a[0]), point(a[1]), point(a[2]));
        const Triangle second(point(b[0]), point(b[1]), point(b[2]));
        if (n_shared == 1) {
            // What they share beyond the vertex ends on one of the sides opposite to it.
            return CGAL::do_intersect(Segment(point(a[1]), point(a[2])), second) ||
                   CGAL::do_intersect(Segment(point(b[1]), point(b[2])), first);
        }
        return CGAL::do_intersect(first, second);
    }

    /// Mean of the points where sides of one pass through the other; else the middle of what their
    /// boxes have in common.
    [[nodiscard]] Vector3 position(int s, int t, const Box& a, const Box& b) const {
        Vector3 sum = Vector3::Zero();
        int n = 0;
        for (const auto& [from, to] : {std::pair(s, t), std::pair(t, s)}) {
            for (int i = 0; i < 3; ++i) {
                const int p = soup_.triangles[from][i];
                const int q = soup_.triangles[from][(i + 1) % 3];
                const auto& corners = soup_.triangles[to];
                if (std::count(corners.begin(), corners.end(), p) > 0 ||
                    std::count(corners.begin(), corners.end(), q) > 0) {
                    continue;
                }
                if (const auto place = passage(soup_.points[p], soup_.points[q], to)) {
                    sum += *place;
                    ++n;
                }
            }
        }
        if (n > 0) return sum / n;
        return 0.5 * (a.low.cwiseMax(b.low) + a.high.cwiseMin(b.high));
    }

  private:
    [[nodiscard]] Point point(int v) const {
        return {soup_.points[v].x(), soup_.points[v].y(), soup_.points[v].z()};
    }

    /// Where a segment passes through a triangle, not parallel to it.
    [[nodiscard]] std::optional<Vector3> passage(const Vector3& from, const Vector3& to,
                                                 int triangle) const {
        const auto [i, j, k] = soup_.triangles[triangle];
        const Vector3 direction = to - from;
        const Vector3 first = soup_.points[j] - soup_.points[i];
        const Vector3 second = soup_.points[k] - soup_.points[i];
        const Vector3 start = from - soup_.points[i];
        const Vector3 p = direction.cross(second);
        const double det = first.dot(p);
        constexpr double parallel = 1e-14;
        if (std::abs(det) <= parallel * first.norm() * direction.norm() * second.norm()) return {};
        const Vector3 q = start.cross(first);
        const double u = start.dot(p) / det;
        const double v = direction.dot(q) / det;
        const double s = second.dot(q) / det;
        constexpr double slack = 1e-9;
        if (std::min({u, v, 1.0 - u - v, s, 1.0 - s}) < -slack) return {};
        return from + s * direction;
    }

    const TriangleSoup& soup_;
};

}  // namespace

SelfIntersections find_self_intersections(const TriangleSoup& soup, std::size_t max_crossings) {
    const int n_points = static_cast<int>(soup.points.size());
    std::vector<Box> boxes;
    boxes.reserve(soup.triangles.size());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto [a, b, c] = soup.triangles[t];
        if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= n_points) {
            throw InputError(
                "find_self_intersections: triangle {} has vertices {}, {}, {}; they must be "
                "numbers below {}",
                t, a, b, c, n_points);
        }
        Box box{soup.points[a], soup.points[a]};
        box.add({soup.points[b], soup.points[b]});
        box.add({soup.points[c], soup.points[c]});
        boxes.push_back(box);
    }
    const BoxTree tree(boxes);
    const Crossings crossings(soup);
    std::vector<bool> is_flat(soup.triangles.size());
    for (std::size_t t = 0; t < is_flat.size(); ++t) {
        is_flat[t] = crossings.is_flat(static_cast<int>(t));
    }
    SelfIntersections result;
    std::vector<int> near;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (is_flat[i]) continue;
        const int s = static_cast<int>(i);
        tree.find_later(s, near);
        for (const int t : near) {
            if (is_flat[t] || !crossings.do_cross(s, t)) continue;
            if (result.crossings.size() == max_crossings) {
                result.is_cut_short = true;
                return result;
            }
            result.crossings.push_back({s, t, crossings.position(s, t, boxes[i], boxes[t])});
        }
    }
    return result;
}

}  // namespace couture::meshing
