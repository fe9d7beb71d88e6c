#pragma once

#include "meshing/layout/layout_samples.h"
#include "meshing/volume/layout_cells.h"
#include "meshing/volume/parameterize_volume.h"
#include "meshing/volume/surface_fit.h"

namespace couture::meshing {

struct LayoutVolumeOptions {
    /// In all directions; 1 to iga::max_degree.
    int degree = 2;
    /// Spline elements of each sheet of the volume (see LayoutCells::sheets), or one number for
    /// all.
    std::vector<int> n_elements{4};
    /// Instead of degree and numbers of elements: for each edge of LayoutCells its open knot vector
    /// in its direction; those of a sheet conform.
    std::vector<iga::KnotVector> knots = {};
    FitOptions fit = {};
    ParameterizationOptions parameterization = {};
    /// Afterwards the boundary slides too (see optimize_volume); it stays within the tolerance
    /// there.
    bool slide_boundary = false;
};

/// Distances of the samples from the boundary's splines before it slides.
struct LayoutFitReport {
    /// The largest, and the arc or quad of the samples that has it (quad -1: the arc).
    double max_distance = 0.0;
    int worst_arc = -1;
    int worst_quad = -1;
    /// Root of the mean square.
    double rms_distance = 0.0;
};

struct LayoutVolumeReport : LayoutFitReport {
    int euler_characteristic = 0;
    ParameterizationReport parameterization;
    iga::QualitySummary<3> quality;
};

struct LayoutVolume {
    iga::MultiPatch<3> volume;
    LayoutVolumeReport report;
};

struct LayoutSurfaces {
    /// In the order of the samples' quads, normals outwards; no interfaces.
    iga::MultiPatch<2> surfaces;
    LayoutFitReport report;
};

/// The boundary of make_layout_volume alone: one spline surface per quad.
///
/// @throws InputError, TopologyError  as make_layout_volume, for the samples
[[nodiscard]] LayoutSurfaces make_layout_surfaces(const VolumetricLayout& layout,
                                                  const LayoutSamples& samples,
                                                  const LayoutVolumeOptions& options = {});

/// One trivariate spline per cuboid of a layout, whose boundary runs near samples of a surface.
///
/// Corners interpolate the nodes, then each arc is fitted once, then each face once with its
/// border fixed; nodes inside are placed with straight cuboids (see place_inner_nodes), inner edges
/// are straight, inner faces and volumes Coons patches; then all control points that are not on the
/// boundary move (see parameterize_volume). If cuboids stay folded, inner edges start bent as those
/// around them (see bend_edges). All edges of a sheet have one open knot vector, uniform unless
/// given: neighbours share control points exactly.
///
/// Whether det J is certified, and the quality: see the report.
///
/// @param samples  of the layout's boundary: nodes are those of the volume, quads in any order and
///                 rotation
/// @throws InputError     for options out of range, and samples that are too few (two per spline
///                        element) or don't fit to each other
/// @throws TopologyError  if the samples' quads are not the layout's boundary, or the cuboids make
///                        no solid (see check_volume_boundary)
///
/// Source: [Maquart19] Sec. 6.3.5; [PieglTiller97] Sec. 9.4 for the fits.
[[nodiscard]] LayoutVolume make_layout_volume(const VolumetricLayout& layout,
                                              const LayoutSamples& samples,
                                              const LayoutVolumeOptions& options = {});

}  // namespace couture::meshing
