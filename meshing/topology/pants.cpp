#include "meshing/topology/pants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "iga/core/error.h"
#include "meshing/topology/cycle_bounds.h"
#include "meshing/topology/handle_tunnel_loops.h"
#include "meshing/topology/homotopic_cycle.h"
#include "meshing/topology/invariants.h"
#include "meshing/topology/least_cost.h"
#include "meshing/topology/n_pants.h"
#include "meshing/topology/tight_loop.h"

namespace couture::meshing {

namespace {

// Costs that differ by less are equal: rounding decides nothing.
constexpr double same_score = 1e-9;

class Decomposer {
  public:
    Decomposer(SurfaceMesh& mesh, const PantsOptions& options)
        : mesh_(mesh),
          options_(options),
          planes_(planes()),
          cycle_criterion_(mesh, options.cycle, planes_, "criterion of the cycle"),
          merge_criterion_(mesh, options.merge, planes_, "criterion of the merge") {}

    PantsDecomposition run() {
        add_given_loops();
        for (std::size_t s = 0; s < shells_.size(); ++s) cut_handles(static_cast<int>(s));
        if (options_.only_handles) {
            result_.patch_of_face = regions_between_curves(mesh_);
            return std::move(result_);
        }
        for (const SurfaceInvariants& shell : shells_) {
            n_pants_ += std::max(0, -shell.euler_characteristic);
        }
        for (const auto& points : options_.cycles_through) cut_through(points);
        cut_into_pants();
        finish();
        if (options_.most_boundaries > 3 && n_pants_ > 1) {
            report("putting pants together", 0.0);
            merge_pants(mesh_, result_, options_.most_boundaries, options_.merge_ratio);
        }
        return std::move(result_);
    }

    // Loops are followed, points found; nothing else is cut.
    void run_given() {
        add_given_loops();
        for (const auto& points : options_.cycles_through) {
            if (points.empty()) throw no_points();
            for (const Vector3& point : points) static_cast<void>(nearest_free(point));
        }
    }

  private:
    // Boundary loops and given loops become the first curves.
    void add_given_loops() {
        shells_ = component_invariants(mesh_);
        for (const auto edge : mesh_.edges()) {
            if (mesh_.data(edge).curve >= 0) {
                throw TopologyError("pants: edge {} belongs to curve {} already; take a fresh mesh",
                                    edge.idx(), mesh_.data(edge).curve);
            }
        }
        for (const SurfaceInvariants& shell : shells_) result_.genus += shell.genus;
        const auto loops = boundary_loops(mesh_);
        for (const int b : boundary_order(loops.size())) {
            const BoundaryLoop& loop = loops[b];
            add_curve({.kind = PantsCurveKind::boundary,
                       .curve = {loop.vertices, true},
                       .length = loop.length,
                       .name = b < static_cast<int>(options_.boundary_names.size())
                                   ? options_.boundary_names[b]
                                   : std::string()});
        }
        check_options();
        split_chords_between_curves(mesh_);
        n_boundaries_ = result_.curves.size();
        for (std::size_t i = 0; i < options_.loops.size(); ++i) add_loop(i);
    }

    static InputError no_points() {
        return InputError("pants: a cycle through no points; give at least one");
    }

    // A cycle around two loops that are left.
    struct Candidate {
        // No cycle around them scores less, then or later.
        double bound = 0.0;
        // Of the one that was found.
        std::optional<double> score = {};
        // Vertices of the mesh on that cycle and on the path that it runs around.
        std::set<int> passed = {};
    };
    using Pair = std::array<CurveSide, 2>;

    static bool is_cut_into_pants(const SurfaceInvariants& shell) {
        return shell.euler_characteristic < 0;
    }

    [[nodiscard]] std::vector<FaceHandle> faces_of_shell(int shell) const {
        std::vector<FaceHandle> faces;
        const std::vector<int> component = face_components(mesh_);
        for (const auto face : mesh_.faces()) {
            if (component[face.idx()] == shell) faces.push_back(face);
        }
        return faces;
    }

    [[nodiscard]] std::vector<SymmetryPlane> planes() const {
        const bool wanted = options_.cycle.symmetry > 0.0 || options_.merge.symmetry > 0.0;
        return wanted ? find_symmetry_planes(mesh_) : std::vector<SymmetryPlane>{};
    }

    void report(std::string_view what, double fraction) const {
        if (options_.progress) options_.progress(what, fraction);
    }

    int add_curve(PantsCurve curve) {
        const int number = static_cast<int>(result_.curves.size());
        if (curve.kind != PantsCurveKind::boundary) {
            mark_curve(mesh_, curve.curve, number);
            curve.length = curve_length(mesh_, curve.curve);
        }
        // Both sides are known by the halfedges along them.
        for (const HalfedgeHandle h : curve_halfedges(mesh_, curve.curve)) {
            side_of_[h.idx()] = {number, true};
            side_of_[mesh_.opposite_halfedge_handle(h).idx()] = {number, false};
        }
        result_.curves.push_back(std::move(curve));
        return number;
    }

    void check_options() const {
        constexpr int most = 6;
        if (options_.most_boundaries < 3 || options_.most_boundaries > most) {
            throw InputError("pants: most_boundaries = {}; it must be 3 to {}",
                             options_.most_boundaries, most);
        }
        for (const auto& [name, value] : {std::pair{"merge_ratio", options_.merge_ratio},
                                          std::pair{"loop_width", options_.loop_width}}) {
            if (!(value > 0.0) || !std::isfinite(value)) {
                throw InputError("pants: {} = {}; it must be positive", name, value);
            }
        }
        const bool has_pants = std::any_of(shells_.begin(), shells_.end(), is_cut_into_pants);
        if (!has_pants && !(options_.loops.empty() && options_.cycles_through.empty())) {
            throw InputError(
                "pants: loops or points are given, but the surface has Euler characteristic {}: a "
                "sphere, disc, cylinder or torus is not cut into pants",
                compute_invariants(mesh_).euler_characteristic);
        }
    }

    [[nodiscard]] std::vector<int> boundary_order(std::size_t n) const {
        std::vector<int> order(n);
        std::iota(order.begin(), order.end(), 0);
        if (options_.boundary_order.empty()) return order;
        if (!std::is_permutation(order.begin(), order.end(), options_.boundary_order.begin(),
                                 options_.boundary_order.end())) {
            throw InputError("pants: boundary_order must name each of the {} boundary loops once",
                             n);
        }
        return options_.boundary_order;
    }

    // Whether all points of each loop lie on the other.
    [[nodiscard]] bool are_same(const GuideLoop& a, const GuideLoop& b) const {
        const double tolerance = 1e-6 * bounding_box_diagonal(mesh_);
        const auto lies_on = [&](const GuideLoop& loop, const GuideLoop& other) {
            return std::all_of(loop.points.begin(), loop.points.end(), [&](const Vector3& point) {
                return distance_to_loop(point, other.points) <= tolerance;
            });
        };
        return lies_on(a, b) && lies_on(b, a);
    }

    void add_loop(std::size_t i) {
        report("following given loops", 0.0);
        const GuideLoop& loop = options_.loops[i];
        for (std::size_t j = 0; j < i; ++j) {
            if (!are_same(loop, options_.loops[j])) continue;
            throw InputError("pants: curves {} and {} are the same loop; give it once",
                             n_boundaries_ + j, n_boundaries_ + i);
        }
        const double width = options_.loop_width * bounding_box_diagonal(mesh_);
        SurfaceCurve curve;
        try {
            curve = trace_loop(mesh_, loop, width);
        } catch (const InputError& error) {
            throw InputError("pants: curve {}: {}", result_.curves.size(), error.what());
        } catch (const TopologyError& error) {
            throw TopologyError("pants: curve {}: {}", result_.curves.size(), error.what());
        }
        add_curve({.kind = PantsCurveKind::cycle, .curve = std::move(curve)});
        split_chords_between_curves(mesh_);
    }

    // Puts the vertices into a curve by which its edges were split on a copy of the surface.
    void refine_curve(int number, const std::vector<int>& vertices, const CutSurface& copy,
                      const std::vector<VertexHandle>& handles) {
        SurfaceCurve& curve = result_.curves[number].curve;
        curve.vertices.clear();
        for (const int v : copy.with_splits(vertices)) curve.vertices.push_back(handles[v]);
        for (const HalfedgeHandle h : curve_halfedges(mesh_, curve)) {
            side_of_[h.idx()] = {number, true};
            side_of_[mesh_.opposite_halfedge_handle(h).idx()] = {number, false};
        }
    }

    // Handles of a shell that keep off the curves there are, which get their kinds.
    void cut_handles(int shell) {
        if (shells_[shell].genus == 0) return;
        const bool has_pants = is_cut_into_pants(shells_[shell]);
        report("looking for handle and tunnel loops", 0.0);
        const CutSurface whole(mesh_, faces_of_shell(shell),
                               std::vector<bool>(mesh_.n_edges(), false));
        std::vector<int> number(mesh_.n_vertices(), -1);
        for (int v = 0; v < whole.n_vertices(); ++v) number[whole.parent(v)] = v;
        std::vector<std::vector<int>> cuts;
        std::vector<int> curve_of_cut;
        for (std::size_t c = n_boundaries_; c < n_boundaries_ + options_.loops.size(); ++c) {
            const auto& vertices = result_.curves[c].curve.vertices;
            if (number[vertices.front().idx()] < 0) continue;
            curve_of_cut.push_back(static_cast<int>(c));
            auto& cut = cuts.emplace_back();
            for (const VertexHandle v : vertices) cut.push_back(number[v.idx()]);
        }
        const HandleTunnelLoops loops =
            find_handle_tunnel_loops(whole, cuts, options_.only_given_loops && has_pants);
        for (std::size_t c = 0; c < cuts.size(); ++c) {
            if (loops.is_handle_cut[c]) {
                result_.curves[curve_of_cut[c]].kind = PantsCurveKind::handle;
            }
        }
        const auto handles = embed_splits(mesh_, loops.surface);
        for (std::size_t c = 0; c < cuts.size(); ++c) {
            refine_curve(curve_of_cut[c], cuts[c], loops.surface, handles);
        }
        for (const HomologyLoop& loop : loops.tunnels) {
            auto& points = result_.tunnels.emplace_back();
            for (const int v : loop.vertices) points.push_back(loops.surface.point(v));
        }
        if (!has_pants && !options_.cuts_tori) return;
        std::vector<SurfaceCurve> curves;
        for (const HomologyLoop& loop : loops.handles) {
            SurfaceCurve& curve = curves.emplace_back();
            for (const int v : loop.vertices) curve.vertices.push_back(handles[v]);
        }
        if (!cycle_criterion_.is_plain_length()) tighten_handles(curves);
        for (SurfaceCurve& curve : curves) {
            add_curve({.kind = PantsCurveKind::handle, .curve = std::move(curve)});
        }
        split_chords_between_curves(mesh_);
    }

    // Handles are shortest by plain length; each is pulled tight by the criterion of cycles between
    // all others.
    void tighten_handles(std::vector<SurfaceCurve>& curves) {
        const auto mark = [&](const SurfaceCurve& curve, int number) {
            for (const HalfedgeHandle h : curve_halfedges(mesh_, curve)) {
                mesh_.data(mesh_.edge_handle(h)).curve = number;
            }
        };
        const auto first = static_cast<int>(result_.curves.size());
        for (std::size_t c = 0; c < curves.size(); ++c) {
            mark(curves[c], first + static_cast<int>(c));
        }
        for (SurfaceCurve& curve : curves) {
            mark(curve, -1);
            curve = tightened(curve);
            mark(curve, first);
        }
        for (const SurfaceCurve& curve : curves) mark(curve, -1);
    }

    [[nodiscard]] CurveSide side_of(const CutSurface& piece, const std::vector<int>& loop) const {
        const int h = loop.front();
        const HalfedgeHandle halfedge =
            mesh_.find_halfedge(VertexHandle(piece.parent(piece.origin(h))),
                                VertexHandle(piece.parent(piece.target(h))));
        return side_of_.at(halfedge.idx());
    }

    [[nodiscard]] std::vector<double> factors(const CutSurface& piece) const {
        if (cycle_criterion_.is_plain_length()) return {};
        std::vector<double> factor;
        for (int v = 0; v < piece.n_vertices(); ++v) {
            factor.push_back(
                cycle_criterion_.factor(mesh_.data(VertexHandle(piece.parent(v))).source));
        }
        return factor;
    }

    // Factors of the merge's criterion at the vertices of a cycle; splits take the mean of the
    // ends.
    [[nodiscard]] double score(const HomotopicCycle& cycle) const {
        const CutSurface& surface = cycle.surface;
        std::map<int, double> of_split;
        const auto factor = [&](int v) {
            v = surface.original(v);
            return surface.parent(v) >= 0
                       ? merge_criterion_.factor(mesh_.data(VertexHandle(surface.parent(v))).source)
                       : of_split.at(v);
        };
        for (const auto& split : surface.splits()) {
            of_split[split.vertex] =
                (1.0 - split.fraction) * factor(split.from) + split.fraction * factor(split.to);
        }
        std::vector<double> factors;
        std::vector<Vector3> points;
        for (const int v : cycle.vertices) {
            factors.push_back(factor(v));
            points.push_back(surface.point(v));
        }
        return merge_criterion_.score(factors, points);
    }

    using Sides = std::vector<std::pair<CurveSide, int>>;

    // Boundary loops of a piece by the sides of curves that they are, in order, with their numbers.
    [[nodiscard]] Sides sides_of(const CutSurface& piece,
                                 const std::vector<std::vector<int>>& loops) const {
        Sides sides;
        for (std::size_t i = 0; i < loops.size(); ++i) {
            sides.emplace_back(side_of(piece, loops[i]), static_cast<int>(i));
        }
        std::sort(sides.begin(), sides.end());
        return sides;
    }

    // What lies between the curves, by the smallest face.
    [[nodiscard]] std::vector<std::vector<FaceHandle>> pieces() const {
        std::vector<std::vector<FaceHandle>> faces;
        const std::vector<int> region = regions_between_curves(mesh_);
        for (const auto face : mesh_.faces()) {
            const auto r = static_cast<std::size_t>(region[face.idx()]);
            if (r >= faces.size()) faces.resize(r + 1);
            faces[r].push_back(face);
        }
        return faces;
    }

    // Whether a piece is a sphere, disc, cylinder or torus by itself, that nothing cuts but the
    // handle of a torus.
    [[nodiscard]] bool is_whole_shell(const CutSurface& piece) const {
        if (piece.euler_characteristic() < 0) return false;
        const auto loops = piece.boundary_loops();
        std::set<int> cuts;
        for (const auto& loop : loops) {
            const int curve = side_of(piece, loop).curve;
            if (result_.curves[curve].kind != PantsCurveKind::boundary) cuts.insert(curve);
        }
        const bool is_cut_torus = loops.size() == 2 && cuts.size() == 1 &&
                                  side_of(piece, loops[0]).curve == side_of(piece, loops[1]).curve;
        return cuts.empty() || is_cut_torus;
    }

    void cut_into_pants() {
        for (auto& faces : pieces()) {
            rest_ = std::move(faces);
            const CutSurface piece(mesh_, rest_, curve_seams(mesh_));
            const auto loops = piece.boundary_loops();
            const int n = static_cast<int>(loops.size());
            if (is_whole_shell(piece)) continue;
            if (piece.euler_characteristic() >= 0) {
                std::string names;
                for (const auto& [side, loop] : sides_of(piece, loops)) {
                    names += fmt::format("{}{}", names.empty() ? "" : ", ", side.curve);
                }
                throw TopologyError(
                    "pants: {} by curve {}; a loop that is given must not bound a disc, nor run "
                    "beside another curve",
                    n == 1 ? "a disc is cut off" : "a cylinder is cut off", names);
            }
            for (int i = n; i > 3 && !options_.only_given_loops; --i) {
                report("cutting into pants",
                       std::min(1.0, static_cast<double>(n_cut_off_++) / n_pants_));
                cut_off_pant();
            }
        }
    }

    // Candidates of before the last cut that are left, and those around its loop.
    void update_candidates(const CutSurface& piece, const std::vector<std::vector<int>>& loops,
                           const Sides& sides) {
        const CycleBounds bounds(piece, loops);
        std::map<Pair, Candidate> left;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            for (std::size_t j = i + 1; j < sides.size(); ++j) {
                const Pair pair{sides[i].first, sides[j].first};
                auto entry = candidates_.extract(pair);
                if (entry.empty()) {
                    const double length = bounds.length_around(sides[i].second, sides[j].second);
                    left[pair].bound = (1.0 - same_score) * merge_criterion_.least_score(length);
                } else {
                    left.insert(std::move(entry));
                }
            }
        }
        candidates_ = std::move(left);
    }

    void cut_off_pant() {
        const CutSurface piece(mesh_, rest_, curve_seams(mesh_));
        const HomotopicCycles cycles(piece, factors(piece));
        const Sides sides = sides_of(piece, cycles.loops());
        const std::map<CurveSide, int> loop_of(sides.begin(), sides.end());
        update_candidates(piece, cycles.loops(), sides);
        std::vector<Pair> pairs;
        std::vector<double> bounds;
        for (const auto& [pair, candidate] : candidates_) {
            pairs.push_back(pair);
            bounds.push_back(candidate.score.value_or(candidate.bound));
        }
        const auto find = [&](const Pair& pair) {
            return cycles.find(loop_of.at(pair[0]), loop_of.at(pair[1]));
        };
        const int best = find_least_cost(
            bounds,
            [&](int k) {
                Candidate& candidate = candidates_.at(pairs[k]);
                if (!candidate.score) {
                    const HomotopicCycle cycle = find(pairs[k]);
                    candidate.score = score(cycle);
                    candidate.passed = passed(piece, cycle);
                }
                return *candidate.score;
            },
            same_score);
        remove_pant(add_cycle(tightened(embed(find(pairs[best]))), pairs[best]));
    }

    [[nodiscard]] SurfaceCurve embed(const HomotopicCycle& cycle) {
        const auto vertices = embed_splits(mesh_, cycle.surface);
        SurfaceCurve curve;
        for (const int v : cycle.vertices) curve.vertices.push_back(vertices[v]);
        return curve;
    }

    // The cuts beside which a cycle is looked for may be in the way of a shorter one.
    [[nodiscard]] SurfaceCurve tightened(const SurfaceCurve& curve) const {
        constexpr double relative_radius = 0.1;
        return tighten_loop(mesh_, curve, relative_radius * bounding_box_diagonal(mesh_),
                            [&](VertexHandle vertex) {
                                return cycle_criterion_.factor(mesh_.data(vertex).source);
                            });
    }

    int add_cycle(SurfaceCurve curve, const Pair& around) {
        const int number =
            add_curve({.kind = PantsCurveKind::cycle, .curve = std::move(curve), .around = around});
        split_chords_between_curves(mesh_);
        return number;
    }

    // The vertex nearest to a point, among those that lie on no curve.
    [[nodiscard]] VertexHandle nearest_free(const Vector3& point) const {
        const double limit = 0.1 * bounding_box_diagonal(mesh_);
        std::vector<char> is_taken(mesh_.n_vertices(), 0);
        for (const auto edge : mesh_.edges()) {
            if (mesh_.data(edge).curve < 0 && !mesh_.is_boundary(edge)) continue;
            const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
            is_taken[mesh_.from_vertex_handle(h).idx()] = 1;
            is_taken[mesh_.to_vertex_handle(h).idx()] = 1;
        }
        VertexHandle nearest;
        double least = std::numeric_limits<double>::infinity();
        for (const auto vertex : mesh_.vertices()) {
            const double distance = (mesh_.point(vertex) - point).norm();
            if (is_taken[vertex.idx()] != 0 || mesh_.is_isolated(vertex) || !(distance < least)) {
                continue;
            }
            least = distance;
            nearest = vertex;
        }
        if (!(least <= limit)) {
            throw InputError(
                "pants: point ({:.6g}, {:.6g}, {:.6g}) lies {:.3g} away from the surface; it must "
                "be within a tenth of the diagonal, {:.3g}",
                point.x(), point.y(), point.z(), least, limit);
        }
        return nearest;
    }

    // Cuts along the shortest cycle that passes some points, whichever loops it runs around.
    void cut_through(const std::vector<Vector3>& points) {
        report("cutting through given points", 0.0);
        if (points.empty()) throw no_points();
        std::set<int> wanted;
        for (const Vector3& point : points) wanted.insert(nearest_free(point).idx());
        std::optional<HomotopicCycle> best;
        Pair around{};
        for (const auto& faces : pieces()) {
            const CutSurface piece(mesh_, faces, curve_seams(mesh_));
            std::vector<int> inside;
            for (int v = 0; v < piece.n_vertices(); ++v) {
                if (wanted.contains(piece.parent(v))) inside.push_back(v);
            }
            if (inside.empty()) continue;
            const auto loops = piece.boundary_loops();
            if (inside.size() < wanted.size() || loops.size() < 4) {
                throw TopologyError(
                    "pants: no cycle passes all points near ({:.6g}, {:.6g}, {:.6g}): {}",
                    points.front().x(), points.front().y(), points.front().z(),
                    loops.size() < 4 ? "they lie in a pant already"
                                     : "a curve divides them from each other");
            }
            const HomotopicCycles cycles(piece, factors(piece), inside);
            const Sides sides = sides_of(piece, cycles.loops());
            for (std::size_t i = 0; i < sides.size(); ++i) {
                for (std::size_t j = i + 1; j < sides.size(); ++j) {
                    HomotopicCycle cycle = cycles.find(sides[i].second, sides[j].second);
                    if (best && cycle.weight >= (1.0 - same_score) * best->weight) continue;
                    best = std::move(cycle);
                    around = {sides[i].first, sides[j].first};
                }
            }
        }
        add_cycle(embed(*best), around);
    }

    [[nodiscard]] std::set<int> passed(const CutSurface& piece, const HomotopicCycle& cycle) const {
        std::set<int> vertices;
        const auto add = [&](const CutSurface& surface, int v) {
            if (surface.parent(v) >= 0) vertices.insert(surface.parent(v));
        };
        for (const int v : cycle.vertices) add(cycle.surface, v);
        for (const int v : cycle.path) add(piece, v);
        for (const auto& split : cycle.surface.splits()) {
            add(cycle.surface, split.from);
            add(cycle.surface, split.to);
        }
        return vertices;
    }

    // The pant lies left of the new cycle; what is left of the surface, right of it.
    void remove_pant(int number) {
        const std::vector<int> region = regions_between_curves(mesh_);
        const HalfedgeHandle h = curve_halfedges(mesh_, result_.curves[number].curve).front();
        const int pant = region[mesh_.face_handle(h).idx()];
        const int rest = region[mesh_.face_handle(mesh_.opposite_halfedge_handle(h)).idx()];
        if (pant == rest) {
            throw TopologyError("pants: cycle {} does not divide the surface", number);
        }
        rest_.clear();
        std::set<int> gone;
        for (const auto face : mesh_.faces()) {
            if (region[face.idx()] == rest) rest_.push_back(face);
            if (region[face.idx()] != pant) continue;
            for (const VertexHandle vertex : face_vertices(mesh_, face)) gone.insert(vertex.idx());
        }
        for (auto& [pair, candidate] : candidates_) {
            if (std::any_of(candidate.passed.begin(), candidate.passed.end(),
                            [&](int v) { return gone.contains(v); })) {
                candidate = {.bound = candidate.bound};
            }
        }
    }

    void finish() {
        result_.patch_of_face = regions_between_curves(mesh_);
        const std::vector<int> shell_of_face = face_components(mesh_);
        const auto faces_of = pieces();
        const int n_patches = static_cast<int>(faces_of.size());
        for (int p = 0; p < n_patches; ++p) {
            const CutSurface piece(mesh_, faces_of[p], curve_seams(mesh_));
            PantsPatch patch;
            patch.shell = shell_of_face[faces_of[p].front().idx()];
            for (const auto& loop : piece.boundary_loops()) {
                patch.boundary.push_back(side_of(piece, loop));
            }
            std::sort(patch.boundary.begin(), patch.boundary.end());
            patch.genus =
                (2 - piece.euler_characteristic() - static_cast<int>(patch.boundary.size())) / 2;
            const bool is_n_pant = options_.only_given_loops && patch.genus == 0;
            if (is_cut_into_pants(shells_[patch.shell]) && !is_n_pant &&
                patch.euler_characteristic() != -1) {
                throw TopologyError(
                    "pants: patch {} has genus {} and {} boundary loops; it must have genus 0 and "
                    "3",
                    p, patch.genus, patch.boundary.size());
            }
            result_.patches.push_back(std::move(patch));
        }
        if (!options_.only_given_loops) check_counts();
    }

    void check_counts() const {
        std::vector<PantsCount> found(shells_.size());
        std::vector<std::set<int>> curves(shells_.size());
        for (const PantsPatch& patch : result_.patches) {
            ++found[patch.shell].n_pants;
            for (const CurveSide& side : patch.boundary) {
                if (result_.curves[side.curve].kind == PantsCurveKind::boundary) continue;
                curves[patch.shell].insert(side.curve);
            }
        }
        for (std::size_t s = 0; s < shells_.size(); ++s) {
            if (!is_cut_into_pants(shells_[s])) continue;
            const PantsCount count = count_pants(shells_[s].genus, shells_[s].n_boundaries);
            const int n_curves = static_cast<int>(curves[s].size());
            if (found[s].n_pants != count.n_pants || n_curves != count.n_curves) {
                throw TopologyError(
                    "pants: shell {}: {} pants and {} curves; there must be {} and {}", s,
                    found[s].n_pants, n_curves, count.n_pants, count.n_curves);
            }
        }
    }

    SurfaceMesh& mesh_;
    const PantsOptions& options_;
    std::vector<SymmetryPlane> planes_;
    CutCriterion cycle_criterion_;
    CutCriterion merge_criterion_;
    PantsDecomposition result_;
    // Connected components, see face_components.
    std::vector<SurfaceInvariants> shells_;
    std::size_t n_boundaries_ = 0;
    std::map<int, CurveSide> side_of_;
    std::vector<FaceHandle> rest_;
    int n_pants_ = 0;
    int n_cut_off_ = 0;
    std::map<Pair, Candidate> candidates_;
};

}  // namespace

std::string_view to_string(PantsCurveKind kind) {
    switch (kind) {
        case PantsCurveKind::boundary:
            return "boundary";
        case PantsCurveKind::handle:
            return "handle";
        case PantsCurveKind::cycle:
            return "cycle";
    }
    return "";
}

PantsDecomposition decompose_into_pants(SurfaceMesh& mesh, const PantsOptions& options) {
    return Decomposer(mesh, options).run();
}

void check_given_curves(SurfaceMesh& mesh, const PantsOptions& options) {
    Decomposer(mesh, options).run_given();
}

}  // namespace couture::meshing
