#include "meshing/surface/soup_boundary.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>

#include "iga/core/disjoint_sets.h"
#include "meshing/surface/soup_sides.h"

namespace couture::meshing {

namespace {

int corner_of(const TriangleSoup& soup, int triangle, int vertex) {
    const auto& corners = soup.triangles[triangle];
    return 3 * triangle +
           static_cast<int>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
}

}  // namespace

std::vector<int> corner_fans(const TriangleSoup& soup) {
    DisjointSets sets(3 * soup.triangles.size());
    const auto sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        const SoupSide& first = edge.front();
        for (const SoupSide& side : edge.subspan(1)) {
            for (const int end : {side.low, side.high}) {
                sets.join(corner_of(soup, first.triangle, end),
                          corner_of(soup, side.triangle, end));
            }
        }
    }
    std::vector<int> fans(3 * soup.triangles.size());
    for (std::size_t c = 0; c < fans.size(); ++c) fans[c] = sets.find(static_cast<int>(c));
    return fans;
}

std::vector<OpenLoop> open_loops(const TriangleSoup& soup) {
    const auto sides = sorted_sides(soup);
    std::vector<SoupSide> open;
    for (const auto& edge : edges_of(sides)) {
        if (edge.size() == 1) open.push_back(edge.front());
    }
    const std::vector<int> fans = corner_fans(soup);
    // Open edges at each end, by its fan.
    std::map<int, std::vector<int>> at_fan;
    const auto fan_of = [&](int edge, int vertex) {
        return fans[corner_of(soup, open[edge].triangle, vertex)];
    };
    for (int e = 0; e < static_cast<int>(open.size()); ++e) {
        for (const int end : {open[e].low, open[e].high}) at_fan[fan_of(e, end)].push_back(e);
    }
    std::vector<bool> is_used(open.size(), false);
    const auto next_edge = [&](int edge, int vertex) -> std::optional<int> {
        for (const int e : at_fan.at(fan_of(edge, vertex))) {
            if (!is_used[e]) return e;
        }
        return {};
    };
    std::vector<OpenLoop> loops;
    for (int start = 0; start < static_cast<int>(open.size()); ++start) {
        if (is_used[start]) continue;
        is_used[start] = true;
        std::deque<int> vertices{open[start].from(), open[start].to()};
        std::deque<int> triangles{open[start].triangle};
        const auto other_end = [&](int edge, int vertex) {
            return open[edge].low == vertex ? open[edge].high : open[edge].low;
        };
        for (int edge = start; const auto next = next_edge(edge, vertices.back());) {
            edge = *next;
            is_used[edge] = true;
            vertices.push_back(other_end(edge, vertices.back()));
            triangles.push_back(open[edge].triangle);
        }
        const bool is_closed = vertices.size() > 3 && vertices.front() == vertices.back();
        for (int edge = start; !is_closed;) {
            const auto previous = next_edge(edge, vertices.front());
            if (!previous) break;
            edge = *previous;
            is_used[edge] = true;
            vertices.push_front(other_end(edge, vertices.front()));
            triangles.push_front(open[edge].triangle);
        }
        if (is_closed) {
            vertices.pop_back();
            const auto shift =
                std::min_element(vertices.begin(), vertices.end()) - vertices.begin();
            std::rotate(vertices.begin(), vertices.begin() + shift, vertices.end());
            std::rotate(triangles.begin(), triangles.begin() + shift, triangles.end());
        }
        loops.push_back({.vertices = {vertices.begin(), vertices.end()},
                         .triangles = {triangles.begin(), triangles.end()},
                         .is_closed = is_closed});
    }
    return loops;
}

}  // namespace couture::meshing
