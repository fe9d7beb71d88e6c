#include "meshing/surface/open_pant.h"

#include <algorithm>

#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"

namespace couture::meshing {

namespace {

std::vector<std::vector<int>> pant_boundaries(const CutSurface& pant) {
    auto loops = pant.boundary_loops();
    const auto components = pant.face_components();
    const int n_components =
        components.empty() ? 0 : *std::max_element(components.begin(), components.end()) + 1;
    if (n_components != 1 || loops.size() != 3 || pant.euler_characteristic() != -1) {
        throw TopologyError(
            "open_pant: the piece has {} components, {} boundaries and Euler characteristic {}; a "
            "pant has 1, 3 and -1",
            n_components, loops.size(), pant.euler_characteristic());
    }
    return loops;
}

// Runs the search for the shortest path inside from some boundary vertices to others.
int shortest_between(const CutSurface& surface, ShortestPaths& paths, const std::vector<int>& from,
                     const std::vector<int>& to) {
    std::vector<char> is_blocked(surface.n_vertices(), 0);
    std::vector<char> is_target(surface.n_vertices(), 0);
    for (int v = 0; v < surface.n_vertices(); ++v) is_blocked[v] = surface.is_boundary_vertex(v);
    for (const int v : to) is_target[v] = 1;
    return paths.run({.sources = from, .is_blocked = &is_blocked, .is_target = &is_target});
}

// Slices a piece along such a path; returns the copies of its ends in the order of open_annulus.
std::array<int, 4> cut_along_shortest(CutSurface& surface, const std::vector<int>& from,
                                      const std::vector<int>& to) {
    surface.split_chords();
    ShortestPaths paths(surface);
    const int reached = shortest_between(surface, paths, from, to);
    if (reached < 0) {
        throw TopologyError(
            "open_pant: no path from the {} vertices of one boundary to the {} of another one; "
            "each "
            "needs 3 or more",
            from.size(), to.size());
    }
    const std::vector<int> path = paths.path_to(reached);
    const int first_twin = surface.twin(path.front());
    const int last_twin = surface.twin(path.back());
    surface.slice(path);
    return {surface.target(first_twin), surface.origin(path.front()), surface.target(path.back()),
            surface.origin(last_twin)};
}

}  // namespace

std::array<int, 8> open_pant(CutSurface& pant, int first, int middle, int last) {
    const auto loops = pant_boundaries(pant);
    std::array<int, 3> n_named{};
    for (const int i : {first, middle, last}) {
        if (i < 0 || i > 2 || ++n_named[i] > 1) {
            throw InputError("open_pant: boundaries {}, {} and {}; name each of 0, 1 and 2 once",
                             first, middle, last);
        }
    }
    // Vertices keep their numbers, halfedges of the boundary don't when chords are split.
    const auto vertices_of = [&](int i) {
        std::vector<int> vertices;
        for (const int h : loops[i]) vertices.push_back(pant.origin(h));
        return vertices;
    };
    const std::vector<int> start = vertices_of(first);
    const std::vector<int> end = vertices_of(last);
    std::vector<int> between = vertices_of(middle);
    const std::array<int, 4> a = cut_along_shortest(pant, start, between);
    std::erase_if(between, [&](int v) { return v == a[2] || v == a[3]; });
    const std::array<int, 4> b = cut_along_shortest(pant, between, end);
    return {a[0], a[1], a[2], b[1], b[2], b[3], b[0], a[3]};
}

std::array<int, 8> open_pant(CutSurface& pant) {
    const auto loops = pant_boundaries(pant);
    CutSurface copy = pant;
    copy.split_chords();
    // Of the three seams the longest one is left out: the middle boundary has no part in it.
    std::array<double, 3> opposite{};
    for (int i = 0; i < 3; ++i) {
        std::array<std::vector<int>, 2> ends;
        for (int k = 0; k < 2; ++k) {
            for (const int h : loops[(i + 1 + k) % 3]) ends[k].push_back(pant.origin(h));
        }
        ShortestPaths paths(copy);
        const int reached = shortest_between(copy, paths, ends[0], ends[1]);
        opposite[i] = paths.distance(reached);
    }
    const auto middle =
        static_cast<int>(std::max_element(opposite.begin(), opposite.end()) - opposite.begin());
    return open_pant(pant, (middle + 1) % 3, middle, (middle + 2) % 3);
}

}  // namespace couture::meshing
