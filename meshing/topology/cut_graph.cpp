#include "meshing/topology/cut_graph.h"

#include <algorithm>

#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/tree_cotree.h"

namespace couture::meshing {

namespace {

void check_connected(const CutSurface& surface, const char* who) {
    const auto component = surface.face_components();
    const int n = component.empty() ? 0 : *std::max_element(component.begin(), component.end()) + 1;
    if (n != 1) {
        throw TopologyError("{}: the surface has {} components; it must be in one piece", who, n);
    }
}

int first_vertex(const CutSurface& surface) { return surface.origin(0); }

std::vector<int> boundary_vertices(const CutSurface& surface) {
    std::vector<int> vertices;
    for (int v = 0; v < surface.n_vertices(); ++v) {
        if (surface.is_boundary_vertex(v)) vertices.push_back(v);
    }
    return vertices;
}

// Slices along the shortest path from the boundary loop of the smallest halfedge to the nearest
// other one; returns the path.
std::vector<int> join_boundaries(CutSurface& surface, const std::vector<std::vector<int>>& loops) {
    std::vector<char> is_target(surface.n_vertices(), 0);
    std::vector<int> sources;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        for (const int h : loops[i]) {
            if (i == 0) sources.push_back(surface.origin(h));
            if (i > 0) is_target[surface.origin(h)] = 1;
        }
    }
    ShortestPaths paths(surface);
    const int reached = paths.run({.sources = sources, .is_target = &is_target});
    if (reached < 0) {
        throw TopologyError("cut_graph: no path joins boundary 0 with one of the {} others",
                            loops.size() - 1);
    }
    std::vector<int> path = paths.path_to(reached);
    surface.slice(path);
    return path;
}

// Takes away, again and again, edges with an end that no other edge has and that lies inside.
void prune(const CutSurface& surface, std::vector<bool>& is_cut) {
    std::vector<int> degree(surface.n_vertices(), 0);
    for (int h = 0; h < surface.n_halfedges(); ++h) degree[surface.origin(h)] += is_cut[h];
    std::vector<int> leaves;
    const auto note = [&](int v) {
        if (degree[v] == 1 && !surface.is_boundary_vertex(v)) leaves.push_back(v);
    };
    for (int v = 0; v < surface.n_vertices(); ++v) note(v);
    while (!leaves.empty()) {
        const int v = leaves.back();
        leaves.pop_back();
        if (degree[v] != 1) continue;
        int h = surface.outgoing(v);
        while (!is_cut[h]) h = surface.rotated(h);
        is_cut[h] = is_cut[surface.twin(h)] = false;
        --degree[v];
        --degree[surface.target(h)];
        note(surface.target(h));
    }
}

}  // namespace

std::vector<int> cut_graph(const CutSurface& surface) {
    check_connected(surface, "cut_graph");
    // Slicing keeps the numbers of halfedges.
    CutSurface opened = surface;
    std::vector<int> edges;
    const auto add = [&](const std::vector<int>& path) {
        for (const int h : path) edges.push_back(std::min(h, surface.twin(h)));
    };
    for (auto loops = opened.boundary_loops(); loops.size() > 1; loops = opened.boundary_loops()) {
        add(join_boundaries(opened, loops));
    }
    std::vector<int> sources = boundary_vertices(opened);
    if (sources.empty()) sources = {first_vertex(opened)};
    const TreeCotree tree_cotree = make_tree_cotree(opened, sources);
    const ShortestPaths& tree = tree_cotree.tree;
    if (opened.euler_characteristic() == 2) {
        add(tree.path_to(tree.settled().back()));
    } else {
        std::vector<bool> is_cut(opened.n_halfedges(), false);
        const auto mark = [&](int h) { is_cut[h] = is_cut[opened.twin(h)] = true; };
        for (const int generator : tree_cotree.generators) {
            mark(generator);
            for (const int end : {opened.origin(generator), opened.target(generator)}) {
                for (const int h : tree.path_to(end)) mark(h);
            }
        }
        prune(opened, is_cut);
        for (int h = 0; h < opened.n_halfedges(); ++h) {
            if (is_cut[h] && h < opened.twin(h)) edges.push_back(h);
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

CutSurface open_to_disc(const CutSurface& surface) {
    CutSurface disc = surface;
    disc.slice(cut_graph(surface));
    const std::size_t n_boundaries = disc.boundary_loops().size();
    if (disc.euler_characteristic() != 1 || n_boundaries != 1) {
        throw TopologyError(
            "open_to_disc: cut along its graph the surface has Euler characteristic {} and {} "
            "boundaries; a disc has 1 and 1",
            disc.euler_characteristic(), n_boundaries);
    }
    return disc;
}

std::vector<std::vector<int>> system_of_loops(const CutSurface& surface, int base) {
    check_connected(surface, "system_of_loops");
    if (base < 0 || base >= surface.n_vertices() || surface.outgoing(base) < 0) {
        throw InputError("system_of_loops: base {} is no vertex of a triangle; there are {}", base,
                         surface.n_vertices());
    }
    const std::size_t n_boundaries = surface.boundary_loops().size();
    if (n_boundaries > 0) {
        throw TopologyError(
            "system_of_loops: the surface has {} boundaries; close it first, or use cut_graph",
            n_boundaries);
    }
    const TreeCotree tree_cotree = make_tree_cotree(surface, {&base, 1});
    std::vector<std::vector<int>> loops;
    for (std::size_t i = tree_cotree.generators.size(); i-- > 0;) {
        const int h = tree_cotree.generators[i];
        std::vector<int> loop = tree_cotree.tree.path_to(surface.origin(h));
        loop.push_back(h);
        const std::vector<int> back = tree_cotree.tree.path_to(surface.target(h));
        for (std::size_t k = back.size(); k-- > 0;) loop.push_back(surface.twin(back[k]));
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace couture::meshing
