#include "meshing/layout/cuboid_decomposition.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "iga/core/error.h"
#include "meshing/layout/embed_layout.h"
#include "meshing/layout/equator.h"
#include "meshing/layout/glue.h"
#include "meshing/layout/padding.h"
#include "meshing/layout/patch_features.h"
#include "meshing/layout/template_choice.h"

namespace couture::meshing {

namespace {

// Room between the numbers of two vertices of a cut for the nodes that lie between them.
constexpr int place_step = 1024;

// A template laid on a patch.
struct Candidate {
    const CuboidTemplate* shape = nullptr;
    TemplateMatch match;
};

class Decomposer {
  public:
    Decomposer(const SurfaceMesh& opened, const Features& features, const PantsDecomposition& pants,
               const ClosingCaps& caps, const TemplateLibrary& library, const MatchOptions& options)
        : opened_(opened),
          pants_(pants),
          caps_(caps),
          library_(library),
          options_(options),
          patches_(find_patch_features(opened, features, pants)),
          n_patches_(static_cast<int>(patches_.size())) {}

    CuboidDecomposition run() {
        choose();
        glue();
        CuboidDecomposition result;
        result.mesh = close_caps(opened_, caps_);
        std::vector<LayoutTie> ties = make_ties();
        for (int p = 0; p < n_patches_; ++p) {
            if (is_bare(patches_[p])) tie_equator(p, result.mesh, ties);
        }
        result.volume = padded(ties);
        LayoutBoundary boundary = layout_boundary(result.volume);
        result.sides = std::move(boundary.sides);
        result.surface = embed_layout(result.mesh, boundary.layout, ties);
        for (const Candidate& candidate : chosen_) {
            result.templates.push_back(candidate.shape->name);
        }
        return result;
    }

  private:
    [[nodiscard]] bool is_cut(int curve) const {
        return pants_.curves[curve].kind != PantsCurveKind::boundary;
    }

    // A sphere without sharp edges.
    [[nodiscard]] static bool is_bare(const PatchFeatures& patch) {
        return patch.loops.empty() && patch.nodes.empty();
    }

    void choose() {
        std::vector<std::vector<Candidate>> candidates(n_patches_);
        std::vector<std::vector<TemplateCandidate>> offers(n_patches_);
        for (int p = 0; p < n_patches_; ++p) {
            const PatchFeatures& patch = patches_[p];
            for (const CuboidTemplate& shape :
                 library_.with_caps(static_cast<int>(patch.loops.size()))) {
                if (is_bare(patch) && shape.layout.n_cuboids() > 1) continue;
                for (TemplateMatch& match : match_template(opened_, patch, shape, options_)) {
                    if (!has_room(patch, match)) continue;
                    Candidate candidate{&shape, std::move(match)};
                    TemplateCandidate offer = make_offer(patch, candidate);
                    if (!can_meet_itself(patch, candidate, offer)) continue;
                    candidates[p].push_back(std::move(candidate));
                    offers[p].push_back(std::move(offer));
                }
            }
            if (candidates[p].empty()) throw_nothing_fits(p);
        }
        const TemplateChoice choice = choose_templates(offers);
        for (int p = 0; p < n_patches_; ++p) {
            chosen_.push_back(std::move(candidates[p][choice.candidates[p]]));
        }
        rotations_ = choice.rotations;
    }

    [[noreturn]] void throw_nothing_fits(int p) const {
        const PatchFeatures& patch = patches_[p];
        std::string names;
        for (const auto& shape : library_.with_caps(static_cast<int>(patch.loops.size()))) {
            names += (names.empty() ? "" : ", ") + shape.name;
        }
        const auto n_corners =
            std::ranges::count_if(patch.nodes, [](const auto& node) { return node.loop < 0; });
        throw TopologyError(
            "layout: no template fits patch {} with {} boundary loops, {} sharp edges and {} "
            "corners inside. Templates with so many caps: {}. Let cuts cross sharp edges, not run "
            "along them (another criterion, loops), or add a template",
            p, patch.loops.size(), patch.curves.size(), n_corners, names.empty() ? "none" : names);
    }

    // Whether all loops have vertices for their nodes.
    [[nodiscard]] static bool has_room(const PatchFeatures& patch, const TemplateMatch& match) {
        for (std::size_t l = 0; l < patch.loops.size(); ++l) {
            if (patch.loops[l].vertices.size() < match.loop_nodes[l].size()) return false;
        }
        return true;
    }

    // Whether the template can be glued to itself where both sides of a cut are the patch's.
    [[nodiscard]] bool can_meet_itself(const PatchFeatures& patch, const Candidate& candidate,
                                       const TemplateCandidate& offer) const {
        // Caps and demands by cuts, in the same order.
        std::map<int, std::vector<int>> caps;
        std::map<int, std::vector<const CutDemand*>> demands;
        for (std::size_t l = 0; l < patch.loops.size(); ++l) {
            if (is_cut(patch.loops[l].side.curve)) {
                caps[patch.loops[l].side.curve].push_back(candidate.match.caps[l]);
            }
        }
        for (const CutDemand& demand : offer.cuts) demands[demand.cut].push_back(&demand);
        std::vector<CapJoint> joints;
        for (const auto& [cut, sides] : demands) {
            if (sides.size() < 2) continue;
            const int rotation = matching_rotation(*sides[0], *sides[1]);
            if (rotation < 0) return false;
            joints.push_back({{0, caps[cut][0]}, {0, caps[cut][1]}, rotation});
        }
        if (joints.empty()) return true;
        try {
            static_cast<void>(glue_templates({*candidate.shape}, joints));
            return true;
        } catch (const TopologyError&) {
            return false;
        }
    }

    [[nodiscard]] TemplateCandidate make_offer(const PatchFeatures& patch,
                                               const Candidate& candidate) const {
        TemplateCandidate offer;
        offer.cost = candidate.match.cost;
        for (std::size_t l = 0; l < patch.loops.size(); ++l) {
            const int curve = patch.loops[l].side.curve;
            if (!is_cut(curve)) continue;
            CutDemand demand{curve, cap_pattern(*candidate.shape, candidate.match.caps[l]), {}};
            const std::map<int, int> places = places_on(patch, candidate.match, l);
            for (const int node : demand.pattern.loop) demand.places.push_back(places.at(node));
            offer.cuts.push_back(std::move(demand));
        }
        return offer;
    }

    // For each node of a template on a loop where it lies on the cut, in the cut's direction: at a
    // vertex, or the so many-th between two.
    [[nodiscard]] std::map<int, int> places_on(const PatchFeatures& patch,
                                               const TemplateMatch& match, std::size_t l) const {
        const PatchFeatures::Loop& loop = patch.loops[l];
        const std::vector<int>& nodes = match.loop_nodes[l];
        const auto n = static_cast<int>(nodes.size());
        std::map<int, int> places;
        if (loop.nodes.empty()) {
            for (int k = 0; k < n; ++k) {
                places[nodes[k]] = (loop.side.is_left ? k : (n - k) % n) * place_step;
            }
            return places;
        }
        const auto& vertices = pants_.curves[loop.side.curve].curve.vertices;
        std::map<int, int> position;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            position[vertices[k].idx()] = static_cast<int>(k);
        }
        std::map<int, int> fixed;
        for (const int node : loop.nodes) {
            fixed[match.nodes[node]] = position.at(patch.nodes[node].vertex.idx()) * place_step;
        }
        // Along the cut's direction from a fixed node on.
        std::vector<int> along = nodes;
        if (!loop.side.is_left) std::reverse(along.begin() + 1, along.end());
        int place = 0;
        for (const int node : along) {
            const auto known = fixed.find(node);
            place = known != fixed.end() ? known->second : place + 1;
            places[node] = place;
        }
        return places;
    }

    void glue() {
        std::vector<CuboidTemplate> shapes;
        for (const Candidate& candidate : chosen_) shapes.push_back(*candidate.shape);
        std::map<int, std::vector<PatchCap>> caps_of_curve;
        for (int p = 0; p < n_patches_; ++p) {
            for (std::size_t l = 0; l < patches_[p].loops.size(); ++l) {
                caps_of_curve[patches_[p].loops[l].side.curve].push_back(
                    {p, chosen_[p].match.caps[l]});
            }
        }
        std::vector<CapJoint> joints;
        std::map<std::string, std::vector<CuboidSide>> sets;
        for (const auto& [curve, caps] : caps_of_curve) {
            if (is_cut(curve)) {
                joints.push_back({caps.at(0), caps.at(1), rotations_.at(curve)});
            }
        }
        glued_ = glue_templates(shapes, joints);
        int n_nameless = 0;
        for (const auto& [curve, caps] : caps_of_curve) {
            if (is_cut(curve)) continue;
            std::string name = pants_.curves[curve].name;
            if (name.empty()) name = fmt::format("cap_{}", ++n_nameless);
            for (CuboidSide side : shapes[caps[0].patch].cap_sides(caps[0].cap)) {
                side.cuboid += glued_.first_cuboid[caps[0].patch];
                sets[name].push_back(side);
            }
        }
        glued_.layout.sets = std::move(sets);
    }

    [[nodiscard]] std::vector<int> glued_nodes(int p, const std::vector<int>& nodes) const {
        std::vector<int> there;
        for (const int node : nodes) there.push_back(glued_.nodes[p][node]);
        return there;
    }

    [[nodiscard]] std::vector<LayoutTie> make_ties() const {
        std::vector<LayoutTie> ties;
        std::vector<bool> is_tied(pants_.curves.size(), false);
        for (int p = 0; p < n_patches_; ++p) {
            const PatchFeatures& patch = patches_[p];
            for (std::size_t c = 0; c < patch.curves.size(); ++c) {
                ties.push_back({patch.curves[c].vertices,
                                glued_nodes(p, chosen_[p].match.curves[c]), true,
                                patch.curves[c].kind == ArcKind::reflex,
                                fmt::format("sharp edge {} of patch {}", c, p)});
            }
            for (std::size_t l = 0; l < patch.loops.size(); ++l) {
                const int curve = patch.loops[l].side.curve;
                if (is_tied[curve]) continue;
                is_tied[curve] = true;
                tie_loop(p, l, ties);
            }
        }
        return ties;
    }

    // The parts of a loop between feature nodes, or between evenly spread nodes.
    void tie_loop(int p, std::size_t l, std::vector<LayoutTie>& ties) const {
        const PatchFeatures::Loop& loop = patches_[p].loops[l];
        const std::vector<int> nodes = glued_nodes(p, chosen_[p].match.loop_nodes[l]);
        const auto n = static_cast<int>(nodes.size());
        // Positions of fixed nodes: on the loop, and among its nodes.
        std::vector<std::pair<int, int>> fixed;
        if (loop.nodes.empty()) {
            const std::vector<int> places = even_places(opened_, loop.vertices, n);
            for (int k = 0; k < n; ++k) fixed.emplace_back(places[k], k);
        }
        for (const int node : loop.nodes) {
            const auto vertex = std::ranges::find(loop.vertices, patches_[p].nodes[node].vertex);
            const auto here =
                std::ranges::find(nodes, glued_.nodes[p][chosen_[p].match.nodes[node]]);
            fixed.emplace_back(vertex - loop.vertices.begin(), here - nodes.begin());
        }
        const std::size_t first = ties.size();
        add_ties(loop.vertices, nodes, fixed, fmt::format("curve {}", loop.side.curve), ties);
        for (std::size_t t = first; t < ties.size(); ++t) {
            ties[t].is_feature = is_sharp(ties[t].vertices);
            ties[t].is_reflex = ties[t].is_feature && is_reflex(ties[t].vertices);
        }
    }

    // The six nodes of one cuboid around two opposite ones lie on the equator.
    void tie_equator(int p, SurfaceMesh& mesh, std::vector<LayoutTie>& ties) const {
        constexpr std::array<int, 6> around{1, 3, 2, 6, 4, 5};
        const std::vector<VertexHandle> loop = trace_equator(mesh).vertices;
        const auto& corners = chosen_[p].shape->layout.cuboids[0];
        std::vector<int> nodes;
        for (const int corner : around) nodes.push_back(corners[corner]);
        const auto n = static_cast<int>(nodes.size());
        std::vector<std::pair<int, int>> fixed;
        const std::vector<int> places = even_places(mesh, loop, n);
        for (int k = 0; k < n; ++k) fixed.emplace_back(places[k], k);
        add_ties(loop, glued_nodes(p, nodes), fixed, "equator", ties);
    }

    // Ties along a closed path from each fixed node to the next.
    // @param fixed  positions in the path and among the nodes, in order
    static void add_ties(const std::vector<VertexHandle>& path, const std::vector<int>& nodes,
                         const std::vector<std::pair<int, int>>& fixed, const std::string& name,
                         std::vector<LayoutTie>& ties) {
        const auto n_vertices = static_cast<int>(path.size());
        const auto n = static_cast<int>(nodes.size());
        for (std::size_t f = 0; f < fixed.size(); ++f) {
            const auto [v, k] = fixed[f];
            auto [v_end, k_end] = fixed[(f + 1) % fixed.size()];
            if (v_end <= v) v_end += n_vertices;
            if (k_end <= k) k_end += n;
            LayoutTie tie;
            tie.name = name;
            for (int i = v; i <= v_end; ++i) tie.vertices.push_back(path[i % n_vertices]);
            for (int i = k; i <= k_end; ++i) tie.nodes.push_back(nodes[i % n]);
            ties.push_back(std::move(tie));
        }
    }

    // Whether a path runs along sharp edges or the boundary.
    [[nodiscard]] bool is_sharp(const std::vector<VertexHandle>& path) const {
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const HalfedgeHandle h = opened_.find_halfedge(path[k], path[k + 1]);
            const EdgeHandle edge = opened_.edge_handle(h);
            if (opened_.data(edge).feature < 0 && !opened_.is_boundary(edge)) return false;
        }
        return true;
    }

    [[nodiscard]] bool is_reflex(const std::vector<VertexHandle>& path) const {
        const EdgeHandle first = opened_.edge_handle(opened_.find_halfedge(path[0], path[1]));
        return !opened_.is_boundary(first) && kind_along(opened_, path) == ArcKind::reflex;
    }

    // The glued layout with sheets of cuboids where outer sides of one meet at no sharp edge, and
    // the ties on it.
    [[nodiscard]] VolumetricLayout padded(std::vector<LayoutTie>& ties) const {
        const LayoutBoundary before = layout_boundary(glued_.layout);
        std::vector<bool> is_smooth(before.layout.n_arcs(), true);
        for (const LayoutTie& tie : ties) {
            if (!tie.is_feature || tie.is_reflex) continue;
            for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
                is_smooth[before.layout.find_arc(tie.nodes[k], tie.nodes[k + 1])] = false;
            }
        }
        PaddedLayout padded = pad_layout(glued_.layout, is_smooth);
        const LayoutBoundary after = layout_boundary(padded.layout);
        for (LayoutTie& tie : ties) {
            std::vector<int> nodes{padded.node_in_place[tie.nodes[0]]};
            for (std::size_t k = 1; k < tie.nodes.size(); ++k) {
                const int next = padded.node_in_place[tie.nodes[k]];
                for (const int node : shortest_way(after.layout, nodes.back(), next)) {
                    nodes.push_back(node);
                }
            }
            tie.nodes = std::move(nodes);
        }
        return std::move(padded.layout);
    }

    // Nodes behind the first one up to the last: a sheet that ends beside an arc divides those that
    // meet it.
    [[nodiscard]] static std::vector<int> shortest_way(const QuadLayout& layout, int from, int to) {
        if (layout.find_arc(from, to) >= 0) return {to};
        std::vector<std::vector<int>> neighbours(layout.n_nodes());
        for (const QuadLayout::Arc& arc : layout.arcs()) {
            neighbours[arc.from].push_back(arc.to);
            neighbours[arc.to].push_back(arc.from);
        }
        std::vector<int> before(layout.n_nodes(), -1);
        std::vector<int> queue{from};
        before[from] = from;
        for (std::size_t k = 0; k < queue.size() && before[to] < 0; ++k) {
            for (const int next : neighbours[queue[k]]) {
                if (before[next] >= 0) continue;
                before[next] = queue[k];
                queue.push_back(next);
            }
        }
        std::vector<int> way;
        for (int node = to; node != from; node = before[node]) way.push_back(node);
        std::ranges::reverse(way);
        return way;
    }

    const SurfaceMesh& opened_;
    const PantsDecomposition& pants_;
    const ClosingCaps& caps_;
    const TemplateLibrary& library_;
    const MatchOptions& options_;
    std::vector<PatchFeatures> patches_;
    int n_patches_;
    std::vector<Candidate> chosen_;
    std::map<int, int> rotations_;
    GluedLayout glued_;
};

}  // namespace

CuboidDecomposition decompose_into_cuboids(const SurfaceMesh& opened, const Features& features,
                                           const PantsDecomposition& pants, const ClosingCaps& caps,
                                           const TemplateLibrary& library,
                                           const MatchOptions& options) {
    return Decomposer(opened, features, pants, caps, library, options).run();
}

}  // namespace couture::meshing
