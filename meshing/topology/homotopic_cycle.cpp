#include "meshing/topology/homotopic_cycle.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"

namespace couture::meshing {

namespace {

// A surface that is being cut, with factors for the vertices that come by splits and slices.
struct Cutting {
    CutSurface surface;
    std::vector<double> factor;

    void slice(const std::vector<int>& path) {
        surface.slice(path);
        extend_factors();
    }
    void split_chords() {
        surface.split_chords();
        extend_factors();
    }
    // Splits the edges that end on the boundary: a ring of vertices around it.
    void split_spokes() {
        const int n = surface.n_vertices();
        for (int h = 0; h < surface.n_halfedges(); ++h) {
            if (surface.twin(h) < h || std::max(surface.origin(h), surface.target(h)) >= n)
                continue;
            if (surface.is_boundary_vertex(surface.origin(h)) ||
                surface.is_boundary_vertex(surface.target(h))) {
                surface.split_edge(h);
            }
        }
        extend_factors();
    }
    [[nodiscard]] ShortestPaths paths() const {
        return ShortestPaths(surface, factor.empty() ? nullptr : &factor);
    }

  private:
    void extend_factors() {
        if (factor.empty()) return;
        const auto n = static_cast<int>(factor.size());
        factor.resize(surface.n_vertices());
        for (const auto& split : surface.splits()) {
            if (split.vertex < n) continue;
            factor[split.vertex] =
                (1.0 - split.fraction) * factor[split.from] + split.fraction * factor[split.to];
        }
        for (int v = n; v < surface.n_vertices(); ++v) factor[v] = factor[surface.original(v)];
    }
};

std::vector<char> boundary_vertices(const CutSurface& surface) {
    std::vector<char> is_boundary(surface.n_vertices());
    for (int v = 0; v < surface.n_vertices(); ++v) is_boundary[v] = surface.is_boundary_vertex(v);
    return is_boundary;
}

// Paths that join several sets of vertices to one: a minimum spanning tree of the shortest paths
// between their Voronoi regions.
//
// Source: [Mehlhorn88].
std::vector<std::vector<int>> connecting_paths(const Cutting& cutting,
                                               const std::vector<std::vector<int>>& sets) {
    const CutSurface& surface = cutting.surface;
    std::vector<int> sources;
    std::vector<int> region(surface.n_vertices(), -1);
    for (std::size_t k = 0; k < sets.size(); ++k) {
        for (const int v : sets[k]) {
            region[v] = static_cast<int>(k);
            sources.push_back(v);
        }
    }
    const std::vector<char> is_blocked = boundary_vertices(surface);
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

// Shortest closed path around a cylinder that was cut along gamma: from the left to the right copy
// of one of its inner vertices, found by halving.
class CycleAround {
  public:
    // @param left     halfedges of gamma; their origins are the left copies
    // @param right    their twins before the cut; their targets are the right copies
    CycleAround(Cutting& cutting, const std::vector<int>& left, const std::vector<int>& right,
                const std::vector<char>& is_blocked)
        : cutting_(cutting),
          left_(left),
          right_(right),
          is_blocked_(is_blocked),
          paths_(cutting.paths()) {}

    // Original vertices of the cycle, from left to right; empty if there is none.
    [[nodiscard]] std::vector<int> find() {
        search(1, static_cast<int>(left_.size()));
        return best_;
    }
    [[nodiscard]] double weight() const { return best_weight_; }

  private:
    void search(int first, int end) {
        if (first >= end) return;
        const int middle = (first + end) / 2;
        CutSurface& surface = cutting_.surface;
        is_blocked_.resize(surface.n_vertices(), 0);
        is_target_.resize(surface.n_vertices(), 0);
        const int source = surface.origin(left_[middle]);
        const int target = surface.target(right_[middle]);
        is_target_[target] = 1;
        const int reached = paths_.run({.sources = {&source, 1},
                                        .is_blocked = &is_blocked_,
                                        .is_target = &is_target_,
                                        .takes_boundary_edges = true});
        is_target_[target] = 0;
        if (reached >= 0) {
            const std::vector<int> path = paths_.path_to(reached);
            if (paths_.distance(reached) < best_weight_) {
                best_weight_ = paths_.distance(reached);
                best_ = paths_.vertices_to(reached);
                best_.pop_back();
                for (int& v : best_) v = surface.original(v);
            }
            // The halves are apart from now on. A vertex that becomes a copy keeps its block.
            const int n = surface.n_vertices();
            cutting_.slice(path);
            is_blocked_.resize(surface.n_vertices(), 0);
            for (int v = n; v < surface.n_vertices(); ++v) {
                is_blocked_[v] = is_blocked_[surface.original(v)];
            }
        }
        search(first, middle);
        search(middle + 1, end);
    }

    Cutting& cutting_;
    const std::vector<int>& left_;
    const std::vector<int>& right_;
    std::vector<char> is_blocked_;
    std::vector<char> is_target_;
    // Used again for each search: its cost is what the search touches.
    ShortestPaths paths_;
    std::vector<int> best_;
    double best_weight_ = std::numeric_limits<double>::infinity();
};

// The part of a path whose edges have not been opened yet.
std::vector<int> unopened(const CutSurface& surface, const std::vector<int>& path) {
    std::vector<int> rest;
    for (const int h : path) {
        if (surface.twin(h) >= 0) rest.push_back(h);
    }
    return rest;
}

}  // namespace

HomotopicCycles::HomotopicCycles(const CutSurface& piece, std::vector<double> factor)
    : piece_(&piece), factor_(std::move(factor)), loops_(piece.boundary_loops()) {
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
    const Cutting whole{piece, factor_};
    const std::vector<char> is_blocked = boundary_vertices(piece);
    ShortestPaths search = whole.paths();
    paths_.assign(n, std::vector<std::vector<int>>(n));
    for (int i = 0; i + 1 < n; ++i) {
        std::vector<int> sources;
        for (const int h : loops_[i]) sources.push_back(piece.origin(h));
        search.run({.sources = sources, .is_blocked = &is_blocked});
        // Settled vertices come by distance: the first on each loop is the nearest.
        for (const int v : search.settled()) {
            const int j = loop_of_vertex_[v];
            if (j > i && paths_[i][j].empty()) paths_[i][j] = search.path_to(v);
        }
    }
}

HomotopicCycle HomotopicCycles::find(int i, int j) const {
    const int n = static_cast<int>(loops_.size());
    if (i == j || std::min(i, j) < 0 || std::max(i, j) >= n) {
        throw InputError("homotopic cycle: loops {} and {}; they must be two of 0 to {}", i, j,
                         n - 1);
    }
    const auto [low, high] = std::minmax({i, j});
    std::optional<HomotopicCycle> cycle;
    for (const Room room : {Room::at_cuts, Room::beside_cuts, Room::made}) {
        if (!cycle) cycle = find_on(*piece_, low, high, room);
    }
    if (!cycle) {
        throw TopologyError("homotopic cycle: no closed path around boundary loops {} and {}", i,
                            j);
    }
    return *cycle;
}

std::optional<HomotopicCycle> HomotopicCycles::find_on(CutSurface surface, int i, int j,
                                                       Room room) const {
    Cutting cutting{std::move(surface), factor_};
    const std::vector<int>& path = paths_[i][j];
    if (path.empty()) return std::nullopt;
    HomotopicCycle cycle;
    for (const int h : path) cycle.path.push_back(cutting.surface.origin(h));
    cycle.path.push_back(cutting.surface.target(path.back()));

    cutting.slice(path);
    if (room != Room::at_cuts) cutting.split_chords();
    std::vector<std::vector<int>> others;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
        if (static_cast<int>(k) == i || static_cast<int>(k) == j) continue;
        auto& vertices = others.emplace_back();
        for (const int h : loops_[k]) vertices.push_back(piece_->origin(h));
    }
    for (const auto& connection : connecting_paths(cutting, others)) {
        cutting.slice(unopened(cutting.surface, connection));
    }
    if (room != Room::at_cuts) cutting.split_chords();
    if (room == Room::made) cutting.split_spokes();

    // The shortest path between the two ends of the cylinder.
    const auto ends = cutting.surface.boundary_loops();
    if (ends.size() != 2 || cutting.surface.euler_characteristic() != 0) return std::nullopt;
    std::vector<char> is_blocked = boundary_vertices(cutting.surface);
    const bool first_is_inner = std::any_of(ends[0].begin(), ends[0].end(), [&](int h) {
        const int original = cutting.surface.original(cutting.surface.origin(h));
        return original < piece_->n_vertices() && loop_of_vertex_[original] == i;
    });
    const auto& inner = ends[first_is_inner ? 0 : 1];
    const auto& outer = ends[first_is_inner ? 1 : 0];
    std::vector<int> sources;
    for (const int h : inner) sources.push_back(cutting.surface.origin(h));
    std::vector<char> is_target(cutting.surface.n_vertices(), 0);
    for (const int h : outer) is_target[cutting.surface.origin(h)] = 1;
    ShortestPaths search = cutting.paths();
    const int reached =
        search.run({.sources = sources, .is_blocked = &is_blocked, .is_target = &is_target});
    if (reached < 0) return std::nullopt;
    const std::vector<int> gamma = search.path_to(reached);
    std::vector<int> opposite;
    for (const int h : gamma) opposite.push_back(cutting.surface.twin(h));

    // The cycle keeps off the piece's own boundary, and off the cuts if it must.
    if (room == Room::at_cuts) {
        for (int v = 0; v < cutting.surface.n_vertices(); ++v) {
            const int original = cutting.surface.original(v);
            is_blocked[v] = original < piece_->n_vertices() && piece_->is_boundary_vertex(original);
        }
    }
    const int n = cutting.surface.n_vertices();
    cutting.slice(gamma);
    is_blocked.resize(cutting.surface.n_vertices());
    for (int v = n; v < cutting.surface.n_vertices(); ++v) {
        is_blocked[v] = is_blocked[cutting.surface.original(v)];
    }
    CycleAround around(cutting, gamma, opposite, is_blocked);
    cycle.vertices = around.find();
    cycle.weight = around.weight();
    if (cycle.vertices.empty()) return std::nullopt;
    std::set<int> seen(cycle.vertices.begin(), cycle.vertices.end());
    if (seen.size() != cycle.vertices.size()) return std::nullopt;
    cycle.surface = std::move(cutting.surface);
    return cycle;
}

}  // namespace couture::meshing
