#include "meshing/surface/fix_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/surface/hole_filling.h"
#include "meshing/surface/soup_boundary.h"
#include "meshing/surface/soup_sides.h"

namespace couture::meshing {

namespace {

constexpr std::size_t max_places = 10;

/// Points within a distance of each other become the one with the smallest number.
void weld(TriangleSoup& soup, double distance, FixReport& report) {
    if (soup.points.empty() || !(distance > 0.0)) return;
    Vector3 low = soup.points.front();
    for (const Vector3& point : soup.points) low = low.cwiseMin(point);
    using Cell = std::array<long long, 3>;
    const auto cell_of = [&](const Vector3& point) {
        Cell cell;
        for (int k = 0; k < 3; ++k) {
            cell[k] = static_cast<long long>(std::floor((point[k] - low[k]) / distance));
        }
        return cell;
    };
    std::vector<std::pair<Cell, int>> cells;
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        cells.emplace_back(cell_of(soup.points[v]), static_cast<int>(v));
    }
    std::sort(cells.begin(), cells.end());
    DisjointSets sets(soup.points.size());
    for (const auto& [cell, v] : cells) {
        for (long long i = -1; i <= 1; ++i) {
            for (long long j = -1; j <= 1; ++j) {
                const Cell first{cell[0] + i, cell[1] + j, cell[2] - 1};
                auto near = std::lower_bound(cells.begin(), cells.end(), std::pair(first, -1));
                for (; near != cells.end() && near->first[0] == first[0] &&
                       near->first[1] == first[1] && near->first[2] <= cell[2] + 1;
                     ++near) {
                    if (near->second < v &&
                        (soup.points[near->second] - soup.points[v]).norm() <= distance) {
                        sets.join(near->second, v);
                    }
                }
            }
        }
    }
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        const int root = sets.find(static_cast<int>(v));
        if (root == static_cast<int>(v)) continue;
        ++report.n_welded;
        report.largest_move =
            std::max(report.largest_move, (soup.points[root] - soup.points[v]).norm());
    }
    for (auto& triangle : soup.triangles) {
        for (int& vertex : triangle) vertex = sets.find(vertex);
    }
}

/// Triangles at each vertex.
std::vector<std::vector<int>> triangles_at(const TriangleSoup& soup) {
    std::vector<std::vector<int>> at(soup.points.size());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        for (const int v : soup.triangles[t]) at[v].push_back(static_cast<int>(t));
    }
    return at;
}

bool has(const std::array<int, 3>& triangle, int vertex) {
    return std::find(triangle.begin(), triangle.end(), vertex) != triangle.end();
}

/// One pass over flat triangles; what one change touched waits for the next pass.
class FlatRemoval {
  public:
    FlatRemoval(TriangleSoup& soup, double flatness)
        : soup_(soup),
          flatness_(flatness),
          at_(triangles_at(soup)),
          is_open_(soup.points.size(), false),
          is_touched_(soup.triangles.size(), false),
          is_dropped_(soup.triangles.size(), false) {
        const auto sides = sorted_sides(soup);
        for (const auto& edge : edges_of(sides)) {
            if (edge.size() == 1) is_open_[edge[0].low] = is_open_[edge[0].high] = true;
        }
    }

    /// How many triangles went.
    int run() {
        int n_removed = 0;
        const std::size_t n = soup_.triangles.size();
        for (std::size_t i = 0; i < n; ++i) {
            const int t = static_cast<int>(i);
            if (is_touched_[t] || !(relative_height(soup_, t) <= flatness_)) continue;
            n_removed += remove(t);
        }
        std::vector<std::array<int, 3>> left;
        for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
            if (t >= is_dropped_.size() || !is_dropped_[t]) left.push_back(soup_.triangles[t]);
        }
        soup_.triangles = std::move(left);
        return n_removed;
    }

  private:
    [[nodiscard]] double length(int a, int b) const {
        return (soup_.points[a] - soup_.points[b]).norm();
    }

    [[nodiscard]] std::vector<int> triangles_of_edge(int a, int b) const {
        std::vector<int> found;
        for (const int t : at_[a]) {
            if (has(soup_.triangles[t], b)) found.push_back(t);
        }
        return found;
    }

    int remove(int t) {
        // Longest side a, b; apex c.
        int apex = 0;
        double longest = -1.0;
        double shortest = INFINITY;
        int short_side = 0;
        for (int k = 0; k < 3; ++k) {
            const double side =
                length(soup_.triangles[t][(k + 1) % 3], soup_.triangles[t][(k + 2) % 3]);
            if (side > longest) {
                longest = side;
                apex = k;
            }
            if (side < shortest) {
                shortest = side;
                short_side = k;
            }
        }
        const int a = soup_.triangles[t][(apex + 1) % 3];
        const int b = soup_.triangles[t][(apex + 2) % 3];
        const int c = soup_.triangles[t][apex];
        if (shortest <= flatness_ * longest) {
            return collapse(soup_.triangles[t][(short_side + 1) % 3],
                            soup_.triangles[t][(short_side + 2) % 3]);
        }
        return divide_neighbour(t, a, b, c);
    }

    /// Replaces the triangle beyond a, b by two with c.
    int divide_neighbour(int t, int a, int b, int c) {
        const std::vector<int> both = triangles_of_edge(a, b);
        if (both.size() != 2) return 0;
        const int other = both[0] == t ? both[1] : both[0];
        if (is_touched_[other] || has(soup_.triangles[other], c)) return 0;
        // Edge c, d must be new.
        for (const int d : soup_.triangles[other]) {
            if (d != a && d != b && !triangles_of_edge(c, d).empty()) return 0;
        }
        touch_around({a, b, c});
        auto second = soup_.triangles[other];
        std::replace(soup_.triangles[other].begin(), soup_.triangles[other].end(), a, c);
        std::replace(second.begin(), second.end(), b, c);
        soup_.triangles.push_back(second);
        is_dropped_[t] = true;
        return 1;
    }

    /// Makes one vertex of two if what hangs together does not change (link condition).
    int collapse(int a, int b) {
        const std::vector<int> both = triangles_of_edge(a, b);
        if (both.empty() || both.size() > 2) return 0;
        if (both.size() == 2 && is_open_[a] && is_open_[b]) return 0;
        std::set<int> apexes;
        for (const int t : both) {
            for (const int v : soup_.triangles[t]) {
                if (v != a && v != b) apexes.insert(v);
            }
        }
        std::set<int> near_a;
        for (const int t : at_[a]) {
            if (is_touched_[t]) return 0;
            near_a.insert(soup_.triangles[t].begin(), soup_.triangles[t].end());
        }
        for (const int t : at_[b]) {
            if (is_touched_[t]) return 0;
            for (const int v : soup_.triangles[t]) {
                if (v != a && v != b && near_a.count(v) > 0 && apexes.count(v) == 0) return 0;
            }
        }
        if (has_copies(a, b)) return 0;
        touch_around({a, b});
        for (const int apex : apexes) touch_around({apex});
        for (const int t : both) is_dropped_[t] = true;
        for (const int t : at_[std::max(a, b)]) {
            std::replace(soup_.triangles[t].begin(), soup_.triangles[t].end(), std::max(a, b),
                         std::min(a, b));
        }
        return static_cast<int>(both.size());
    }

    /// Whether two triangles would become one.
    [[nodiscard]] bool has_copies(int a, int b) const {
        for (const int t : at_[b]) {
            if (has(soup_.triangles[t], a)) continue;
            for (const int s : at_[a]) {
                if (has(soup_.triangles[s], b)) continue;
                int n_same = 0;
                for (const int v : soup_.triangles[t]) n_same += has(soup_.triangles[s], v) ? 1 : 0;
                if (n_same == 2) return true;
            }
        }
        return false;
    }

    void touch_around(std::initializer_list<int> vertices) {
        for (const int v : vertices) {
            for (const int t : at_[v]) is_touched_[t] = true;
        }
    }

    TriangleSoup& soup_;
    double flatness_;
    std::vector<std::vector<int>> at_;
    std::vector<bool> is_open_;
    std::vector<bool> is_touched_;
    std::vector<bool> is_dropped_;
};

int count_flat(const TriangleSoup& soup, double flatness) {
    int n = 0;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        n += relative_height(soup, static_cast<int>(t)) <= flatness ? 1 : 0;
    }
    return n;
}

void remove_flat(TriangleSoup& soup, double flatness, FixReport& report) {
    constexpr int max_passes = 100;
    for (int pass = 0; pass < max_passes; ++pass) {
        const int n_removed = FlatRemoval(soup, flatness).run();
        report.n_flat_removed += n_removed;
        if (n_removed == 0) break;
    }
    report.n_flat_left = count_flat(soup, flatness);
}

void split_vertices(TriangleSoup& soup, FixReport& report) {
    const std::vector<int> fans = corner_fans(soup);
    std::vector<int> first_fan(soup.points.size(), -1);
    std::map<int, int> copy_of_fan;
    for (std::size_t c = 0; c < fans.size(); ++c) {
        int& vertex = soup.triangles[c / 3][c % 3];
        int& first = first_fan[vertex];
        if (first < 0) first = fans[c];
        if (fans[c] == first) continue;
        const auto [copy, is_new] =
            copy_of_fan.emplace(fans[c], static_cast<int>(soup.points.size()));
        if (is_new) {
            const Vector3 point = soup.points[vertex];
            soup.points.push_back(point);
            ++report.n_split_vertices;
            if (report.split_vertices.size() < max_places) {
                report.split_vertices.push_back({{static_cast<int>(c / 3)}, point});
            }
        }
        vertex = copy->second;
    }
}

void fill_holes(TriangleSoup& soup, FixReport& report) {
    for (const OpenLoop& loop : open_loops(soup)) {
        std::vector<int> vertices = loop.vertices;
        std::sort(vertices.begin(), vertices.end());
        const bool is_simple =
            std::adjacent_find(vertices.begin(), vertices.end()) == vertices.end();
        std::vector<std::array<int, 3>> triangles;
        // The hole lies on the other side of its edges.
        const std::vector<int> around(loop.vertices.rbegin(), loop.vertices.rend());
        std::vector<Vector3> points;
        for (const int v : around) points.push_back(soup.points[v]);
        if (loop.is_closed && is_simple) triangles = fill_loop(points);
        if (triangles.empty()) {
            ++report.n_open_holes;
            continue;
        }
        Vector3 center = Vector3::Zero();
        for (const Vector3& point : points) center += point / static_cast<double>(points.size());
        ++report.n_filled_holes;
        report.n_hole_triangles += static_cast<int>(triangles.size());
        SurfacePlace place{{}, center};
        for (const auto& [a, b, c] : triangles) {
            place.triangles.push_back(static_cast<int>(soup.triangles.size()));
            soup.triangles.push_back({around[a], around[b], around[c]});
        }
        if (report.filled_holes.size() < max_places) report.filled_holes.push_back(place);
    }
}

}  // namespace

double relative_height(const TriangleSoup& soup, int triangle) {
    const auto [i, j, k] = soup.triangles[triangle];
    const Vector3 a = soup.points[j] - soup.points[i];
    const Vector3 b = soup.points[k] - soup.points[i];
    const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
    return longest > 0.0 ? a.cross(b).norm() / longest / longest : 0.0;
}

FixedSurface fix_surface(const TriangleSoup& soup, const FixOptions& options) {
    for (const auto& [name, value] : {std::pair("weld_distance", options.weld_distance),
                                      std::pair("flatness", options.flatness)}) {
        if (!(value >= 0.0 && value < 0.1)) {
            throw InputError("fix_surface: {} = {}; it must be at least 0 and below 0.1", name,
                             value);
        }
    }
    FixedSurface result;
    TriangleSoup welded = soup;
    // Below the spacing of the numbers there is nothing to weld.
    constexpr double rounding = 1e-15;
    if (options.weld_distance > rounding) {
        weld(welded, options.weld_distance * bounding_box_diagonal(soup.points), result.report);
    }
    RepairedSurface repaired = repair_surface(welded);
    result.soup = std::move(repaired.soup);
    result.report.repair = std::move(repaired.report);
    remove_flat(result.soup, options.flatness, result.report);
    split_vertices(result.soup, result.report);
    static_cast<void>(orient_alike(result.soup));
    if (options.fills_holes) fill_holes(result.soup, result.report);
    drop_unused_points(result.soup);
    if (result.soup.triangles.empty()) {
        throw GeometryError("fix_surface: no triangle is left; all of {} had no extent",
                            soup.triangles.size());
    }
    return result;
}

}  // namespace couture::meshing
