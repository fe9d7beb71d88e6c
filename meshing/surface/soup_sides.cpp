#include "meshing/surface/soup_sides.h"

#include <algorithm>

#include "iga/core/disjoint_sets.h"

namespace couture::meshing {

std::vector<SoupSide> sorted_sides(const TriangleSoup& soup) {
    std::vector<SoupSide> sides;
    sides.reserve(3 * soup.triangles.size());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const int from = soup.triangles[t][i];
            const int to = soup.triangles[t][(i + 1) % 3];
            sides.push_back(
                {std::min(from, to), std::max(from, to), static_cast<int>(t), from < to});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const SoupSide& a, const SoupSide& b) {
        return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    return sides;
}

std::vector<std::span<const SoupSide>> edges_of(std::span<const SoupSide> sides) {
    std::vector<std::span<const SoupSide>> edges;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low &&
               sides[end].high == sides[i].high) {
            ++end;
        }
        edges.push_back(sides.subspan(i, end - i));
        i = end;
    }
    return edges;
}

std::vector<int> edge_components(const TriangleSoup& soup) {
    DisjointSets sets(soup.triangles.size());
    const auto sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        for (const SoupSide& side : edge) sets.join(edge.front().triangle, side.triangle);
    }
    // Roots come first.
    std::vector<int> number(soup.triangles.size(), -1);
    int next = 0;
    for (std::size_t t = 0; t < number.size(); ++t) {
        const int root = sets.find(static_cast<int>(t));
        number[t] = root == static_cast<int>(t) ? next++ : number[root];
    }
    return number;
}

TriangleSoup part_of(const TriangleSoup& soup, std::span<const int> triangles) {
    TriangleSoup part{.points = soup.points, .triangles = {}};
    part.triangles.reserve(triangles.size());
    for (const int t : triangles) part.triangles.push_back(soup.triangles[t]);
    return part;
}

int drop_unused_points(TriangleSoup& soup) {
    std::vector<int> number(soup.points.size(), -1);
    for (const auto& triangle : soup.triangles) {
        for (const int vertex : triangle) number[vertex] = 0;
    }
    int n_used = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) continue;
        number[v] = n_used;
        soup.points[n_used++] = soup.points[v];
    }
    const int n_dropped = static_cast<int>(soup.points.size()) - n_used;
    soup.points.resize(n_used);
    for (auto& triangle : soup.triangles) {
        for (int& vertex : triangle) vertex = number[vertex];
    }
    return n_dropped;
}

double bounding_box_diagonal(std::span<const Vector3> points) {
    if (points.empty()) return 0.0;
    Vector3 low = points.front();
    Vector3 high = low;
    for (const Vector3& point : points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    return (high - low).norm();
}

}  // namespace couture::meshing
