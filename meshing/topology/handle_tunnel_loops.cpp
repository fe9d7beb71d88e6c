#include "meshing/topology/handle_tunnel_loops.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/homology_basis.h"
#include "meshing/topology/linking.h"

namespace couture::meshing {

namespace {

using Class = std::vector<int>;

enum class Kind { handle, tunnel };

constexpr double unlimited = std::numeric_limits<double>::infinity();

// Closed path of halfedges, good until edges are split; its vertices are good for ever.
struct Loop {
    double length = 0.0;
    std::vector<int> path;
    std::vector<int> vertices;
    Class homology_class;
};

bool is_zero(const Class& c) {
    return std::all_of(c.begin(), c.end(), [](int x) { return x == 0; });
}

// Of c and -c the one whose first entry other than 0 is positive.
Class without_sign(Class c) {
    const auto first = std::find_if(c.begin(), c.end(), [](int x) { return x != 0; });
    if (first != c.end() && *first < 0) {
        for (int& x : c) x = -x;
    }
    return c;
}

bool is_of_kind(const Class& c, const IntegerMatrix& projector, Kind kind) {
    const std::vector<long long> row(c.begin(), c.end());
    const auto image = multiply(row, projector);
    return kind == Kind::tunnel
               ? image == row
               : std::all_of(image.begin(), image.end(), [](long long x) { return x == 0; });
}

// The shortest loops found so far, one for each class of either kind.
class LoopPool {
  public:
    LoopPool(const AnnotatedSurface& annotated, const IntegerMatrix& projector)
        : annotated_(annotated), projector_(projector), paths_(annotated.surface) {
        paths_.prepare();
    }

    // Loops through each source that consist of two shortest paths from it and one edge. The
    // surface must be as it was when the pool was made.
    void search(const std::vector<int>& sources, double longest) {
        const CutSurface& surface = annotated_.surface;
        is_blocked_.assign(surface.n_vertices(), 0);
        searched_.resize(surface.n_vertices(), 0.0);
        for (int v = 0; v < surface.n_vertices(); ++v) {
            is_blocked_[v] = surface.is_boundary_vertex(v);
        }
        for (const int source : sources) {
            if (is_blocked_[source] || searched_[source] >= longest) continue;
            search_from(source, longest);
            searched_[source] = longest;
        }
    }

    // Loops that were found otherwise.
    void add(const Loop& loop, Kind kind) {
        const Class c = without_sign(loop.homology_class);
        const auto known = best_.find(c);
        if (known != best_.end() && known->second.length <= loop.length) return;
        best_[c] = {kind, loop.length, -1, static_cast<int>(added_.size())};
        added_.push_back(loop);
    }

    // The shortest loops of a kind that extend `chosen` to a primitive system, at most `n` of them.
    [[nodiscard]] std::vector<Loop> shortest(Kind kind, int n, const IntegerMatrix& chosen) {
        std::vector<std::pair<double, Class>> order;
        for (const auto& [homology_class, seed] : best_) {
            if (seed.kind == kind) order.emplace_back(seed.length, homology_class);
        }
        std::sort(order.begin(), order.end());
        IntegerMatrix rows = chosen;
        std::vector<Loop> loops;
        for (const auto& [length, homology_class] : order) {
            if (static_cast<int>(loops.size()) == n) break;
            rows.emplace_back(homology_class.begin(), homology_class.end());
            if (is_primitive(rows)) {
                loops.push_back(make_loop(best_.at(homology_class)));
            } else {
                rows.pop_back();
            }
        }
        return loops;
    }

  private:
    struct Seed {
        Kind kind;
        double length;
        // -1: `halfedge` is a number of an added loop.
        int source;
        int halfedge;
    };

    // Classes met by one search get numbers: most pairs of vertices have the same.
    void search_from(int source, double longest) {
        const CutSurface& surface = annotated_.surface;
        paths_.run({.sources = {&source, 1}, .is_blocked = &is_blocked_, .limit = 0.5 * longest});
        class_at_.resize(surface.n_vertices());
        met_.assign(1, Class(annotated_.rank, 0));
        std::map<Class, int> number{{met_.front(), 0}};
        for (const int v : paths_.settled()) {
            const int h = paths_.arrival(v);
            if (h < 0) {
                class_at_[v] = 0;
                continue;
            }
            const int before = class_at_[surface.origin(h)];
            class_at_[v] = before;
            if (annotated_.annotation[h] == 0) continue;
            const Class sum = plus(met_[before], annotated_.annotation[h]);
            const auto [entry, is_new] = number.try_emplace(sum, static_cast<int>(met_.size()));
            if (is_new) met_.push_back(sum);
            class_at_[v] = entry->second;
        }
        for (const int v : paths_.settled()) {
            if (is_blocked_[v]) continue;
            const int first = surface.outgoing(v);
            for (int h = first; h >= 0;) {
                look_at(source, h);
                h = surface.rotated(h);
                if (h == first) break;
            }
        }
    }

    void look_at(int source, int h) {
        const CutSurface& surface = annotated_.surface;
        const int v = surface.origin(h);
        const int w = surface.target(h);
        if (v > w || surface.twin(h) < 0 || is_blocked_[w]) return;
        if (class_at_[v] == class_at_[w] && annotated_.annotation[h] == 0) return;
        const double length = paths_.distance(v) + paths_.distance(w) + surface.length(h);
        if (length == std::numeric_limits<double>::infinity()) return;
        Class sum = plus(met_[class_at_[v]], annotated_.annotation[h]);
        for (int k = 0; k < annotated_.rank; ++k) sum[k] -= met_[class_at_[w]][k];
        if (is_zero(sum)) return;
        sum = without_sign(sum);
        if (const auto known = best_.find(sum); known != best_.end()) {
            if (length < known->second.length)
                known->second = {known->second.kind, length, source, h};
            return;
        }
        if (is_neither_.contains(sum)) return;
        for (const Kind kind : {Kind::handle, Kind::tunnel}) {
            if (!is_of_kind(sum, projector_, kind)) continue;
            best_.emplace(sum, Seed{kind, length, source, h});
            return;
        }
        is_neither_.insert(sum);
    }

    [[nodiscard]] Class plus(Class sum, int annotation) const {
        const Class& change = annotated_.classes[annotation];
        for (int k = 0; k < annotated_.rank; ++k) sum[k] += change[k];
        return sum;
    }

    [[nodiscard]] Loop make_loop(const Seed& seed) {
        if (seed.source < 0) return added_[seed.halfedge];
        const CutSurface& surface = annotated_.surface;
        paths_.run(
            {.sources = {&seed.source, 1}, .is_blocked = &is_blocked_, .limit = seed.length});
        const std::vector<int> out = paths_.path_to(surface.origin(seed.halfedge));
        const std::vector<int> back = paths_.path_to(surface.target(seed.halfedge));
        std::size_t n_common = 0;
        while (n_common < std::min(out.size(), back.size()) && out[n_common] == back[n_common]) {
            ++n_common;
        }
        Loop loop;
        loop.path.assign(out.begin() + static_cast<std::ptrdiff_t>(n_common), out.end());
        loop.path.push_back(seed.halfedge);
        for (std::size_t k = back.size(); k-- > n_common;) {
            loop.path.push_back(surface.twin(back[k]));
        }
        for (const int h : loop.path) {
            loop.length += surface.length(h);
            loop.vertices.push_back(surface.origin(h));
        }
        loop.homology_class = annotated_.class_of(loop.path);
        return loop;
    }

    const AnnotatedSurface& annotated_;
    const IntegerMatrix& projector_;
    ShortestPaths paths_;
    std::vector<char> is_blocked_;
    // For each vertex the length up to which loops through it are known.
    std::vector<double> searched_;
    std::vector<int> class_at_;
    std::vector<Class> met_;
    std::map<Class, Seed> best_;
    std::set<Class> is_neither_;
    std::vector<Loop> added_;
};

IntegerMatrix transposed(const IntegerMatrix& rows, std::size_t n_columns) {
    IntegerMatrix columns(n_columns, std::vector<long long>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < n_columns; ++j) columns[j][i] = rows[i][j];
    }
    return columns;
}

// Classes of a kind, as a basis.
IntegerMatrix classes_of_kind(const IntegerMatrix& projector, Kind kind) {
    IntegerMatrix matrix = projector;
    if (kind == Kind::tunnel) {
        for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i][i] -= 1;
    }
    return left_kernel(matrix);
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
        Loop loop;
        loop.length = states_[c * n + v].distance;
        for (State state = states_[c * n + v]; state.arrival >= 0;) {
            loop.path.push_back(state.arrival);
            v = annotated_.surface.origin(state.arrival);
            state = states_[state.values_before * n + v];
        }
        std::reverse(loop.path.begin(), loop.path.end());
        for (const int h : loop.path) loop.vertices.push_back(annotated_.surface.origin(h));
        loop.homology_class = annotated_.class_of(loop.path);
        return loop;
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

// At most n of the numbers, evenly spaced.
std::vector<int> sample(const std::vector<int>& numbers, std::size_t n) {
    if (numbers.size() <= n) return numbers;
    std::vector<int> chosen;
    for (std::size_t k = 0; k < n; ++k) chosen.push_back(numbers[k * numbers.size() / n]);
    return chosen;
}

// Of fine loops not every vertex is a source: the shortest loop through a vertex is at most twice
// the distance longer than the one through another vertex. Those near the best are looked at after.
constexpr std::size_t n_sources_of_loop = 32;

std::vector<int> spread_sources(const std::vector<Loop>& loops) {
    std::vector<int> sources;
    for (const Loop& loop : loops) {
        const auto some = sample(loop.vertices, n_sources_of_loop);
        sources.insert(sources.end(), some.begin(), some.end());
    }
    return sources;
}

// The vertices of `crossing` that lie between sources beside those that are on loops of `found`.
std::vector<int> sources_beside(const std::vector<Loop>& found, const std::vector<Loop>& crossing) {
    std::set<int> passed;
    for (const Loop& loop : found) passed.insert(loop.vertices.begin(), loop.vertices.end());
    std::set<int> sources;
    for (const Loop& loop : crossing) {
        const std::size_t n = loop.vertices.size();
        const std::size_t spacing = n / n_sources_of_loop + 1;
        for (std::size_t i = 0; i < n && spacing > 1; ++i) {
            if (!passed.contains(loop.vertices[i])) continue;
            for (std::size_t k = n + i - spacing; k <= n + i + spacing; ++k) {
                sources.insert(loop.vertices[k % n]);
            }
        }
    }
    return {sources.begin(), sources.end()};
}

double longest_of(const std::vector<Loop>& loops) {
    double longest = 0.0;
    for (const Loop& loop : loops) longest = std::max(longest, loop.length);
    return longest;
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

constexpr std::size_t n_covering_sources = 8;

// At most n loops of knotted tubes that extend `chosen` to a primitive system.
//
// @param sources  vertices that such loops are likely to pass
std::vector<Loop> find_knotted(const AnnotatedSurface& annotated, const IntegerMatrix& projector,
                               Kind kind, const std::vector<int>& sources,
                               const IntegerMatrix& chosen, std::size_t n) {
    std::vector<Loop> loops;
    long long largest_entry = 1;
    for (const auto& row : projector) {
        for (const long long entry : row)
            largest_entry = std::max(largest_entry, std::llabs(entry));
    }
    const Kind other = kind == Kind::handle ? Kind::tunnel : Kind::handle;
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

// Splits the chords of a sliced surface, and the same edges of the one that is whole.
void split_chords_of_both(AnnotatedSurface& sliced, AnnotatedSurface& whole) {
    for (int h = 0; h < sliced.surface.n_halfedges(); ++h) {
        if (!sliced.surface.is_chord(h)) continue;
        sliced.split_edge(h);
        whole.split_edge(h);
    }
}

// Replaces loops that meet earlier ones, the shortest first, by the shortest that don't.
//
// @param crossing  loops of the other kind
// @param given     cuts that none may meet, with vertices and paths
// @param chosen    classes that the loops extend to a primitive system
std::vector<Loop> make_disjoint(AnnotatedSurface& whole, const IntegerMatrix& projector, Kind kind,
                                const std::vector<Loop>& loops, const std::vector<Loop>& crossing,
                                const std::vector<Loop>& given = {}, IntegerMatrix chosen = {}) {
    std::vector<Loop> disjoint;
    std::vector<bool> is_used(whole.surface.n_vertices(), false);
    for (const Loop& loop : given) {
        for (const int v : loop.vertices) is_used[v] = true;
    }
    const auto accept = [&](Loop loop) {
        // Halfedges are the same on both surfaces, vertices are not.
        loop.vertices.clear();
        for (const int h : loop.path) loop.vertices.push_back(whole.surface.origin(h));
        for (const int v : loop.vertices) is_used[v] = true;
        chosen.emplace_back(loop.homology_class.begin(), loop.homology_class.end());
        disjoint.push_back(std::move(loop));
    };
    const auto is_met = [&](const Loop& loop) {
        return std::any_of(loop.path.begin(), loop.path.end(),
                           [&](int h) { return is_used[whole.surface.origin(h)]; });
    };
    std::size_t n = 0;
    for (; n < loops.size() && !is_met(loops[n]); ++n) accept(loops[n]);
    if (n == loops.size()) return disjoint;

    AnnotatedSurface sliced = whole;
    for (const Loop& loop : given) sliced.surface.slice(loop.path);
    for (const Loop& loop : disjoint) sliced.surface.slice(loop.path);
    while (n < loops.size()) {
        split_chords_of_both(sliced, whole);
        is_used.resize(whole.surface.n_vertices(), false);
        std::vector<int> sources = spread_sources(crossing);
        for (const auto& split : sliced.surface.splits()) sources.push_back(split.vertex);
        std::vector<Loop> found;
        LoopPool pool(sliced, projector);
        double limit = 1.05 * loops[n].length;
        for (;; limit *= 1.25) {
            const bool is_last = limit > 100.0 * loops[n].length;
            if (is_last) limit = unlimited;
            pool.search(sources, limit);
            const int n_missing = static_cast<int>(loops.size() - n);
            found = pool.shortest(kind, n_missing, chosen);
            pool.search(sources_beside(found, crossing), limit);
            found = pool.shortest(kind, n_missing, chosen);
            if (is_last || (!found.empty() && found.front().length <= limit)) break;
        }
        if (found.empty()) {
            found = find_knotted(sliced, projector, kind, sample(sources, n_covering_sources),
                                 chosen, 1);
        }
        if (found.empty()) {
            // Narrow places are passed at vertices that no crossing loop has.
            std::vector<int> all(sliced.surface.n_vertices());
            std::iota(all.begin(), all.end(), 0);
            constexpr std::size_t n_last_sources = 500;
            pool.search(sample(all, n_last_sources), unlimited);
            found = pool.shortest(kind, 1, chosen);
        }
        if (found.empty()) {
            throw TopologyError(
                "handle and tunnel loops: no {} loop number {} of {} that stays clear of the "
                "others; the surface is too coarse there: refine it",
                kind == Kind::handle ? "handle" : "tunnel", n + 1, loops.size());
        }
        // Those behind the first one are as good, up to the first that meets one before it.
        std::vector<std::vector<int>> cuts;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (i > 0 && (found[i].length > limit || is_met(found[i]))) break;
            accept(found[i]);
            cuts.push_back(found[i].path);
            ++n;
        }
        for (const auto& cut : cuts) sliced.surface.slice(cut);
    }
    return disjoint;
}

// Vertices of a loop on a surface some of whose edges were split after the loop was found.
HomologyLoop finish(const CutSurface& surface, const Loop& loop) {
    const std::vector<int>& vertices = loop.vertices;
    std::map<std::pair<int, int>, int> middle;
    for (const auto& split : surface.splits()) {
        middle[{std::min(split.from, split.to), std::max(split.from, split.to)}] = split.vertex;
    }
    HomologyLoop finished{.vertices = {}, .length = 0.0, .homology_class = loop.homology_class};
    const std::function<void(int, int)> add = [&](int from, int to) {
        const auto split = middle.find({std::min(from, to), std::max(from, to)});
        if (split == middle.end()) {
            finished.vertices.push_back(from);
            finished.length += (surface.point(to) - surface.point(from)).norm();
            return;
        }
        add(from, split->second);
        add(split->second, to);
    };
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        add(vertices[k], vertices[(k + 1) % vertices.size()]);
    }
    return finished;
}

// A cut that was made already; it must bound inside.
Loop make_given_loop(const AnnotatedSurface& annotated, const IntegerMatrix& projector,
                     const std::vector<int>& vertices, std::size_t number) {
    Loop loop;
    loop.vertices = vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const int h =
            annotated.surface.find_halfedge(vertices[k], vertices[(k + 1) % vertices.size()]);
        if (h < 0) {
            throw TopologyError("handle and tunnel loops: cut {} is no path of inner edges",
                                number);
        }
        loop.path.push_back(h);
        loop.length += annotated.surface.length(h);
    }
    loop.homology_class = annotated.class_of(loop.path);
    if (!is_of_kind(loop.homology_class, projector, Kind::handle)) {
        const Vector3& x = annotated.surface.point(vertices.front());
        throw TopologyError(
            "handle and tunnel loops: cut {} through ({:.6g}, {:.6g}, {:.6g}) bounds no surface "
            "inside the solid{}; a cut must, as the rim of a cross-section does",
            number, x.x(), x.y(), x.z(),
            is_of_kind(loop.homology_class, projector, Kind::tunnel)
                ? ": it runs around a hole (a tunnel loop)"
                : "");
    }
    return loop;
}

}  // namespace

HandleTunnelLoops find_handle_tunnel_loops(const CutSurface& surface,
                                           std::span<const std::vector<int>> cuts,
                                           bool needs_all_handles) {
    HandleTunnelLoops result;
    result.surface = surface;
    result.surface.split_chords();
    HomologyBasis basis = make_homology_basis(close_with_caps(result.surface));
    result.genus = basis.genus;
    if (basis.genus == 0) {
        result.is_handle_cut.assign(cuts.size(), false);
        return result;
    }
    result.projector = linking_projector(basis);

    // Loops keep off the caps: their triangles come behind the others.
    AnnotatedSurface annotated = std::move(basis.annotated);
    annotated.surface = result.surface;
    annotated.annotation.resize(annotated.surface.n_halfedges());
    std::set<int> on_basis;
    for (const auto& loop : basis.loops) {
        for (const int h : loop) {
            if (h < annotated.surface.n_halfedges()) on_basis.insert(annotated.surface.origin(h));
        }
    }
    const std::vector<int> all_sources(on_basis.begin(), on_basis.end());
    std::vector<Loop> given;
    IntegerMatrix given_classes;
    for (const auto& vertices : cuts) {
        given.push_back(make_given_loop(annotated, result.projector, vertices, given.size()));
        const Class& c = given.back().homology_class;
        given_classes.emplace_back(c.begin(), c.end());
        result.is_handle_cut.push_back(!is_zero(c) && is_primitive(given_classes));
        if (!result.is_handle_cut.back()) given_classes.pop_back();
    }
    const int n_handles = basis.genus - static_cast<int>(given_classes.size());
    if (needs_all_handles && n_handles > 0) {
        throw TopologyError("handle and tunnel loops: the cuts leave {} of {} handles", n_handles,
                            basis.genus);
    }

    LoopPool pool(annotated, result.projector);
    std::vector<Loop> handles;
    std::vector<Loop> tunnels;
    // Tunnels cross handles, those that are cut already among them.
    const auto with_given = [&](std::vector<Loop> loops) {
        for (std::size_t c = 0; c < given.size(); ++c) {
            if (result.is_handle_cut[c]) loops.push_back(given[c]);
        }
        return loops;
    };
    const auto n_of = [&](Kind kind) { return kind == Kind::handle ? n_handles : basis.genus; };
    const auto shortest = [&](Kind kind) {
        return pool.shortest(kind, n_of(kind),
                             kind == Kind::handle ? given_classes : IntegerMatrix{});
    };
    const auto is_short = [&](const std::vector<Loop>& loops, Kind kind) {
        return static_cast<int>(loops.size()) < n_of(kind);
    };
    for (const std::size_t n_sources : {std::size_t{8}, std::size_t{64}, all_sources.size()}) {
        pool.search(sample(all_sources, n_sources), unlimited);
        handles = shortest(Kind::handle);
        tunnels = shortest(Kind::tunnel);
        if (!is_short(handles, Kind::handle) && !is_short(tunnels, Kind::tunnel)) break;
    }
    // Loops of knotted tubes, from loops of the other kind if they are known, since those cross.
    const auto complete = [&](std::vector<Loop>& loops, const std::vector<Loop>& crossing,
                              Kind kind) {
        std::vector<int> sources = sample(all_sources, n_covering_sources);
        if (!is_short(crossing, kind == Kind::handle ? Kind::tunnel : Kind::handle)) {
            sources.clear();
            for (const Loop& loop : crossing) {
                const auto some = sample(loop.vertices, n_covering_sources);
                sources.insert(sources.end(), some.begin(), some.end());
            }
        }
        IntegerMatrix chosen = kind == Kind::handle ? given_classes : IntegerMatrix{};
        for (const Loop& loop : loops) {
            chosen.emplace_back(loop.homology_class.begin(), loop.homology_class.end());
        }
        for (const Loop& loop : find_knotted(annotated, result.projector, kind, sources, chosen,
                                             n_of(kind) - loops.size())) {
            loops.push_back(loop);
            pool.add(loop, kind);
        }
        if (is_short(loops, kind)) {
            throw TopologyError(
                "handle and tunnel loops: found {} {} loops of {}; the surface is knotted beyond "
                "what is searched, or so coarse that no simple loop passes: refine it",
                loops.size(), kind == Kind::handle ? "handle" : "tunnel", n_of(kind));
        }
    };
    if (is_short(handles, Kind::handle)) complete(handles, tunnels, Kind::handle);
    if (is_short(tunnels, Kind::tunnel)) complete(tunnels, with_given(handles), Kind::tunnel);

    // Each kind crosses the other: shorter ones are looked for from there.
    constexpr int n_rounds = 3;
    const auto improve = [&](std::vector<Loop>& loops, const std::vector<Loop>& crossing,
                             Kind kind) {
        pool.search(spread_sources(crossing), longest_of(loops));
        const auto near = shortest(kind);
        pool.search(sources_beside(near, crossing), longest_of(loops));
        const auto shorter = shortest(kind);
        if (is_short(shorter, kind) || longest_of(shorter) >= longest_of(loops)) {
            const auto total = [](const std::vector<Loop>& list) {
                return std::accumulate(list.begin(), list.end(), 0.0,
                                       [](double sum, const Loop& l) { return sum + l.length; });
            };
            if (is_short(shorter, kind) || total(shorter) >= total(loops)) return false;
        }
        loops = shorter;
        return true;
    };
    for (int round = 0; round < n_rounds; ++round) {
        const bool has_better_handles = improve(handles, tunnels, Kind::handle);
        const bool has_better_tunnels = improve(tunnels, with_given(handles), Kind::tunnel);
        if (!has_better_handles && !has_better_tunnels) break;
    }

    const std::vector<Loop> disjoint_handles = make_disjoint(
        annotated, result.projector, Kind::handle, handles, tunnels, given, given_classes);
    // Handles may have split edges of tunnels.
    for (std::size_t i = 0; i < tunnels.size(); ++i) {
        const auto vertices = finish(annotated.surface, tunnels[i]).vertices;
        tunnels[i].vertices = vertices;
        tunnels[i].path.clear();
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            tunnels[i].path.push_back(
                annotated.surface.find_halfedge(vertices[k], vertices[(k + 1) % vertices.size()]));
        }
    }
    const std::vector<Loop> disjoint_tunnels =
        make_disjoint(annotated, result.projector, Kind::tunnel, tunnels, with_given(handles));
    result.surface = std::move(annotated.surface);
    IntegerMatrix rows = given_classes;
    for (int i = 0; i < n_handles; ++i) {
        result.handles.push_back(finish(result.surface, disjoint_handles[i]));
        const Class& c = disjoint_handles[i].homology_class;
        rows.emplace_back(c.begin(), c.end());
    }
    for (int i = 0; i < basis.genus; ++i) {
        result.tunnels.push_back(finish(result.surface, disjoint_tunnels[i]));
        const Class& c = disjoint_tunnels[i].homology_class;
        rows.emplace_back(c.begin(), c.end());
    }
    result.determinant = determinant(rows);
    if (std::llabs(result.determinant) != 1) {
        throw TopologyError(
            "handle and tunnel loops: their classes have determinant {}; they must form an integer "
            "basis of homology",
            result.determinant);
    }
    const auto by_length = [](const HomologyLoop& a, const HomologyLoop& b) {
        return a.length < b.length;
    };
    std::stable_sort(result.handles.begin(), result.handles.end(), by_length);
    std::stable_sort(result.tunnels.begin(), result.tunnels.end(), by_length);
    return result;
}

}  // namespace couture::meshing
