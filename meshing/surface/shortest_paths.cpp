#include "meshing/surface/shortest_paths.h"

#include <algorithm>

namespace couture::meshing {

double ShortestPaths::weight(int h) const {
    const double length = surface_->length(h);
    if (factor_ == nullptr) return length;
    return 0.5 * length * ((*factor_)[surface_->origin(h)] + (*factor_)[surface_->target(h)]);
}

template <typename Function>
void ShortestPaths::for_each_step(int v, bool takes_boundary_edges,
                                  const Function& function) const {
    const int first = surface_->outgoing(v);
    for (int h = first; h >= 0;) {
        if (surface_->twin(h) >= 0 || takes_boundary_edges) {
            function({weight(h), surface_->target(h), h});
        }
        const int behind = CutSurface::previous(h);
        h = surface_->rotated(h);
        if (h < 0 && takes_boundary_edges) {
            function({weight(behind), surface_->origin(behind), -2 - behind});
        }
        if (h == first) break;
    }
}

void ShortestPaths::prepare() {
    steps_.clear();
    first_step_.assign(1, 0);
    for (int v = 0; v < surface_->n_vertices(); ++v) {
        for_each_step(v, true, [&](const Step& step) { steps_.push_back(step); });
        first_step_.push_back(static_cast<int>(steps_.size()));
    }
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
        if (first_step_.empty()) {
            for_each_step(v, search.takes_boundary_edges, [&](const Step& step) {
                offer(step.target, distance + step.weight, step.arrival);
            });
            continue;
        }
        for (int i = first_step_[v]; i < first_step_[v + 1]; ++i) {
            const Step& step = steps_[i];
            const bool is_boundary_edge = step.arrival < 0 || surface_->twin(step.arrival) < 0;
            if (is_boundary_edge && !search.takes_boundary_edges) continue;
            offer(step.target, distance + step.weight, step.arrival);
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
