#include "meshing/layout/cut_turns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "meshing/layout/cap_pattern.h"
#include "meshing/surface/cut_surface.h"
#include "meshing/surface/harmonic_function.h"

namespace couture::meshing {

namespace {

// Points of a loop between which places are linear.
constexpr int n_samples = 24;
// Places that are tried between two nodes.
constexpr int n_phases = 16;
// Part by which the energy must fall.
constexpr double least_gain = 1e-9;

// Arc length along a closed loop up to each vertex, over its whole length.
std::vector<double> fractions_along(const SurfaceMesh& mesh,
                                    const std::vector<VertexHandle>& loop) {
    std::vector<double> fractions{0.0};
    for (std::size_t k = 0; k < loop.size(); ++k) {
        fractions.push_back(fractions.back() +
                            (mesh.point(loop[(k + 1) % loop.size()]) - mesh.point(loop[k])).norm());
    }
    const double length = fractions.back();
    for (double& fraction : fractions) fraction /= length;
    fractions.pop_back();
    return fractions;
}

// Dirichlet energy of a piecewise linear function: half of x' matrix x.
SparseMatrix dirichlet_matrix(const CutSurface& surface) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int f = 0; f < surface.n_faces(); ++f) {
        const auto triangle = surface.triangle(f);
        for (int k = 0; k < 3; ++k) {
            const int i = triangle[(k + 1) % 3];
            const int j = triangle[(k + 2) % 3];
            const Vector3 a = surface.point(i) - surface.point(triangle[k]);
            const Vector3 b = surface.point(j) - surface.point(triangle[k]);
            const double sine = a.cross(b).norm();
            if (!(sine > 1e-12 * a.norm() * b.norm())) continue;
            const double weight = 0.5 * a.dot(b) / sine;
            entries.emplace_back(i, i, weight);
            entries.emplace_back(j, j, weight);
            entries.emplace_back(i, j, -weight);
            entries.emplace_back(j, i, -weight);
        }
    }
    SparseMatrix matrix(surface.n_vertices(), surface.n_vertices());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

// Dirichlet energy of the harmonic function of a patch with values given on its loops, as a matrix
// of values at n_samples points of each loop, evenly spread from its first vertex.
MatrixX loop_energies(const SurfaceMesh& mesh, const PatchFeatures& patch,
                      const std::vector<FaceHandle>& faces) {
    std::vector<bool> is_seam(mesh.n_edges());
    for (const auto edge : mesh.edges()) is_seam[edge.idx()] = mesh.data(edge).curve >= 0;
    const CutSurface piece(mesh, faces, is_seam);
    HarmonicProblem problem;
    std::vector<std::array<int, 3>> triangles;
    std::vector<Vector3> points;
    for (int f = 0; f < piece.n_faces(); ++f) triangles.push_back(piece.triangle(f));
    for (int v = 0; v < piece.n_vertices(); ++v) points.push_back(piece.point(v));
    problem.triangles = triangles;
    problem.points = points;
    problem.is_fixed.assign(points.size(), 0);
    const auto n_loops = static_cast<Eigen::Index>(patch.loops.size());
    problem.values = MatrixX::Zero(static_cast<Eigen::Index>(points.size()), n_samples * n_loops);
    // Of each boundary edge, by its ends in the mesh.
    std::map<std::pair<int, int>, int> start;
    for (const auto& loop : piece.boundary_loops()) {
        for (const int h : loop) {
            start[{piece.parent(piece.origin(h)), piece.parent(piece.target(h))}] = piece.origin(h);
        }
    }
    for (Eigen::Index l = 0; l < n_loops; ++l) {
        const auto& vertices = patch.loops[l].vertices;
        const std::vector<double> fractions = fractions_along(mesh, vertices);
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            const int v = start.at({vertices[k].idx(), vertices[(k + 1) % vertices.size()].idx()});
            const double place = n_samples * fractions[k];
            const int before = static_cast<int>(place) % n_samples;
            problem.is_fixed[v] = 1;
            problem.values(v, l * n_samples + before) = 1.0 - (place - std::floor(place));
            problem.values(v, l * n_samples + (before + 1) % n_samples) +=
                place - std::floor(place);
        }
    }
    const MatrixX values = solve_harmonic(problem).values;
    return values.transpose() * (dirichlet_matrix(piece) * values);
}

// Points of a closed polygon at evenly spread samples of a loop.
// @param places  of its corners, as fractions of the loop, increasing from the first one by less
//                than 1
MatrixX sampled(const std::vector<Vector3>& corners, const std::vector<double>& places) {
    MatrixX points(n_samples, 3);
    const auto n = corners.size();
    for (int j = 0; j < n_samples; ++j) {
        double t = static_cast<double>(j) / n_samples - places[0];
        t = places[0] + t - std::floor(t);
        const auto next =
            static_cast<std::size_t>(std::ranges::upper_bound(places, t) - places.begin());
        const double end = next < n ? places[next] : places[0] + 1.0;
        const double part = (t - places[next - 1]) / (end - places[next - 1]);
        points.row(j) = (1.0 - part) * corners[next - 1] + part * corners[next % n];
    }
    return points;
}

class Turner {
  public:
    Turner(const SurfaceMesh& opened, const PantsDecomposition& pants,
           const TemplateLibrary& library, std::vector<PatchFeatures>& patches,
           LayoutChoice& choice)
        : mesh_(opened), pants_(pants), library_(library), patches_(patches), choice_(choice) {}

    void run() {
        find_smooth_cuts();
        if (cuts_.empty()) return;
        prepare_patches();
        descend();
        while (exchange_caps()) continue;
        for (const SmoothCut& cut : cuts_) apply(cut);
    }

  private:
    struct LoopPlace {
        int patch;
        int loop;
    };
    struct State {
        /// Place of the first nodes along the cut, of n_phases up to the next node.
        int phase = 0;
        /// Of each side: position in its ring.
        std::array<int, 2> first{};
    };
    struct SmoothCut {
        int curve;
        std::vector<LoopPlace> sides;
        /// Nodes of each side's cap, its wall on their left.
        std::array<std::vector<int>, 2> rings{};
        /// All that let the caps match.
        std::vector<State> states{};
        State now{};
        [[nodiscard]] int n_nodes() const { return static_cast<int>(rings[0].size()); }
    };

    void find_smooth_cuts() {
        std::map<int, std::vector<LoopPlace>> sides;
        for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
            for (int l = 0; l < static_cast<int>(patches_[p].loops.size()); ++l) {
                const auto& loop = patches_[p].loops[l];
                const bool is_cut = pants_.curves[loop.side.curve].kind != PantsCurveKind::boundary;
                if (is_cut && loop.nodes.empty()) sides[loop.side.curve].push_back({p, l});
            }
        }
        for (const auto& [curve, of_curve] : sides) {
            // Where only one side has feature nodes, the cut is no smooth one.
            if (of_curve.size() < 2) continue;
            SmoothCut cut{curve, of_curve};
            list_states(cut);
            for (int side = 0; side < 2; ++side) {
                const auto& [p, l] = of_curve[side];
                cut.now.first[side] =
                    position(cut.rings[side], choice_.matches[p].loop_nodes[l][0]);
            }
            cuts_.push_back(std::move(cut));
        }
    }

    static int position(const std::vector<int>& ring, int node) {
        return static_cast<int>(std::ranges::find(ring, node) - ring.begin());
    }

    // From the caps that lie on the cut.
    void list_states(SmoothCut& cut) const {
        std::array<CapPattern, 2> patterns;
        for (int side = 0; side < 2; ++side) {
            const auto& [p, l] = cut.sides[side];
            patterns[side] =
                cap_pattern(library_.find(choice_.templates[p]), choice_.matches[p].caps[l]);
            cut.rings[side].assign(patterns[side].loop.rbegin(), patterns[side].loop.rend());
        }
        cut.states.clear();
        const int n = cut.n_nodes();
        for (const int rotation : admissible_rotations(patterns[0], patterns[1])) {
            for (int first = 0; first < n; ++first) {
                for (int phase = 0; phase < n_phases; ++phase) {
                    cut.states.push_back({phase, {first, partner(rotation, first, n)}});
                }
            }
        }
    }

    // Where the second ring has the node on which one of the first is laid, and the other way
    // round: the rotation at which two nodes are laid on each other. Rings are the loops of
    // patterns backwards: see match_caps.
    static int partner(int rotation, int first, int n) {
        return ((2 * n - 2 - rotation - first) % n + n) % n;
    }

    void prepare_patches() {
        std::vector<std::vector<FaceHandle>> faces(patches_.size());
        for (const auto face : mesh_.faces()) {
            faces[pants_.patch_of_face[face.idx()]].push_back(face);
        }
        energies_.resize(patches_.size());
        values_.resize(patches_.size());
        for (const SmoothCut& cut : cuts_) {
            for (const auto& [p, l] : cut.sides) {
                if (energies_[p].size() == 0) prepare_patch(p, faces[p]);
            }
            put(cut, cut.now);
        }
    }

    void prepare_patch(int p, const std::vector<FaceHandle>& faces) {
        const PatchFeatures& patch = patches_[p];
        energies_[p] = loop_energies(mesh_, patch, faces);
        values_[p] = MatrixX::Zero(energies_[p].rows(), 3);
        for (int l = 0; l < static_cast<int>(patch.loops.size()); ++l) {
            put_nodes(p, l, choice_.matches[p].loop_nodes[l], places_of_choice(p, l));
        }
    }

    // Where the choice has the nodes of a loop: those at sharp edges there, others evenly between.
    [[nodiscard]] std::vector<double> places_of_choice(int p, int l) const {
        const PatchFeatures::Loop& loop = patches_[p].loops[l];
        const std::vector<int>& nodes = choice_.matches[p].loop_nodes[l];
        const auto n = static_cast<int>(nodes.size());
        const std::vector<double> fractions = fractions_along(mesh_, loop.vertices);
        // Positions among the loop's nodes, with their places.
        std::vector<std::pair<int, double>> fixed;
        for (const int node : loop.nodes) {
            const auto v = std::ranges::find(loop.vertices, patches_[p].nodes[node].vertex);
            fixed.emplace_back(position(nodes, choice_.matches[p].nodes[node]),
                               fractions[v - loop.vertices.begin()]);
        }
        if (fixed.empty()) fixed.emplace_back(0, 0.0);
        fixed.emplace_back(fixed[0].first + n, fixed[0].second + 1.0);
        std::vector<double> places;
        for (std::size_t f = 0; f + 1 < fixed.size(); ++f) {
            const auto [k, place] = fixed[f];
            const auto [k_end, end] = fixed[f + 1];
            for (int i = k; i < k_end; ++i) {
                places.push_back(place + (end - place) * (i - k) / (k_end - k));
            }
        }
        return places;
    }

    void put_nodes(int p, int l, const std::vector<int>& nodes, const std::vector<double>& places) {
        const auto& positions = library_.find(choice_.templates[p]).positions;
        std::vector<Vector3> corners;
        for (const int node : nodes) corners.push_back(positions[node]);
        values_[p].middleRows(l * n_samples, n_samples) = sampled(corners, places);
    }

    void put(const SmoothCut& cut, const State& state) {
        const int n = cut.n_nodes();
        for (int side = 0; side < 2; ++side) {
            const auto& [p, l] = cut.sides[side];
            const double along = static_cast<double>(state.phase) / (n_phases * n);
            const double start = patches_[p].loops[l].side.is_left ? along : 1.0 - along;
            std::vector<double> places;
            for (int k = 0; k < n; ++k) places.push_back(start + static_cast<double>(k) / n);
            put_nodes(p, l, nodes_from(cut, state, side), places);
        }
    }

    static std::vector<int> nodes_from(const SmoothCut& cut, const State& state, int side) {
        std::vector<int> nodes = cut.rings[side];
        std::ranges::rotate(nodes, nodes.begin() + state.first[side]);
        return nodes;
    }

    [[nodiscard]] double energy(int p) const {
        return (values_[p].transpose() * (energies_[p] * values_[p])).trace();
    }

    // Of the patches beside a cut.
    [[nodiscard]] double energy(const SmoothCut& cut) const {
        const int first = cut.sides[0].patch;
        const int second = cut.sides[1].patch;
        return energy(first) + (second == first ? 0.0 : energy(second));
    }

    [[nodiscard]] double energy() const {
        double sum = 0.0;
        for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
            if (energies_[p].size() > 0) sum += energy(p);
        }
        return sum;
    }

    void descend() {
        for (bool has_changed = true; has_changed;) {
            has_changed = false;
            for (SmoothCut& cut : cuts_) has_changed |= improve(cut);
        }
    }

    // The best state of one cut, the others as they are.
    bool improve(SmoothCut& cut) {
        bool has_changed = false;
        double least = energy(cut);
        for (const State& state : cut.states) {
            put(cut, state);
            const double here = energy(cut);
            if (here >= least * (1.0 - least_gain)) continue;
            least = here;
            cut.now = state;
            has_changed = true;
        }
        put(cut, cut.now);
        return has_changed;
    }

    // Whether it helps that two caps of a template change places.
    bool exchange_caps() {
        for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
            if (!patches_[p].nodes.empty()) continue;
            for (const SmoothCut& first : cuts_) {
                for (const SmoothCut& second : cuts_) {
                    for (const auto& a : first.sides) {
                        for (const auto& b : second.sides) {
                            if (a.patch != p || b.patch != p || a.loop >= b.loop) continue;
                            if (exchange(p, a.loop, b.loop)) return true;
                        }
                    }
                }
            }
        }
        return false;
    }

    bool exchange(int p, int l, int m) {
        const std::vector<SmoothCut> old_cuts = cuts_;
        const std::vector<MatrixX> old_values = values_;
        const double before = energy();
        std::vector<int>& caps = choice_.matches[p].caps;
        std::swap(caps[l], caps[m]);
        bool fits = true;
        for (SmoothCut& cut : cuts_) {
            list_states(cut);
            fits = fits && !cut.states.empty();
            if (!fits) break;
            const auto is_there = [&](const LoopPlace& at) {
                return at.patch == p && (at.loop == l || at.loop == m);
            };
            if (std::ranges::any_of(cut.sides, is_there)) cut.now = cut.states[0];
            put(cut, cut.now);
        }
        if (fits) descend();
        if (fits && energy() < before * (1.0 - least_gain)) return true;
        cuts_ = old_cuts;
        values_ = old_values;
        std::swap(caps[l], caps[m]);
        return false;
    }

    void apply(const SmoothCut& cut) {
        const auto& along = pants_.curves[cut.curve].curve.vertices;
        const std::vector<double> fractions = fractions_along(mesh_, along);
        const double aim = static_cast<double>(cut.now.phase) / (n_phases * cut.n_nodes());
        const auto nearest = std::ranges::min_element(
            fractions, {}, [&](double fraction) { return std::abs(fraction - aim); });
        const VertexHandle start = along[nearest - fractions.begin()];
        for (int side = 0; side < 2; ++side) {
            const auto& [p, l] = cut.sides[side];
            choice_.matches[p].loop_nodes[l] = nodes_from(cut, cut.now, side);
            auto& vertices = patches_[p].loops[l].vertices;
            std::ranges::rotate(vertices, std::ranges::find(vertices, start));
        }
        choice_.rotations[cut.curve] = partner(cut.now.first[1], cut.now.first[0], cut.n_nodes());
    }

    const SurfaceMesh& mesh_;
    const PantsDecomposition& pants_;
    const TemplateLibrary& library_;
    std::vector<PatchFeatures>& patches_;
    LayoutChoice& choice_;
    std::vector<SmoothCut> cuts_;
    /// For each patch beside a smooth cut: see loop_energies; places of its loops' samples in its
    /// template.
    std::vector<MatrixX> energies_;
    std::vector<MatrixX> values_;
};

}  // namespace

void turn_smooth_cuts(const SurfaceMesh& opened, const PantsDecomposition& pants,
                      const TemplateLibrary& library, std::vector<PatchFeatures>& patches,
                      LayoutChoice& choice) {
    Turner(opened, pants, library, patches, choice).run();
}

}  // namespace couture::meshing
