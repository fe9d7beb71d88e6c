#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "io/deck_section.h"
#include "rom/correlation.h"
#include "rom/kriging.h"
#include "rom/parameter_space.h"

namespace couture::io {

/// A parameter of a reduced model and the values of the deck that it is.
struct RomParameter {
    rom::Parameter parameter;
    /// As of --set: "geometry.parameters.R1", "resultant.0.force.1"; all get the parameter's value.
    /// Empty: a column of listed members, whose files have it.
    std::vector<std::string> keys;
    /// Equidistant values of parameters that are no geometry, both ends among them.
    int n_levels = 2;
    /// The displacement is proportional to it (a load) or to its inverse (Young's modulus): one
    /// solution serves all values.
    bool is_factored = false;
    /// Where it was written.
    std::string source;
};

/// Where the members of a model lie in the box of geometric parameters.
enum class GeometryDesign { star, full, random, sobol, lhs, smolyak, clenshaw_curtis, list };

/// What the section [rom] of a deck says.
struct RomSection {
    std::string source;
    std::vector<RomParameter> parameters;
    GeometryDesign design = GeometryDesign::star;
    /// Of star (1, 2) and sparse grids.
    int level = 1;
    /// Of random, sobol and lhs; of full on each axis.
    int n_samples = 0;
    std::uint64_t seed = 1;
    /// Geometries beside the design that are made, not solved: their displacements are projected
    /// onto those of the design.
    int n_projected = 0;
    /// Tables (see read_member_table) of the design `list`: what is learned, and what that is
    /// compared with.
    std::filesystem::path members;
    std::filesystem::path validation;
    /// One vector of geometry and displacement, each scaled by its RMS, instead of two bases.
    bool is_stacked = false;
    /// At most; nothing: as many as the tolerance asks for.
    std::optional<int> n_modes;
    /// Relative error (1.14) of the snapshots that modes may leave; 0: the numerical rank.
    double tolerance = 0.0;
    /// Displacements that point alike are learned as length and direction.
    bool has_amplitude = true;
    /// Modes are orthonormal in L2 on the reference member, else in the Euclidean sense.
    bool is_l2 = true;
    rom::CorrelationKind correlation = rom::CorrelationKind::matern_5_2;
    rom::Trend trend = rom::Trend::automatic;

    /// The box of all parameters, in their units.
    [[nodiscard]] rom::ParameterSpace space() const;
    /// Positions of a group's parameters that are not factored.
    [[nodiscard]] std::vector<int> inputs(rom::ParameterGroup group) const;
    /// What sets the parameters to a point, for parse_deck.
    ///
    /// @param point  a value of each, in its unit
    [[nodiscard]] std::vector<std::string> overrides(const VectorX& point) const;
};

/// Reads [rom], if it is there, with its [[rom.parameter]].
///
/// @param top  the deck: keys of parameters must name numbers in it (those of
///             [geometry.parameters] may be missing)
/// @param folder  that paths are relative to
[[nodiscard]] std::optional<RomSection> read_rom_section(Section& top,
                                                         const std::filesystem::path& folder);

}  // namespace couture::io
