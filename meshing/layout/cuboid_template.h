#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "iga/core/types.h"
#include "meshing/layout/cap_pattern.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Cuboids for a patch of a surface: a volumetric layout whose caps close the patch's boundary
/// loops, with a shape that says which arcs are made for sharp edges.
///
/// Source: [Maquart19] 3.2.3, Fig. 3.11, 6.4
struct CuboidTemplate {
    std::string name;
    /// Its sets are the caps: outer sides that form a disc each; no two share a node.
    VolumetricLayout layout;
    /// Names of the caps, in the order of the patch's boundaries.
    std::vector<std::string> caps;
    /// For each node; right-handed cuboids with plane sides along the axes, as a rule.
    std::vector<Vector3> positions;

    [[nodiscard]] int n_caps() const { return static_cast<int>(caps.size()); }
    [[nodiscard]] const std::vector<CuboidSide>& cap_sides(int cap) const {
        return layout.sets.at(caps.at(cap));
    }
};

/// @throws InputError     for a wrong number of positions, caps that don't fit the sets, nodes out
///                        of range or a cuboid that is turned inside out
/// @throws TopologyError  if the cuboids are no ball whose boundary is a manifold, or a cap is no
///                        disc of outer sides or shares a node with another; all name the template
///                        and the first offending entity
void check_template(const CuboidTemplate& shape);

/// @param cap  in 0 .. n_caps() - 1
[[nodiscard]] CapPattern cap_pattern(const CuboidTemplate& shape, int cap);

/// The outer sides that belong to no cap: what is drawn on the patch. Its boundary loops are those
/// of the caps, backwards.
[[nodiscard]] LayoutBoundary wall_of(const CuboidTemplate& shape);

/// How two outer quads meet at an arc: interior angle below 135 degrees, above 225, or between.
enum class ArcKind { convex, flat, reflex };

/// For each arc of the boundary of a shape, or of its wall (whose own boundary arcs are convex as
/// caps stand upright there).
[[nodiscard]] std::vector<ArcKind> arc_kinds(const CuboidTemplate& shape,
                                             const LayoutBoundary& boundary);

/// For each node whether it is made for a corner: of its arcs that are not flat there are one, or
/// more than two, or two that turn by more than 45 degrees.
[[nodiscard]] std::vector<bool> corner_nodes(const CuboidTemplate& shape,
                                             const LayoutBoundary& boundary);

/// Templates by number of caps, then of cuboids, then name.
class TemplateLibrary {
  public:
    /// @throws InputError, TopologyError  as check_template, and for a name that is taken
    void add(CuboidTemplate shape);

    [[nodiscard]] const std::vector<CuboidTemplate>& templates() const { return templates_; }
    [[nodiscard]] std::span<const CuboidTemplate> with_caps(int n_caps) const;
    /// @throws InputError  if there is none; offers the nearest name
    [[nodiscard]] const CuboidTemplate& find(std::string_view name) const;

  private:
    std::vector<CuboidTemplate> templates_;
};

}  // namespace couture::meshing
