#include "meshing/parts/part_section.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "iga/core/error.h"
#include "meshing/parts/planar_mesh.h"

namespace couture::meshing {

namespace {

/// Relative to the part's size.
constexpr double plane_move = 1e-6;
constexpr double shortest_edge = 1e-5;

using Edge = std::pair<int, int>;

double size_of(const TriangleSoup& soup) {
    Vector3 low = soup.points.front();
    Vector3 high = low;
    for (const Vector3& x : soup.points) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    return (high - low).norm();
}

/// Distances from the plane, positive where the part is left; none is 0.
std::vector<double> distances_from_plane(const TriangleSoup& soup, int axis, double place,
                                         int kept) {
    const double step = plane_move * size_of(soup);
    std::vector<double> distances(soup.points.size());
    for (int i = 1;; ++i) {
        double nearest = step;
        for (std::size_t v = 0; v < distances.size(); ++v) {
            distances[v] = kept * (soup.points[v][axis] - place) - i * step;
            nearest = std::min(nearest, std::abs(distances[v]));
        }
        if (nearest > 1e-3 * step) {
            return distances;
        }
    }
}

class Cutter {
  public:
    Cutter(const PartSurface& part, int axis, double place, int kept)
        : part_(part),
          points_(part.soup.points),
          axis_(axis),
          place_(place),
          kept_(kept),
          distances_(distances_from_plane(part.soup, axis, place, kept)) {}

    PartSection run() {
        for (std::size_t t = 0; t < part_.soup.triangles.size(); ++t) {
            cut_triangle(part_.soup.triangles[t], part_.face_of_triangle[t]);
        }
        if (next_.empty()) {
            const auto [low, high] = std::minmax_element(
                points_.begin(), points_.end(),
                [this](const Vector3& x, const Vector3& y) { return x[axis_] < y[axis_]; });
            throw GeometryError(
                "cut_part: the plane {} = {:.6g} does not meet the part, which lies in [{:.6g}, "
                "{:.6g}]; "
                "choose a place in it",
                "xyz"[axis_], place_, (*low)[axis_], (*high)[axis_]);
        }
        for (const PartCurve& curve : part_.feature_curves) {
            cut_curve(curve);
        }
        trace_outlines();
        fill_outlines();
        return section_;
    }

  private:
    /// Where an edge meets the plane: the same bits from both of its triangles.
    [[nodiscard]] Vector3 crossing(int a, int b) const {
        const auto [low, high] = std::minmax(a, b);
        const double t = distances_[low] / (distances_[low] - distances_[high]);
        return points_[low] + t * (points_[high] - points_[low]);
    }

    /// Number in the rest of a vertex of the part.
    int number_of(int vertex) { return number_of({vertex, vertex}, points_[vertex]); }

    /// Number in the rest of the place where an edge meets the plane.
    int number_at(int a, int b) { return number_of(std::minmax(a, b), crossing(a, b)); }

    int number_of(const Edge& edge, const Vector3& x) {
        const auto [entry, is_new] =
            numbers_.try_emplace(edge, static_cast<int>(section_.rest.points.size()));
        if (is_new) {
            section_.rest.points.push_back(x);
        }
        return entry->second;
    }

    void add_triangle(int a, int b, int c, int face) {
        section_.rest.triangles.push_back({a, b, c});
        section_.face_of_triangle.push_back(face);
    }

    void cut_triangle(std::array<int, 3> triangle, int face) {
        const auto is_left = [&](int v) { return distances_[v] > 0.0; };
        const auto n_left = std::count_if(triangle.begin(), triangle.end(), is_left);
        if (n_left == 0) {
            return;
        }
        if (n_left == 3) {
            add_triangle(number_of(triangle[0]), number_of(triangle[1]), number_of(triangle[2]),
                         face);
            return;
        }
        // The vertex that is alone on its side comes first.
        while (is_left(triangle[0]) != (n_left == 1) ||
               is_left(triangle[1]) != is_left(triangle[2])) {
            std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
        }
        const auto [a, b, c] = triangle;
        const int ab = number_at(a, b);
        const int ca = number_at(c, a);
        if (n_left == 1) {
            add_triangle(number_of(a), ab, ca, face);
            next_[std::minmax(c, a)] = std::minmax(a, b);
        } else {
            add_triangle(ab, number_of(b), number_of(c), face);
            add_triangle(ab, number_of(c), ca, face);
            next_[std::minmax(a, b)] = std::minmax(c, a);
        }
    }

    void cut_curve(const PartCurve& curve) {
        const std::size_t n = curve.vertices.size();
        std::vector<Vector3> piece;
        const auto finish = [&] {
            if (piece.size() > 1) {
                section_.feature_curves.push_back(piece);
            }
            piece.clear();
        };
        for (std::size_t i = 0; i < n + (curve.is_closed ? 1 : 0); ++i) {
            const int v = curve.vertices[i % n];
            const bool is_left = distances_[v] > 0.0;
            if (i > 0) {
                const int before = curve.vertices[i - 1];
                if ((distances_[before] > 0.0) != is_left) {
                    piece.push_back(crossing(before, v));
                }
            }
            if (is_left) {
                piece.push_back(points_[v]);
            } else {
                finish();
            }
        }
        finish();
    }

    /// `next_` leads around the cut face with the part on the left, seen from what is taken away.
    void trace_outlines() {
        const double shortest = shortest_edge * size_of(part_.soup);
        while (!next_.empty()) {
            const Edge first = next_.begin()->first;
            std::vector<Vector3> outline;
            Edge edge = first;
            do {
                const Vector3 x = crossing(edge.first, edge.second);
                if (outline.empty() || (x - outline.back()).norm() > shortest) {
                    outline.push_back(x);
                }
                const auto entry = next_.find(edge);
                assert(entry != next_.end());
                edge = entry->second;
                next_.erase(entry);
            } while (edge != first);
            while (outline.size() > 1 && (outline.front() - outline.back()).norm() <= shortest) {
                outline.pop_back();
            }
            if (outline.size() > 2) {
                section_.outlines.push_back(outline);
            }
        }
    }

    void fill_outlines() {
        // Seen from what is taken away u turns to v counter-clockwise.
        const int u = kept_ < 0 ? (axis_ + 1) % 3 : (axis_ + 2) % 3;
        const int v = kept_ < 0 ? (axis_ + 2) % 3 : (axis_ + 1) % 3;
        const double height = section_.outlines.front().front()[axis_];
        std::vector<std::vector<Vector2>> loops;
        for (const std::vector<Vector3>& outline : section_.outlines) {
            loops.emplace_back();
            for (const Vector3& x : outline) {
                loops.back().emplace_back(x[u], x[v]);
            }
        }
        const double large = 10.0 * size_of(part_.soup);
        const PlanarMesh mesh =
            mesh_planar_region(loops, [large](const Vector2& /*place*/) { return large; });
        for (const Vector2& p : mesh.points) {
            Vector3 x = Vector3::Constant(height);
            x[u] = p.x();
            x[v] = p.y();
            section_.cut.points.push_back(x);
        }
        section_.cut.triangles = mesh.triangles;
    }

    const PartSurface& part_;
    const std::vector<Vector3>& points_;
    int axis_;
    double place_;
    int kept_;
    std::vector<double> distances_;
    /// Numbers in the rest of vertices (a, a) and of crossed edges.
    std::map<Edge, int> numbers_;
    /// From one crossed edge to the next.
    std::map<Edge, Edge> next_;
    PartSection section_;
};

}  // namespace

PartSection cut_part(const PartSurface& part, int axis, double place, int kept) {
    return Cutter(part, axis, place, kept).run();
}

}  // namespace couture::meshing
