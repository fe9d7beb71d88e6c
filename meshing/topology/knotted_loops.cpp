#include "meshing/topology/knotted_loops.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

namespace couture::meshing {

namespace {

using Class = std::vector<int>;
using Loop = AnnotatedLoop;

constexpr double unlimited = std::numeric_limits<double>::infinity();

IntegerMatrix transposed(const IntegerMatrix& rows, std::size_t n_columns) {
    IntegerMatrix columns(n_columns, std::vector<long long>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < n_columns; ++j) columns[j][i] = rows[i][j];
    }
    return columns;
}

// Integer functions of classes that vanish on all rows, as a basis.
IntegerMatrix functions_that_vanish(const IntegerMatrix& rows, int rank) {
    return left_kernel(transposed(rows, static_cast<std::size_t>(rank)));
}

long long value_of(const std::vector<long long>& function, const Class& c) {
    long long sum = 0;
    for (std::size_t k = 0; k < c.size(); ++k) sum += function[k] * c[k];
    return sum;
}

// Shortest closed walks through a vertex of whose class some functions have given values:
// Dijkstra's algorithm on pairs of a vertex and the values so far, none beyond `largest`. Needed
// for knotted tubes only, whose loops are no two shortest paths and an edge.
class CoveringSearch {
  public:
    // The first function shall be 1 or -1, the others 0.
    CoveringSearch(const AnnotatedSurface& annotated, const IntegerMatrix& functions, int largest)
        : annotated_(annotated), largest_(largest) {
        for (const Class& c : annotated.classes) {
            Class& change = changes_.emplace_back();
            for (const auto& f : functions) change.push_back(static_cast<int>(value_of(f, c)));
        }
    }

    [[nodiscard]] std::optional<Loop> run(int source, double longest) {
        const CutSurface& surface = annotated_.surface;
        const int n = surface.n_vertices();
        values_.assign(1, Class(changes_.front().size(), 0));
        number_ = {{values_.front(), 0}};
        states_.assign(n, {});
        using Entry = std::tuple<double, int, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        const auto state_of = [&](int v, int c) -> State& {
            return states_[static_cast<std::size_t>(c) * n + v];
        };
        state_of(source, 0) = {0.0, -1, 0, false};
        queue.emplace(0.0, source, 0);
        while (!queue.empty()) {
            const auto [distance, v, c] = queue.top();
            queue.pop();
            if (distance >= longest) break;
            State& state = state_of(v, c);
            if (state.is_settled) continue;
            state.is_settled = true;
            if (v == source && is_wanted(values_[c])) return loop_to(v, c);
            const int first = surface.outgoing(v);
            for (int h = first; h >= 0;) {
                const int w = surface.target(h);
                if (surface.twin(h) >= 0 && !surface.is_boundary_vertex(w)) {
                    const int next = values_behind(c, h);
                    const double length = distance + surface.length(h);
                    if (next >= 0) {
                        State& there = state_of(w, next);
                        if (!there.is_settled && length < there.distance) {
                            there = {length, h, c, false};
                            queue.emplace(length, w, next);
                        }
                    }
                }
                h = surface.rotated(h);
                if (h == first) break;
            }
        }
        return std::nullopt;
    }

  private:
    static constexpr std::size_t most_states = 20'000'000;

    struct State {
        double distance = std::numeric_limits<double>::infinity();
        int arrival = -1;
        int values_before = 0;
        bool is_settled = false;
    };

    static bool is_wanted(const Class& values) {
        return std::abs(values.front()) == 1 &&
               std::all_of(values.begin() + 1, values.end(), [](int x) { return x == 0; });
    }

    int values_behind(int c, int h) {
        if (annotated_.annotation[h] == 0) return c;
        const Class& change = changes_[annotated_.annotation[h]];
        Class sum = values_[c];
        for (std::size_t k = 0; k < sum.size(); ++k) {
            sum[k] += change[k];
            if (std::abs(sum[k]) > largest_) return -1;
        }
        const auto [entry, is_new] = number_.try_emplace(sum, static_cast<int>(values_.size()));
        if (is_new) {
            const auto n = static_cast<std::size_t>(annotated_.surface.n_vertices());
            if (states_.size() + n > most_states) {
                number_.erase(entry);
                return -1;
            }
            values_.push_back(sum);
            states_.resize(states_.size() + n);
        }
        return entry->second;
    }

    [[nodiscard]] Loop loop_to(int v, int c) const {
        const auto n = static_cast<std::size_t>(annotated_.surface.n_vertices());
        std::vector<int> path;
        for (State state = states_[c * n + v]; state.arrival >= 0;) {
            path.push_back(state.arrival);
            v = annotated_.surface.origin(state.arrival);
            state = states_[state.values_before * n + v];
        }
        std::reverse(path.begin(), path.end());
        return annotated_.make_loop(std::move(path));
    }

    const AnnotatedSurface& annotated_;
    int largest_;
    // For each class of an annotation.
    std::vector<Class> changes_;
    std::vector<Class> values_;
    std::map<Class, int> number_;
    // By values, then vertex.
    std::vector<State> states_;
};

bool is_simple(const CutSurface& surface, const std::vector<int>& path) {
    std::set<int> seen;
    return std::all_of(path.begin(), path.end(),
                       [&](int h) { return seen.insert(surface.origin(h)).second; });
}

// The shortest simple loop through one of the sources on which `wanted` is 1 or -1 and all of
// `zeros` vanish. Most of them do so of themselves: only those are tracked that did not.
std::optional<Loop> shortest_knotted(const AnnotatedSurface& annotated,
                                     const std::vector<long long>& wanted,
                                     const IntegerMatrix& zeros, int largest,
                                     const std::vector<int>& sources) {
    IntegerMatrix tracked{wanted};
    std::vector<bool> is_tracked(zeros.size(), false);
    for (;;) {
        CoveringSearch search(annotated, tracked, largest);
        std::optional<Loop> best;
        bool is_complete = true;
        for (const int source : sources) {
            if (annotated.surface.is_boundary_vertex(source)) continue;
            const auto loop = search.run(source, best ? best->length : unlimited);
            if (!loop || !is_simple(annotated.surface, loop->path)) continue;
            best = loop;
            for (std::size_t j = 0; j < zeros.size(); ++j) {
                if (value_of(zeros[j], loop->homology_class) == 0 || is_tracked[j]) continue;
                is_tracked[j] = true;
                is_complete = false;
                tracked.push_back(zeros[j]);
            }
            if (!is_complete) break;
        }
        if (is_complete) return best;
    }
}

}  // namespace

std::vector<AnnotatedLoop> find_knotted_loops(const AnnotatedSurface& annotated,
                                              const IntegerMatrix& projector, LoopKind kind,
                                              const std::vector<int>& sources,
                                              const IntegerMatrix& chosen, std::size_t n) {
    std::vector<Loop> loops;
    long long largest_entry = 1;
    for (const auto& row : projector) {
        for (const long long entry : row)
            largest_entry = std::max(largest_entry, std::llabs(entry));
    }
    const LoopKind other = kind == LoopKind::handle ? LoopKind::tunnel : LoopKind::handle;
    const IntegerMatrix zeros =
        functions_that_vanish(classes_of_kind(projector, kind), annotated.rank);
    IntegerMatrix known = classes_of_kind(projector, other);
    known.insert(known.end(), chosen.begin(), chosen.end());
    constexpr int n_doublings = 4;
    int largest = static_cast<int>(largest_entry) + 1;
    for (int i = 0; i < n_doublings && loops.size() < n;) {
        // A class of the kind on which one of them is 1 extends the known ones to a basis.
        std::optional<Loop> best;
        for (const auto& wanted : functions_that_vanish(known, annotated.rank)) {
            const auto loop = shortest_knotted(annotated, wanted, zeros, largest, sources);
            if (loop && (!best || loop->length < best->length)) best = loop;
        }
        if (best) {
            known.emplace_back(best->homology_class.begin(), best->homology_class.end());
            loops.push_back(*best);
        } else {
            largest *= 2;
            ++i;
        }
    }
    return loops;
}

}  // namespace couture::meshing
