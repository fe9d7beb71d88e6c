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
#include "meshing/topology/handle_cuts.h"
#include "meshing/topology/homotopic_cycle.h"
#include "meshing/topology/invariants.h"
#include "meshing/topology/least_cost.h"
#include "meshing/topology/n_pants.h"
#include "meshing/topology/pants_curves.h"
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
          merge_criterion_(mesh, options.merge, planes_, "criterion of the merge"),
          curves_(mesh) {}

    PantsDecomposition run() {
        add_given_loops();
        for (std::size_t s = 0; s < shells_.size(); ++s) cut_handles_of(static_cast<int>(s));
        if (options_.only_handles) {
            result_.patch_of_face = regions_between_curves(mesh_);
            result_.curves = curves_.all();
            return std::move(result_);
        }
        for (const SurfaceInvariants& shell : shells_) {
            n_pants_ += std::max(0, -shell.euler_characteristic);
        }
        for (const auto& points : options_.cycles_through) cut_through(points);
        cut_into_pants();
        result_.patch_of_face = regions_between_curves(mesh_);
        result_.patches =
            patches_between_curves(mesh_, curves_, shells_, options_.only_given_loops);
        result_.curves = curves_.all();
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
            curves_.add({.kind = PantsCurveKind::boundary,
                         .curve = {loop.vertices, true},
                         .length = loop.length,
                         .name = b < static_cast<int>(options_.boundary_names.size())
                                     ? options_.boundary_names[b]
                                     : std::string()});
        }
        check_options();
        split_chords_between_curves(mesh_);
        n_boundaries_ = curves_.size();
        for (std::size_t i = 0; i < options_.loops.size(); ++i) add_loop(i);
    }

    static InputError no_points() {
        return InputError("pants: a cycle through no points; give at least one");
    }

    void cut_handles_of(int shell) {
        if (shells_[shell].genus == 0) return;
        report("looking for handle and tunnel loops", 0.0);
        const bool is_cut = is_cut_into_pants(shells_[shell]) || options_.cuts_tori;
        HandleCutOptions options{.first_given = n_boundaries_,
                                 .only_given = options_.only_given_loops && is_cut,
                                 .cuts = is_cut};
        if (!cycle_criterion_.is_plain_length()) {
            options.tightened = [&](const SurfaceCurve& curve) { return tightened(curve); };
        }
        for (auto& tunnel : cut_handles(mesh_, shell, curves_, options)) {
            result_.tunnels.push_back(std::move(tunnel));
        }
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

    [[nodiscard]] std::vector<SymmetryPlane> planes() const {
        const bool wanted = options_.cycle.symmetry > 0.0 || options_.merge.symmetry > 0.0;
        return wanted ? find_symmetry_planes(mesh_) : std::vector<SymmetryPlane>{};
    }

    void report(std::string_view what, double fraction) const {
        if (options_.progress) options_.progress(what, fraction);
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
        const bool is_cut =
            std::any_of(shells_.begin(), shells_.end(), [&](const SurfaceInvariants& shell) {
                return is_cut_into_pants(shell) || (options_.cuts_tori && shell.genus > 0);
            });
        if (!is_cut && !(options_.loops.empty() && options_.cycles_through.empty())) {
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
            throw InputError("pants: curve {}: {}", curves_.size(), error.what());
        } catch (const TopologyError& error) {
            throw TopologyError("pants: curve {}: {}", curves_.size(), error.what());
        }
        curves_.add({.kind = PantsCurveKind::cycle, .curve = std::move(curve)});
        split_chords_between_curves(mesh_);
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

    // The same for a cycle through vertices of the mesh: a sharp edge that passes two of them is
    // followed, whatever the criterion says of others.
    [[nodiscard]] std::vector<double> factors_through(const CutSurface& piece,
                                                      const std::set<int>& vertices) const {
        const auto features_at = [&](int v) {
            std::set<int> features;
            for (const auto edge : mesh_.ve_range(VertexHandle(v))) {
                if (mesh_.data(edge).feature >= 0) features.insert(mesh_.data(edge).feature);
            }
            return features;
        };
        std::map<int, int> n_vertices;
        for (const int v : vertices) {
            for (const int feature : features_at(v)) ++n_vertices[feature];
        }
        std::erase_if(n_vertices, [](const auto& entry) { return entry.second < 2; });
        std::vector<double> factor = factors(piece);
        if (n_vertices.empty()) return factor;
        factor.resize(piece.n_vertices(), 1.0);
        const double followed = 0.5 * *std::ranges::min_element(factor);
        for (int v = 0; v < piece.n_vertices(); ++v) {
            const std::set<int> features = features_at(piece.parent(v));
            if (std::ranges::any_of(features, [&](int f) { return n_vertices.contains(f); })) {
                factor[v] = followed;
            }
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

    // Whether a piece is a sphere, disc, cylinder or torus by itself, that nothing cuts but the
    // handle of a torus.
    [[nodiscard]] bool is_whole_shell(const CutSurface& piece) const {
        if (piece.euler_characteristic() < 0) return false;
        const auto loops = piece.boundary_loops();
        std::set<int> cuts;
        for (const auto& loop : loops) {
            const int curve = curves_.side_of(piece, loop).curve;
            if (curves_[curve].kind != PantsCurveKind::boundary) cuts.insert(curve);
        }
        const bool is_cut_torus =
            loops.size() == 2 && cuts.size() == 1 &&
            curves_.side_of(piece, loops[0]).curve == curves_.side_of(piece, loops[1]).curve;
        return cuts.empty() || is_cut_torus;
    }

    void cut_into_pants() {
        for (auto& faces : faces_between_curves(mesh_)) {
            rest_ = std::move(faces);
            const CutSurface piece(mesh_, rest_, curve_seams(mesh_));
            const auto loops = piece.boundary_loops();
            const int n = static_cast<int>(loops.size());
            if (is_whole_shell(piece)) continue;
            if (piece.euler_characteristic() >= 0) {
                std::string names;
                for (const auto& [side, loop] : curves_.sides_of(piece, loops)) {
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
                           const PantsCurves::Sides& sides) {
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
        const PantsCurves::Sides sides = curves_.sides_of(piece, cycles.loops());
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
        const int number = curves_.add(
            {.kind = PantsCurveKind::cycle, .curve = std::move(curve), .around = around});
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
        for (const auto& faces : faces_between_curves(mesh_)) {
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
            const HomotopicCycles cycles(piece, factors_through(piece, wanted), inside);
            const PantsCurves::Sides sides = curves_.sides_of(piece, cycles.loops());
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
        const HalfedgeHandle h = curve_halfedges(mesh_, curves_[number].curve).front();
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

    SurfaceMesh& mesh_;
    const PantsOptions& options_;
    std::vector<SymmetryPlane> planes_;
    CutCriterion cycle_criterion_;
    CutCriterion merge_criterion_;
    PantsDecomposition result_;
    PantsCurves curves_;
    // Connected components, see face_components.
    std::vector<SurfaceInvariants> shells_;
    int n_boundaries_ = 0;
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
