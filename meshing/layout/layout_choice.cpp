#include "meshing/layout/layout_choice.h"

#include <algorithm>

#include "iga/core/error.h"
#include "meshing/layout/glue.h"
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

class Chooser {
  public:
    Chooser(const SurfaceMesh& opened, const std::vector<PatchFeatures>& patches,
            const PantsDecomposition& pants, const TemplateLibrary& library,
            const MatchOptions& options)
        : opened_(opened),
          patches_(patches),
          pants_(pants),
          library_(library),
          options_(options),
          n_patches_(static_cast<int>(patches.size())) {}

    LayoutChoice run() {
        std::vector<std::vector<Candidate>> candidates(n_patches_);
        std::vector<std::vector<TemplateCandidate>> offers(n_patches_);
        for (int p = 0; p < n_patches_; ++p) {
            const PatchFeatures& patch = patches_[p];
            for (const CuboidTemplate& shape :
                 library_.with_caps(static_cast<int>(patch.loops.size()))) {
                if (patch.is_bare() && shape.layout.n_cuboids() > 1) continue;
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
        LayoutChoice result;
        for (int p = 0; p < n_patches_; ++p) {
            Candidate& chosen = candidates[p][choice.candidates[p]];
            result.templates.push_back(chosen.shape->name);
            result.matches.push_back(std::move(chosen.match));
        }
        result.rotations = choice.rotations;
        return result;
    }

  private:
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
            "corners inside. Templates with so many caps: {}. {}Take plane faces off as caps "
            "(open, open_facing), add a template, or lay the cuboids by hand (layout)",
            p, patch.loops.size(), patch.curves.size(), n_corners, names.empty() ? "none" : names,
            std::ranges::any_of(patch.loops,
                                [&](const auto& loop) { return is_cut(loop.side.curve); })
                ? "Let cuts cross sharp edges, not run along them (another criterion, loops). "
                : "");
    }

    // Whether all loops have vertices for their nodes.
    [[nodiscard]] static bool has_room(const PatchFeatures& patch, const TemplateMatch& match) {
        for (std::size_t l = 0; l < patch.loops.size(); ++l) {
            if (patch.loops[l].vertices.size() < match.loop_nodes[l].size()) return false;
        }
        return true;
    }

    [[nodiscard]] bool is_cut(int curve) const {
        return pants_.curves[curve].kind != PantsCurveKind::boundary;
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

    const SurfaceMesh& opened_;
    const std::vector<PatchFeatures>& patches_;
    const PantsDecomposition& pants_;
    const TemplateLibrary& library_;
    const MatchOptions& options_;
    int n_patches_;
};

}  // namespace

LayoutChoice choose_layout(const SurfaceMesh& opened, const std::vector<PatchFeatures>& patches,
                           const PantsDecomposition& pants, const TemplateLibrary& library,
                           const MatchOptions& options) {
    return Chooser(opened, patches, pants, library, options).run();
}

}  // namespace couture::meshing
