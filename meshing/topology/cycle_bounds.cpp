#include "meshing/topology/cycle_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/cylinder_cycle.h"

namespace couture::meshing {

namespace {

constexpr int n_nearest = 3;
constexpr std::size_t most_boxes = 32;

using Boxes = std::vector<Eigen::AlignedBox<double, 3>>;

// Boxes around the edges of a path, around several together if they are many.
Boxes cover(const CutSurface& piece, const std::vector<int>& vertices) {
    const std::size_t n = vertices.size() - 1;
    const std::size_t n_boxes = std::min(n, most_boxes);
    Boxes boxes;
    for (std::size_t b = 0; b < n_boxes; ++b) {
        auto& box = boxes.emplace_back();
        for (std::size_t k = b * n / n_boxes; k <= (b + 1) * n / n_boxes; ++k) {
            box.extend(piece.point(vertices[k]));
        }
    }
    return boxes;
}

double distance_between(const Boxes& a, const Boxes& b) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& box : a) {
        for (const auto& other : b) least = std::min(least, box.squaredExteriorDistance(other));
    }
    return std::sqrt(least);
}

}  // namespace

CycleBounds::CycleBounds(const CutSurface& piece, const std::vector<std::vector<int>>& loops)
    : ways_(loops.size()) {
    std::vector<std::vector<int>> vertices(loops.size());
    std::vector<int> loop_of_vertex(piece.n_vertices(), -1);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        for (const int h : loops[i]) {
            vertices[i].push_back(piece.origin(h));
            loop_of_vertex[piece.origin(h)] = static_cast<int>(i);
        }
    }
    const std::vector<char> is_blocked = boundary_vertices(piece);
    std::vector<char> is_target = is_blocked;
    const auto mark = [&](std::size_t loop, char value) {
        for (const int v : vertices[loop]) is_target[v] = value;
    };
    ShortestPaths search(piece);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        mark(i, 0);
        for (int k = 0; k < n_nearest; ++k) {
            const int reached = search.run(
                {.sources = vertices[i], .is_blocked = &is_blocked, .is_target = &is_target});
            if (reached < 0) break;
            const int loop = loop_of_vertex[reached];
            ways_[i].push_back({loop, cover(piece, search.vertices_to(reached))});
            mark(loop, 0);
        }
        mark(i, 1);
        for (const Way& way : ways_[i]) mark(way.loop, 1);
    }
}

double CycleBounds::length_around(int i, int j) const {
    double bound = 0.0;
    for (const Way& from : ways_[i]) {
        for (const Way& to : ways_[j]) {
            if (from.loop == j || to.loop == i) continue;
            bound = std::max(bound, 2.0 * distance_between(from.boxes, to.boxes));
        }
    }
    return bound;
}

}  // namespace couture::meshing
