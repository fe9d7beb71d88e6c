#pragma once

#include <span>
#include <vector>

#include "meshing/layout/volumetric_layout.h"
#include "meshing/volume/parameterize_volume.h"

namespace couture::meshing {

struct SurfacesOptions {
    /// Corners this close together are one, and surfaces with the same corners this close together
    /// are duplicates; in parts of the size of the whole.
    double tolerance = 1e-6;
    /// Of volumes whose Coons patch is folded; without rounds they are only unfolded.
    ParameterizationOptions parameterization{.max_rounds = 0};
};

/// What became of the surfaces, by their numbers.
struct SurfacesReport {
    struct Duplicate {
        int surface = 0;
        /// The one that was taken.
        int original = 0;
        /// Largest distance between the two at equal parameters. More than the tolerance: another
        /// surface with the same corners, which no cuboid can have.
        double gap = 0.0;
    };
    std::vector<Duplicate> duplicates;
    /// Two of the four corners are one.
    std::vector<int> collapsed;
    /// Bound no volume.
    std::vector<int> unused;
    /// Sets of six surfaces that enclose other volumes, left out.
    std::vector<std::array<int, 6>> enclosing;
    /// Edges whose surfaces have other control points there (in a common basis), with the largest
    /// distance from the mean, which they got.
    int n_fitted_edges = 0;
    double max_edge_gap = 0.0;
    ParameterizationReport parameterization;
};

struct VolumesFromSurfaces {
    iga::MultiPatch<3> volume;
    /// For each patch its surfaces on sides 0 to 5.
    std::vector<std::array<int, 6>> surfaces;
    SurfacesReport report;
};

/// All volumes that are bounded by six of some surfaces, as one conforming multipatch of Coons
/// patches; surfaces in any order and orientation, with any scale of their knots, some repeated.
///
/// Sets of six are found by their corners alone. Volumes on one side of the same surface overlap:
/// the larger one encloses others and is left out. Degrees and knots are raised to common ones in
/// each sheet. Borders that agree only in their ends become the mean of their surfaces' borders;
/// the change runs out across the surfaces as a Coons patch. Inner hollows with six surfaces can't
/// be told from volumes and become such.
///
/// @throws InputError     if a surface is not in space, there is none, or the tolerance is not in
///                        (0, 0.1), and if a volume of rational surfaces gets a weight that is not
///                        positive
/// @throws TopologyError  if no six surfaces bound a volume
///
/// Source: [Maquart19] Sec. B.2.1. Differs: knots need not be as many.
[[nodiscard]] VolumesFromSurfaces volumes_from_surfaces(std::span<const iga::Surface> surfaces,
                                                        const SurfacesOptions& options = {});

}  // namespace couture::meshing
