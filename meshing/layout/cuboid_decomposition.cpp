#include "meshing/layout/cuboid_decomposition.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "iga/core/error.h"
#include "meshing/layout/blunt_path.h"
#include "meshing/layout/cut_turns.h"
#include "meshing/layout/equator.h"
#include "meshing/layout/glue.h"
#include "meshing/layout/layout_choice.h"
#include "meshing/layout/padded_ties.h"
#include "meshing/layout/patch_features.h"

namespace couture::meshing {

namespace {

// Draws a layout that was chosen.
class Drawing {
  public:
    Drawing(const SurfaceMesh& opened, const std::vector<PatchFeatures>& patches,
            const PantsDecomposition& pants, const ClosingCaps& caps,
            const TemplateLibrary& library, const LayoutChoice& choice)
        : opened_(opened),
          patches_(patches),
          pants_(pants),
          caps_(caps),
          library_(library),
          choice_(choice),
          n_patches_(static_cast<int>(patches.size())) {}

    CuboidDecomposition run() {
        glue();
        CuboidDecomposition result;
        result.mesh = close_caps(opened_, caps_);
        std::vector<LayoutTie> ties = make_ties();
        for (int p = 0; p < n_patches_; ++p) {
            if (patches_[p].is_bare()) tie_equator(p, result.mesh, ties);
        }
        draw_decomposition(std::move(glued_.layout), std::move(ties), result);
        result.templates = choice_.templates;
        return result;
    }

  private:
    [[nodiscard]] bool is_cut(int curve) const {
        return pants_.curves[curve].kind != PantsCurveKind::boundary;
    }

    void glue() {
        std::vector<CuboidTemplate> shapes;
        for (const std::string& name : choice_.templates) shapes.push_back(library_.find(name));
        std::map<int, std::vector<PatchCap>> caps_of_curve;
        for (int p = 0; p < n_patches_; ++p) {
            for (std::size_t l = 0; l < patches_[p].loops.size(); ++l) {
                caps_of_curve[patches_[p].loops[l].side.curve].push_back(
                    {p, choice_.matches[p].caps[l]});
            }
        }
        std::vector<CapJoint> joints;
        std::map<std::string, std::vector<CuboidSide>> sets;
        for (const auto& [curve, caps] : caps_of_curve) {
            if (is_cut(curve)) {
                joints.push_back({caps.at(0), caps.at(1), choice_.rotations.at(curve)});
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
                                glued_nodes(p, choice_.matches[p].curves[c]), true,
                                is_blunt(opened_, patch.curves[c].vertices),
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
        const std::vector<int> nodes = glued_nodes(p, choice_.matches[p].loop_nodes[l]);
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
                std::ranges::find(nodes, glued_.nodes[p][choice_.matches[p].nodes[node]]);
            fixed.emplace_back(vertex - loop.vertices.begin(), here - nodes.begin());
        }
        const std::size_t first = ties.size();
        add_ties(loop.vertices, nodes, fixed, fmt::format("curve {}", loop.side.curve), ties);
        for (std::size_t t = first; t < ties.size(); ++t) {
            ties[t].is_feature = is_sharp(ties[t].vertices);
            ties[t].is_blunt = ties[t].is_feature && is_blunt(opened_, ties[t].vertices);
        }
    }

    // The six nodes of one cuboid around two opposite ones lie on the equator.
    void tie_equator(int p, SurfaceMesh& mesh, std::vector<LayoutTie>& ties) const {
        constexpr std::array<int, 6> around{1, 3, 2, 6, 4, 5};
        const std::vector<VertexHandle> loop = trace_equator(mesh).vertices;
        const CuboidTemplate& shape = library_.find(choice_.templates[p]);
        const auto& corners = shape.layout.cuboids[0];
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

    const SurfaceMesh& opened_;
    const std::vector<PatchFeatures>& patches_;
    const PantsDecomposition& pants_;
    const ClosingCaps& caps_;
    const TemplateLibrary& library_;
    const LayoutChoice& choice_;
    int n_patches_;
    GluedLayout glued_;
};

// Templates fill what one shell bounds; none of the library surrounds a cavity.
void check_shells(const PantsDecomposition& pants) {
    int n_shells = 1;
    for (const PantsPatch& patch : pants.patches) n_shells = std::max(n_shells, patch.shell + 1);
    if (n_shells == 1) return;
    throw TopologyError(
        "layout: the surface has {} shells, so that the solid has {}; templates of cuboids "
        "surround "
        "none: give a layout of cuboids around them ([meshing] layout, --layout)",
        n_shells, n_shells == 2 ? "a cavity" : fmt::format("{} cavities", n_shells - 1));
}

// Whether a recorded choice names nodes and arcs that its templates have, and all cuts.
void check_choice(const LayoutChoice& choice, const PantsDecomposition& pants,
                  const TemplateLibrary& library) {
    for (std::size_t p = 0; p < choice.matches.size(); ++p) {
        const CuboidTemplate& shape = library.find(choice.templates[p]);
        const TemplateMatch& match = choice.matches[p];
        const QuadLayout wall = wall_of(shape).layout;
        const auto is_node = [&](int n) { return n < shape.layout.n_nodes; };
        bool is_right = std::ranges::all_of(match.nodes, is_node) &&
                        std::ranges::all_of(match.caps, [&](int c) { return c < shape.n_caps(); });
        for (const auto& loop : match.loop_nodes) {
            is_right = is_right && std::ranges::all_of(loop, is_node);
        }
        for (const auto& curve : match.curves) {
            is_right = is_right && curve.size() >= 2 && std::ranges::all_of(curve, is_node);
            for (std::size_t k = 0; is_right && k + 1 < curve.size(); ++k) {
                is_right = wall.find_arc(curve[k], curve[k + 1]) >= 0;
            }
        }
        if (is_right) continue;
        throw TopologyError(
            "layout: patch {} has nodes, arcs or caps in the record that its template '{}' lacks; "
            "the record was made with another template of that name",
            p, shape.name);
    }
    for (std::size_t c = 0; c < pants.curves.size(); ++c) {
        if (pants.curves[c].kind == PantsCurveKind::boundary ||
            choice.rotations.contains(static_cast<int>(c))) {
            continue;
        }
        throw TopologyError("layout: cut {} has no rotation in the record", c);
    }
}

// The sets of the recorded layout, if all are outer sides here.
void repeat_sets(const LayoutRecord& record, const std::vector<CuboidSide>& outer_sides,
                 VolumetricLayout& volume) {
    const std::set<CuboidSide> outer(outer_sides.begin(), outer_sides.end());
    for (const auto& [name, sides] : record.sets) {
        for (const CuboidSide& side : sides) {
            if (outer.contains(side)) continue;
            throw TopologyError(
                "layout: side {} of cuboid {} is in the recorded set '{}', but no outer side; the "
                "record was made with other templates, or from a surface with other sharp edges",
                side.side, side.cuboid, name);
        }
    }
    volume.sets = record.sets;
}

}  // namespace

CuboidDecomposition decompose_into_cuboids(const SurfaceMesh& opened, const Features& features,
                                           const PantsDecomposition& pants, const ClosingCaps& caps,
                                           const TemplateLibrary& library,
                                           const MatchOptions& options) {
    check_shells(pants);
    std::vector<PatchFeatures> patches = find_patch_features(opened, features, pants);
    LayoutChoice choice = choose_layout(opened, patches, pants, library, options);
    turn_smooth_cuts(opened, pants, library, patches, choice);
    CuboidDecomposition result = Drawing(opened, patches, pants, caps, library, choice).run();
    result.record = record_layout(opened, patches, choice);
    result.record.sets = result.volume.sets;
    return result;
}

CuboidDecomposition repeat_cuboids(const SurfaceMesh& opened, const Features& features,
                                   const PantsDecomposition& pants, const ClosingCaps& caps,
                                   const TemplateLibrary& library, const LayoutRecord& record) {
    check_shells(pants);
    std::vector<PatchFeatures> patches = find_patch_features(opened, features, pants);
    const LayoutChoice choice = repeat_choice(opened, record, patches);
    check_choice(choice, pants, library);
    CuboidDecomposition result = Drawing(opened, patches, pants, caps, library, choice).run();
    repeat_sets(record, result.sides, result.volume);
    result.record = record_layout(opened, patches, choice);
    result.record.elements = record.elements;
    result.record.base_elements = record.base_elements;
    result.record.area_part = record.area_part;
    result.record.sets = record.sets;
    return result;
}

}  // namespace couture::meshing
