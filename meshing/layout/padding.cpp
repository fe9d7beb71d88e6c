#include "meshing/layout/padding.h"

#include <algorithm>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check_size(const QuadLayout& layout, const std::vector<bool>& is_smooth) {
    if (static_cast<int>(is_smooth.size()) != layout.n_arcs()) {
        throw InputError("{} arcs are said to be smooth or not; the layout has {} outer ones",
                         is_smooth.size(), layout.n_arcs());
    }
}

std::vector<int> flat_arcs_of(const LayoutBoundary& boundary, const std::vector<bool>& is_smooth) {
    std::vector<int> flat;
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        const auto& [left, right] = boundary.layout.arc_quads(a);
        if (is_smooth[a] && boundary.sides[left.quad].cuboid == boundary.sides[right.quad].cuboid) {
            flat.push_back(a);
        }
    }
    return flat;
}

/// For each node the arcs there.
std::vector<std::vector<int>> arcs_at_nodes(const QuadLayout& layout) {
    std::vector<std::vector<int>> arcs(layout.n_nodes());
    for (int a = 0; a < layout.n_arcs(); ++a) {
        arcs[layout.arcs()[a].from].push_back(a);
        arcs[layout.arcs()[a].to].push_back(a);
    }
    return arcs;
}

bool is_border(const QuadLayout& layout, int arc, const std::vector<bool>& is_chosen) {
    const auto& [left, right] = layout.arc_quads(arc);
    return is_chosen[left.quad] != is_chosen[right.quad];
}

/// Arcs at a node that part chosen quads from others: 0, or 2 for one fan.
int n_borders(const QuadLayout& layout, const std::vector<int>& arcs,
              const std::vector<bool>& is_chosen) {
    return static_cast<int>(
        std::ranges::count_if(arcs, [&](int arc) { return is_border(layout, arc, is_chosen); }));
}

/// The smooth parts of the wall that hold flat arcs, and those that fill the gaps where they touch
/// themselves at a node.
std::vector<bool> parts_to_pad(const LayoutBoundary& boundary, const std::vector<bool>& is_smooth) {
    const QuadLayout& layout = boundary.layout;
    DisjointSets parts(layout.n_quads());
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (is_smooth[a]) parts.join(layout.arc_quads(a)[0].quad, layout.arc_quads(a)[1].quad);
    }
    std::vector<bool> is_padded_part(layout.n_quads(), false);
    for (const int arc : flat_arcs_of(boundary, is_smooth)) {
        is_padded_part[parts.find(layout.arc_quads(arc)[0].quad)] = true;
    }
    const auto arcs_at = arcs_at_nodes(layout);
    std::vector<bool> is_chosen(layout.n_quads());
    for (bool has_grown = true; has_grown;) {
        has_grown = false;
        for (int q = 0; q < layout.n_quads(); ++q) is_chosen[q] = is_padded_part[parts.find(q)];
        for (const auto& arcs : arcs_at) {
            if (n_borders(layout, arcs, is_chosen) <= 2) continue;
            has_grown = true;
            for (const int arc : arcs) {
                for (const auto& place : layout.arc_quads(arc)) {
                    is_padded_part[parts.find(place.quad)] = true;
                }
            }
        }
    }
    return is_chosen;
}

/// One sheet below chosen quads of the boundary.
class Sheet {
  public:
    Sheet(const VolumetricLayout& layout, const LayoutBoundary& boundary,
          const std::vector<bool>& is_chosen, const std::vector<bool>& is_smooth)
        : boundary_(boundary), is_chosen_(is_chosen), is_smooth_(is_smooth) {
        padded_.layout = layout;
        padded_.n_sheets = 1;
        copy_nodes();
        for (int q = 0; q < boundary.layout.n_quads(); ++q) place_quad(q);
        carry_sets(layout);
        carry_smoothness();
    }

    PaddedLayout take() { return std::move(padded_); }

  private:
    void copy_nodes() {
        VolumetricLayout& layout = padded_.layout;
        for (int node = 0; node < layout.n_nodes; ++node) padded_.node_in_place.push_back(node);
        for (int q = 0; q < boundary_.layout.n_quads(); ++q) {
            if (!is_chosen_[q]) continue;
            for (const int node : boundary_.layout.quads()[q]) {
                int& copy = padded_.node_in_place[node];
                if (copy != node) continue;
                copy = layout.n_nodes++;
                if (!layout.node_names.empty()) {
                    layout.node_names.resize(layout.n_nodes);
                    std::swap(layout.node_names[node], layout.node_names[copy]);
                }
            }
        }
    }

    /// A chosen quad a, b, c, d gets the cuboid between it and its copy outside.
    void place_quad(int q) {
        const CuboidSide& old_side = boundary_.sides[q];
        if (!is_chosen_[q]) {
            padded_.side_in_place[old_side] = old_side;
            return;
        }
        const auto& [a, b, c, d] = boundary_.layout.quads()[q];
        const auto& copy = padded_.node_in_place;
        const int cuboid = padded_.layout.n_cuboids();
        padded_.layout.cuboids.push_back({a, b, d, c, copy[a], copy[b], copy[d], copy[c]});
        padded_.side_in_place[old_side] = {cuboid, 5};
        // Sides of the new cuboid at the quad's sides a b, b c, c d, d a.
        constexpr std::array<int, 4> standing{2, 1, 3, 0};
        for (int k = 0; k < 4; ++k) {
            const int arc = boundary_.layout.sides(q)[k].arc;
            if (!is_border(boundary_.layout, arc, is_chosen_)) continue;
            const auto& [left, right] = boundary_.layout.arc_quads(arc);
            const int beyond = left.quad == q ? right.quad : left.quad;
            padded_.strips[{cuboid, standing[k]}] = boundary_.sides[beyond];
        }
    }

    void carry_sets(const VolumetricLayout& old) {
        std::map<CuboidSide, std::vector<CuboidSide>> strips_of;
        for (const auto& [strip, old_side] : padded_.strips) strips_of[old_side].push_back(strip);
        for (const auto& [name, old_sides] : old.sets) {
            auto& sides = padded_.layout.sets[name];
            sides.clear();
            for (const CuboidSide& side : old_sides) {
                sides.push_back(padded_.side_in_place.at(side));
                const auto& strips = strips_of[side];
                sides.insert(sides.end(), strips.begin(), strips.end());
            }
        }
    }

    void carry_smoothness() {
        const QuadLayout after = layout_boundary(padded_.layout).layout;
        padded_.is_smooth.assign(after.n_arcs(), false);
        const QuadLayout& before = boundary_.layout;
        const auto& copy = padded_.node_in_place;
        const auto arcs_at = arcs_at_nodes(before);
        for (int a = 0; a < before.n_arcs(); ++a) {
            const auto& [from, to] = before.arcs()[a];
            const bool is_at_sheet =
                is_chosen_[before.arc_quads(a)[0].quad] || is_chosen_[before.arc_quads(a)[1].quad];
            const int outer =
                is_at_sheet ? after.find_arc(copy[from], copy[to]) : after.find_arc(from, to);
            padded_.is_smooth[outer] = is_smooth_[a];
            if (!is_border(before, a, is_chosen_)) continue;
            // A side and its strip.
            padded_.is_smooth[after.find_arc(from, to)] = true;
        }
        // Two strips, on the sides that lie beside the sheet at a node where its border turns.
        for (int node = 0; node < before.n_nodes(); ++node) {
            if (n_borders(before, arcs_at[node], is_chosen_) == 0) continue;
            padded_.is_smooth[after.find_arc(node, copy[node])] =
                std::ranges::all_of(arcs_at[node], [&](int a) {
                    return is_smooth_[a] || is_chosen_[before.arc_quads(a)[0].quad] ||
                           is_chosen_[before.arc_quads(a)[1].quad];
                });
        }
    }

    const LayoutBoundary& boundary_;
    const std::vector<bool>& is_chosen_;
    const std::vector<bool>& is_smooth_;
    PaddedLayout padded_;
};

/// Where the old sides and nodes of a first sheet lie after a second one.
PaddedLayout one_after_the_other(const PaddedLayout& first, PaddedLayout second) {
    std::map<CuboidSide, CuboidSide> old_side = first.strips;
    std::map<CuboidSide, CuboidSide> in_place;
    for (const auto& [old, side] : first.side_in_place) {
        old_side[side] = old;
        in_place[old] = second.side_in_place.at(side);
    }
    std::map<CuboidSide, CuboidSide> strips;
    for (const auto& [strip, side] : first.strips) strips[second.side_in_place.at(strip)] = side;
    for (const auto& [strip, side] : second.strips) strips[strip] = old_side.at(side);
    std::vector<int> nodes;
    for (const int node : first.node_in_place) nodes.push_back(second.node_in_place[node]);
    second.side_in_place = std::move(in_place);
    second.strips = std::move(strips);
    second.node_in_place = std::move(nodes);
    second.n_sheets += first.n_sheets;
    return second;
}

}  // namespace

std::vector<int> flat_arcs(const VolumetricLayout& layout, const std::vector<bool>& is_smooth) {
    const LayoutBoundary boundary = layout_boundary(layout);
    check_size(boundary.layout, is_smooth);
    return flat_arcs_of(boundary, is_smooth);
}

PaddedLayout insert_sheet(const VolumetricLayout& layout, const std::vector<CuboidSide>& sides,
                          const std::vector<bool>& is_smooth) {
    const LayoutBoundary boundary = layout_boundary(layout);
    check_size(boundary.layout, is_smooth);
    std::vector<bool> is_chosen(boundary.sides.size(), false);
    for (const CuboidSide& side : sides) {
        const auto found = std::ranges::lower_bound(boundary.sides, side);
        if (found == boundary.sides.end() || *found != side) {
            throw InputError("a sheet below side {} of cuboid {}, which is no outer side",
                             side.side, side.cuboid);
        }
        is_chosen[found - boundary.sides.begin()] = true;
    }
    const auto arcs_at = arcs_at_nodes(boundary.layout);
    for (int node = 0; node < layout.n_nodes; ++node) {
        if (n_borders(boundary.layout, arcs_at[node], is_chosen) > 2) {
            throw TopologyError(
                "a sheet touches itself at node {}; choose all sides or one fan of them there",
                node_name(layout.node_names, node));
        }
    }
    return Sheet(layout, boundary, is_chosen, is_smooth).take();
}

PaddedLayout pad_layout(const VolumetricLayout& layout, const std::vector<bool>& is_smooth) {
    LayoutBoundary boundary = layout_boundary(layout);
    check_size(boundary.layout, is_smooth);
    PaddedLayout padded;
    padded.layout = layout;
    padded.is_smooth = is_smooth;
    for (int node = 0; node < layout.n_nodes; ++node) padded.node_in_place.push_back(node);
    for (const CuboidSide& side : boundary.sides) padded.side_in_place[side] = side;
    // Cuboids of a sheet have flat arcs of their own only where one side's cuboid makes two strips
    // that turn within a smooth part. The sheet below that part ends there with two cuboids, so
    // that each such corner asks for one sheet at most.
    while (!flat_arcs_of(boundary, padded.is_smooth).empty()) {
        const auto is_chosen = parts_to_pad(boundary, padded.is_smooth);
        padded = one_after_the_other(
            padded, Sheet(padded.layout, boundary, is_chosen, padded.is_smooth).take());
        boundary = layout_boundary(padded.layout);
    }
    return padded;
}

}  // namespace couture::meshing
