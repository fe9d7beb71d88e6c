#include "meshing/surface/shortest_paths.h"

#include <algorithm>

namespace couture::meshing {

double ShortestPaths::weight(int h) const {
    const double length = surface_->length(h);
    if (factor_ == nullptr) return length;
    return 0.5 * length * ((*factor_)[surface_->origin(h)] + (*factor_)[surface_->target(h)]);
}

int ShortestPaths::run(const Search& search) {
    for (const int v : touched_) state_[v] = {};
    touched_.clear();
    settled_.clear();
    heap_.clear();
    state_.resize(surface_->n_vertices());

    // The smallest pair stands in front.
    const auto is_later = [](const auto& a, const auto& b) { return a > b; };
    const auto offer = [&](int v, double distance, int arrival) {
        State& state = state_[v];
        if (state.is_settled || distance >= state.distance) return;
        if (state.distance == std::numeric_limits<double>::infinity()) touched_.push_back(v);
        state.distance = distance;
        state.arrival = arrival;
        heap_.emplace_back(distance, v);
        std::push_heap(heap_.begin(), heap_.end(), is_later);
    };
    for (const int v : search.sources) offer(v, 0.0, -1);

    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end(), is_later);
        const auto [distance, v] = heap_.back();
        heap_.pop_back();
        State& state = state_[v];
        if (state.is_settled) continue;
        if (distance > search.limit) break;
        state.is_settled = true;
        settled_.push_back(v);
        if (search.is_target != nullptr && (*search.is_target)[v]) return v;
        if (state.arrival != -1 && search.is_blocked != nullptr && (*search.is_blocked)[v])
            continue;
        const int first = surface_->outgoing(v);
        for (int h = first; h >= 0;) {
            if (surface_->twin(h) >= 0 || search.takes_boundary_edges) {
                offer(surface_->target(h), distance + weight(h), h);
            }
            const int behind = CutSurface::previous(h);
            h = surface_->rotated(h);
            if (h < 0 && search.takes_boundary_edges) {
                offer(surface_->origin(behind), distance + weight(behind), -2 - behind);
            }
            if (h == first) break;
        }
    }
    return -1;
}

std::vector<int> ShortestPaths::path_to(int v) const {
    std::vector<int> path;
    for (int h = state_[v].arrival; h != -1; h = state_[before(h)].arrival) {
        if (h >= 0 && surface_->twin(h) >= 0) path.push_back(h);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

std::vector<int> ShortestPaths::vertices_to(int v) const {
    std::vector<int> vertices{v};
    for (int h = state_[v].arrival; h != -1; h = state_[vertices.back()].arrival) {
        vertices.push_back(before(h));
    }
    std::reverse(vertices.begin(), vertices.end());
    return vertices;
}

}  // namespace couture::meshing
