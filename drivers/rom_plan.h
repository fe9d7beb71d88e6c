#pragma once

#include <string>
#include <vector>

#include "io/family_members.h"
#include "io/rom_section.h"

namespace couture::drivers {

/// The points that a reduced model is learned from: each of the geometries with each of the loads
/// and each of the materials. Factored parameters stay in the middle of their ranges.
struct RomPlan {
    rom::ParameterSpace space;
    /// Positions of the parameters that vary, by group.
    std::vector<int> geometry;
    std::vector<int> load;
    std::vector<int> material;
    /// In the unit cube, n x (parameters of the group); one row where the group has none.
    MatrixX geometry_points;
    MatrixX load_points;
    MatrixX material_points;
    /// In the units, of the member that fixes connectivity and discretization.
    VectorX reference;
    /// Positions of the geometries whose displacements are projected onto those of all others.
    int first_projected = 0;
    int n_projected = 0;
    /// Of the design `list`: the first geometries' files, if they have any.
    std::vector<io::FamilyMember> listed;

    [[nodiscard]] int n_geometries() const { return static_cast<int>(geometry_points.rows()); }
    [[nodiscard]] bool is_projected(int i_geometry) const {
        return i_geometry >= first_projected && i_geometry < first_projected + n_projected;
    }
    [[nodiscard]] int n_loads() const { return static_cast<int>(load_points.rows()); }
    [[nodiscard]] int n_materials() const { return static_cast<int>(material_points.rows()); }
    [[nodiscard]] int n_snapshots() const { return n_geometries() * n_loads() * n_materials(); }
    /// Of all parameters, in their units.
    [[nodiscard]] VectorX point(int i_geometry, int i_load, int i_material) const;
    /// "1422 geometries (1200 projected)".
    [[nodiscard]] std::string geometries_text() const;
    /// The listed member at a point of the parameters; null if there is none.
    [[nodiscard]] const io::FamilyMember* member_at(const VectorX& point) const;
    /// Appends points of the geometry. @param points  n x parameters of the group, unit cube
    void add_geometries(const MatrixX& points);
};

/// The designs of a deck's section [rom]: that of the geometry, and all combinations of the levels
/// of loads and of materials.
///
/// Geometries that are projected follow those of the design, at points of the Sobol sequence.
///
/// The reference member is in the middle of all ranges, of listed members the one nearest to it.
///
/// Source: [Maquart19] Eq. (7.4).
/// @throws FileError, InputError  what read_member_table throws; for a table without a column of a
///                     geometric parameter, with columns that are none, or values out of range
[[nodiscard]] RomPlan make_rom_plan(const io::RomSection& section);

/// Points at which a model is tested: a maximin Latin hypercube over all parameters, the factored
/// ones among them. Each point is a geometry of its own. Of the design `list` all members of the
/// table `validation`, the other parameters from the hypercube.
///
/// @throws InputError  for a list without a table `validation`, and as make_rom_plan
[[nodiscard]] RomPlan make_validation_plan(const io::RomSection& section, int n_points,
                                           std::uint64_t seed);

}  // namespace couture::drivers
