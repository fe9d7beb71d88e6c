#include "meshing/topology/handle_tunnel_loops.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/homology_basis.h"
#include "meshing/topology/knotted_loops.h"
#include "meshing/topology/linking.h"

namespace couture::meshing {

namespace {

using Class = std::vector<int>;
using Loop = AnnotatedLoop;
using Kind = LoopKind;

constexpr double unlimited = std::numeric_limits<double>::infinity();

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
        std::vector<int> path(out.begin() + static_cast<std::ptrdiff_t>(n_common), out.end());
        path.push_back(seed.halfedge);
        for (std::size_t k = back.size(); k-- > n_common;) path.push_back(surface.twin(back[k]));
        return annotated_.make_loop(std::move(path));
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

constexpr std::size_t n_covering_sources = 8;

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
            found = find_knotted_loops(sliced, projector, kind, sample(sources, n_covering_sources),
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

// A loop on a surface some of whose edges were split after the loop was found.
HomologyLoop finish(const CutSurface& surface, const Loop& loop) {
    HomologyLoop finished{.vertices = surface.with_splits(loop.vertices),
                          .length = 0.0,
                          .homology_class = loop.homology_class};
    const std::size_t n = finished.vertices.size();
    for (std::size_t k = 0; k < n; ++k) {
        finished.length +=
            (surface.point(finished.vertices[(k + 1) % n]) - surface.point(finished.vertices[k]))
                .norm();
    }
    return finished;
}

// Halfedges of a closed path, -1 for steps that are no inner edges.
std::vector<int> path_along(const CutSurface& surface, const std::vector<int>& vertices) {
    std::vector<int> path;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        path.push_back(surface.find_halfedge(vertices[k], vertices[(k + 1) % vertices.size()]));
    }
    return path;
}

// A cut that was made already; it must bound inside.
Loop make_given_loop(const AnnotatedSurface& annotated, const IntegerMatrix& projector,
                     const std::vector<int>& vertices, std::size_t number) {
    std::vector<int> path = path_along(annotated.surface, vertices);
    if (std::find(path.begin(), path.end(), -1) != path.end()) {
        throw TopologyError("handle and tunnel loops: cut {} is no path of inner edges", number);
    }
    Loop loop = annotated.make_loop(std::move(path));
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
        throw TopologyError(
            "handle and tunnel loops: the cuts leave {} of {} handles; each needs a cut that "
            "bounds inside and does not divide the surface, alone or with others: add {}",
            n_handles, basis.genus, n_handles);
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
        for (const Loop& loop : find_knotted_loops(annotated, result.projector, kind, sources,
                                                   chosen, n_of(kind) - loops.size())) {
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
    for (Loop& tunnel : tunnels) {
        tunnel = annotated.make_loop(
            path_along(annotated.surface, annotated.surface.with_splits(tunnel.vertices)));
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
