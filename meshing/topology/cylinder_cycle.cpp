#include "meshing/topology/cylinder_cycle.h"

#include <algorithm>
#include <limits>
#include <set>

#include "meshing/surface/harmonic_map.h"

namespace couture::meshing {

void Cutting::slice(const std::vector<int>& path) {
    surface.slice(path);
    extend_factors();
}

void Cutting::split_chords() {
    surface.split_chords();
    extend_factors();
}

void Cutting::split_chords(std::span<const int> points) {
    surface.split_chords();
    std::vector<char> is_closed = boundary_vertices(surface);
    for (const int v : points) is_closed[v] = 1;
    const int n = surface.n_vertices();
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (surface.twin(h) < h || std::max(surface.origin(h), surface.target(h)) >= n) continue;
        if (is_closed[surface.origin(h)] && is_closed[surface.target(h)]) surface.split_edge(h);
    }
    extend_factors();
}

void Cutting::split_spokes() {
    const int n = surface.n_vertices();
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (surface.twin(h) < h || std::max(surface.origin(h), surface.target(h)) >= n) continue;
        if (surface.is_boundary_vertex(surface.origin(h)) ||
            surface.is_boundary_vertex(surface.target(h))) {
            surface.split_edge(h);
        }
    }
    extend_factors();
}

void Cutting::extend_factors() {
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

std::vector<char> boundary_vertices(const CutSurface& surface) {
    std::vector<char> is_boundary(surface.n_vertices());
    for (int v = 0; v < surface.n_vertices(); ++v) is_boundary[v] = surface.is_boundary_vertex(v);
    return is_boundary;
}

namespace {

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

std::vector<int> origins(const CutSurface& surface, const std::vector<int>& halfedges) {
    std::vector<int> vertices;
    vertices.reserve(halfedges.size());
    for (const int h : halfedges) vertices.push_back(surface.origin(h));
    return vertices;
}

std::vector<int> twins(const CutSurface& surface, const std::vector<int>& halfedges) {
    std::vector<int> opposite;
    opposite.reserve(halfedges.size());
    for (const int h : halfedges) opposite.push_back(surface.twin(h));
    return opposite;
}

// The shortest path from some vertices to others, as halfedges; nothing if all ways are blocked.
std::optional<std::vector<int>> shortest_path(const Cutting& cutting,
                                              const std::vector<int>& sources,
                                              const std::vector<int>& targets,
                                              const std::vector<char>& is_blocked) {
    std::vector<char> is_target(cutting.surface.n_vertices(), 0);
    for (const int v : targets) is_target[v] = 1;
    ShortestPaths search = cutting.paths();
    const int reached =
        search.run({.sources = sources, .is_blocked = &is_blocked, .is_target = &is_target});
    if (reached < 0) return std::nullopt;
    return search.path_to(reached);
}

bool has_repeated(const std::vector<int>& vertices) {
    return std::set<int>(vertices.begin(), vertices.end()).size() != vertices.size();
}

// From the left to the right copy of a vertex through points by shortest paths, each of which
// opens the surface.
//
// @param is_sorted  whether the points come in this order, or the nearest one next
std::optional<CylinderCycle> cycle_by_paths(Cutting& cutting, int left, int right,
                                            std::vector<int> points, bool is_sorted) {
    CutSurface& surface = cutting.surface;
    CylinderCycle cycle;
    points.push_back(right);
    int source = left;
    while (!points.empty()) {
        cutting.split_chords(points);
        std::vector<char> is_blocked = boundary_vertices(surface);
        for (const int v : points) is_blocked[v] = 1;
        const std::size_t n_choices = is_sorted ? 1 : std::max<std::size_t>(1, points.size() - 1);
        const auto path = shortest_path(
            cutting, {source},
            {points.begin(), points.begin() + static_cast<std::ptrdiff_t>(n_choices)}, is_blocked);
        if (!path) return std::nullopt;
        const ShortestPaths lengths = cutting.paths();
        for (const int h : *path) {
            cycle.vertices.push_back(surface.original(surface.origin(h)));
            cycle.weight += lengths.weight(h);
        }
        source = surface.target(path->back());
        std::erase(points, source);
        if (source != right) cutting.slice(*path);
    }
    if (has_repeated(cycle.vertices)) return std::nullopt;
    return cycle;
}

}  // namespace

std::optional<CylinderCycle> find_cycle_around(Cutting& cylinder, const std::vector<int>& inner,
                                               const std::vector<int>& outer,
                                               std::vector<char> is_blocked) {
    CutSurface& surface = cylinder.surface;
    const auto gamma = shortest_path(cylinder, origins(surface, inner), origins(surface, outer),
                                     boundary_vertices(surface));
    if (!gamma) return std::nullopt;
    const std::vector<int> opposite = twins(surface, *gamma);
    const int n = surface.n_vertices();
    cylinder.slice(*gamma);
    is_blocked.resize(surface.n_vertices());
    for (int v = n; v < surface.n_vertices(); ++v) is_blocked[v] = is_blocked[surface.original(v)];
    CycleAround around(cylinder, *gamma, opposite, is_blocked);
    CylinderCycle cycle{around.find(), around.weight()};
    if (cycle.vertices.empty() || has_repeated(cycle.vertices)) return std::nullopt;
    return cycle;
}

std::optional<CylinderCycle> find_cycle_through(Cutting& cylinder, const std::vector<int>& inner,
                                                const std::vector<int>& outer,
                                                const std::vector<int>& points) {
    CutSurface& surface = cylinder.surface;
    cylinder.split_chords(points);
    // Opened along a path from end to end through the first point and no other.
    std::vector<char> is_blocked = boundary_vertices(surface);
    for (const int v : points) is_blocked[v] = 1;
    const int first = points.front();
    const auto in = shortest_path(cylinder, origins(surface, inner), {first}, is_blocked);
    if (!in) return std::nullopt;
    for (const int h : *in) is_blocked[surface.origin(h)] = 1;
    const auto out = shortest_path(cylinder, {first}, origins(surface, outer), is_blocked);
    if (!out) return std::nullopt;
    std::vector<int> gamma = *in;
    gamma.insert(gamma.end(), out->begin(), out->end());
    const int last_before = gamma[in->size() - 1];
    const int twin_behind = surface.twin(last_before);

    std::vector<int> order(points.begin() + 1, points.end());
    if (order.size() > 1) {
        CutSurface opened = surface;
        const auto corners = open_annulus(opened, gamma);
        const AnnulusMap map = map_opened_annulus(opened, corners, 1.0, 1.0, false);
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
            // What lies left of the opening is on the right of the rectangle.
            return map.map.parameters[a].x() > map.map.parameters[b].x();
        });
    }
    cylinder.slice(gamma);
    const int left = surface.target(last_before);
    const int right = surface.origin(twin_behind);
    Cutting sorted = cylinder;
    const auto in_order = cycle_by_paths(sorted, left, right, order, true);
    const auto to_nearest = cycle_by_paths(cylinder, left, right, order, false);
    if (to_nearest && (!in_order || to_nearest->weight < in_order->weight)) return to_nearest;
    cylinder = std::move(sorted);
    return in_order;
}

}  // namespace couture::meshing
