#include "meshing/topology/homotopic_cycle.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/cylinder_cycle.h"

namespace couture::meshing {

namespace {

// Paths that join several sets of vertices to one: a minimum spanning tree of the shortest paths
// between their Voronoi regions.
//
// Source: [Mehlhorn88].
std::vector<std::vector<int>> connecting_paths(const Cutting& cutting,
                                               const std::vector<std::vector<int>>& sets,
                                               const std::vector<int>& avoided) {
    const CutSurface& surface = cutting.surface;
    std::vector<int> sources;
    std::vector<int> region(surface.n_vertices(), -1);
    for (std::size_t k = 0; k < sets.size(); ++k) {
        for (const int v : sets[k]) {
            region[v] = static_cast<int>(k);
            sources.push_back(v);
        }
    }
    std::vector<char> is_blocked = boundary_vertices(surface);
    for (const int v : avoided) is_blocked[v] = 1;
    ShortestPaths paths = cutting.paths();
    paths.run({.sources = sources, .is_blocked = &is_blocked});
    for (const int v : paths.settled()) {
        if (paths.arrival(v) >= 0) region[v] = region[surface.origin(paths.arrival(v))];
    }
    struct Bridge {
        double length;
        int halfedge;
    };
    std::vector<Bridge> bridges;
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        const int v = surface.origin(h);
        const int w = surface.target(h);
        if (surface.twin(h) < h || region[v] < 0 || region[w] < 0 || region[v] == region[w]) {
            continue;
        }
        // Other boundaries may be reached but not passed.
        const auto is_passable = [&](int u) { return !is_blocked[u] || paths.arrival(u) < 0; };
        if (!is_passable(v) || !is_passable(w)) continue;
        bridges.push_back({paths.distance(v) + paths.distance(w) + paths.weight(h), h});
    }
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) {
        return a.length != b.length ? a.length < b.length : a.halfedge < b.halfedge;
    });
    DisjointSets joined(sets.size());
    std::vector<std::vector<int>> result;
    for (const auto& [length, h] : bridges) {
        const int a = region[surface.origin(h)];
        const int b = region[surface.target(h)];
        if (joined.find(a) == joined.find(b)) continue;
        joined.join(a, b);
        auto& path = result.emplace_back(paths.path_to(surface.origin(h)));
        path.push_back(h);
        const auto back = paths.path_to(surface.target(h));
        for (std::size_t k = back.size(); k-- > 0;) path.push_back(surface.twin(back[k]));
    }
    return result;
}

// The part of a path whose edges have not been opened yet.
std::vector<int> unopened(const CutSurface& surface, const std::vector<int>& path) {
    std::vector<int> rest;
    for (const int h : path) {
        if (surface.twin(h) >= 0) rest.push_back(h);
    }
    return rest;
}

}  // namespace

HomotopicCycles::HomotopicCycles(const CutSurface& piece, std::vector<double> factor,
                                 std::vector<int> points)
    : piece_(&piece),
      factor_(std::move(factor)),
      points_(std::move(points)),
      loops_(piece.boundary_loops()) {
    const int n = static_cast<int>(loops_.size());
    const auto components = piece.face_components();
    if (*std::max_element(components.begin(), components.end()) > 0 ||
        piece.euler_characteristic() != 2 - n || n < 3) {
        throw TopologyError(
            "homotopic cycle: the piece has {} components, {} boundary loops and Euler "
            "characteristic {}; it must be one piece of genus 0 (2 - loops) with at least 3",
            *std::max_element(components.begin(), components.end()) + 1, n,
            piece.euler_characteristic());
    }
    loop_of_vertex_.assign(piece.n_vertices(), -1);
    for (int i = 0; i < n; ++i) {
        for (const int h : loops_[i]) loop_of_vertex_[piece.origin(h)] = i;
    }
    for (const int v : points_) {
        if (loop_of_vertex_[v] >= 0) {
            throw InputError(
                "homotopic cycle: vertex {} that it must pass lies on a boundary loop; cycles keep "
                "off them, choose a point beside it",
                v);
        }
    }
}

std::vector<int> HomotopicCycles::path_between(int i, int j) const {
    std::vector<char> is_blocked(piece_->n_vertices(), 0);
    std::vector<char> is_target(piece_->n_vertices(), 0);
    for (int v = 0; v < piece_->n_vertices(); ++v) {
        is_blocked[v] = loop_of_vertex_[v] >= 0;
        is_target[v] = loop_of_vertex_[v] == j;
    }
    for (const int v : points_) is_blocked[v] = 1;
    std::vector<int> sources;
    for (const int h : loops_[i]) sources.push_back(piece_->origin(h));
    ShortestPaths search(*piece_, factor_.empty() ? nullptr : &factor_);
    const int reached =
        search.run({.sources = sources, .is_blocked = &is_blocked, .is_target = &is_target});
    if (reached < 0) {
        throw TopologyError(
            "homotopic cycle: no path from boundary loop {} to {} beside the points that the cycle "
            "must pass",
            i, j);
    }
    return search.path_to(reached);
}

HomotopicCycle HomotopicCycles::find(int i, int j) const {
    const int n = static_cast<int>(loops_.size());
    if (i == j || std::min(i, j) < 0 || std::max(i, j) >= n) {
        throw InputError("homotopic cycle: loops {} and {}; they must be two of 0 to {}", i, j,
                         n - 1);
    }
    const auto [low, high] = std::minmax({i, j});
    const std::vector<int> path = path_between(low, high);
    std::optional<HomotopicCycle> cycle;
    for (const Room room : {Room::at_cuts, Room::beside_cuts, Room::made}) {
        if (!cycle) cycle = find_on(path, low, high, room);
    }
    if (!cycle) {
        throw TopologyError("homotopic cycle: no closed path around boundary loops {} and {}{}", i,
                            j, points_.empty() ? "" : " through the points");
    }
    return *cycle;
}

std::optional<HomotopicCycle> HomotopicCycles::find_on(const std::vector<int>& path, int i, int j,
                                                       Room room) const {
    Cutting cutting{*piece_, factor_};
    HomotopicCycle cycle;
    for (const int h : path) cycle.path.push_back(cutting.surface.origin(h));
    cycle.path.push_back(cutting.surface.target(path.back()));

    cutting.slice(path);
    if (room != Room::at_cuts) cutting.split_chords(points_);
    std::vector<std::vector<int>> others;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
        if (static_cast<int>(k) == i || static_cast<int>(k) == j) continue;
        auto& vertices = others.emplace_back();
        for (const int h : loops_[k]) vertices.push_back(piece_->origin(h));
    }
    for (const auto& connection : connecting_paths(cutting, others, points_)) {
        cutting.slice(unopened(cutting.surface, connection));
    }
    if (room != Room::at_cuts) cutting.split_chords(points_);
    if (room == Room::made) cutting.split_spokes();

    const auto ends = cutting.surface.boundary_loops();
    if (ends.size() != 2 || cutting.surface.euler_characteristic() != 0) return std::nullopt;
    const bool first_is_inner = std::any_of(ends[0].begin(), ends[0].end(), [&](int h) {
        const int original = cutting.surface.original(cutting.surface.origin(h));
        return original < piece_->n_vertices() && loop_of_vertex_[original] == i;
    });
    const auto& inner = ends[first_is_inner ? 0 : 1];
    const auto& outer = ends[first_is_inner ? 1 : 0];
    std::optional<CylinderCycle> around;
    if (points_.empty()) {
        // The cycle keeps off the piece's own boundary, and off the cuts if it must.
        std::vector<char> is_blocked = boundary_vertices(cutting.surface);
        for (int v = 0; room == Room::at_cuts && v < cutting.surface.n_vertices(); ++v) {
            const int original = cutting.surface.original(v);
            is_blocked[v] = original < piece_->n_vertices() && piece_->is_boundary_vertex(original);
        }
        around = find_cycle_around(cutting, inner, outer, std::move(is_blocked));
    } else if (room != Room::at_cuts) {
        around = find_cycle_through(cutting, inner, outer, points_);
    }
    if (!around) return std::nullopt;
    cycle.vertices = std::move(around->vertices);
    cycle.weight = around->weight;
    cycle.surface = std::move(cutting.surface);
    return cycle;
}

}  // namespace couture::meshing
