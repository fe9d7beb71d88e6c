#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshing/field/layout_field.h"
#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/layout/layout_samples.h"
#include "meshing/parameterization/layout_map.h"
#include "meshing/parameterization/node_relocation.h"
#include "meshing/parameterization/sample_quality.h"
#include "meshing/pipeline/outer_side_names.h"
#include "meshing/pipeline/volume_distance.h"
#include "meshing/volume/hex_sampling.h"
#include "meshing/volume/layout_volume.h"

namespace couture::meshing {

/// The stages from cuboids to a volume and its hexahedra, in order.
enum class SolidStage { layout, field, map, quads, surfaces, volume, hexes };

/// Members' nodes then depend smoothly on the parameters, also where their energy is flat.
constexpr double family_node_tolerance = 1e-8;

struct SolidMeshOptions {
    /// The last stage that is run.
    SolidStage last = SolidStage::volume;
    /// Wanted length of a spline element; 0: a twentieth of the diagonal of the surface's box to
    /// begin with, and more elements where splines are farther from the surface than the tolerance
    /// (only for the stage volume).
    double element_size = 0.0;
    /// Wanted distance of splines and surface over the diagonal of the surface's box; half of it
    /// along sharp edges. Read where the element size is 0.
    double tolerance = 1e-3;
    /// Elements of each sheet of cuboids, at least.
    int min_elements = 2;
    /// The closed surface with the names of its faces: outer sides of cuboids become sets by them.
    /// Nothing: only caps are sets.
    std::optional<NamedFaces> faces = {};
    /// A field is made for the quadratic one.
    LayoutMapRoute route = LayoutMapRoute::aligned;
    /// Weight of the angle to the cross field, next to the distortion, in the aligned map; 0: no
    /// field is made for it. Nodes that move afterwards do not see the field.
    double alignment = 0.0;
    /// Steps of moving nodes at most; 0: quads stay those of the map.
    int max_relocations = NodeRelocationOptions{}.max_iterations;
    /// Nodes have moved when a step lowers their energy by less than this part of it.
    double node_tolerance = NodeRelocationOptions{}.tolerance;
    /// Points of the surface for each element and direction that splines are fitted to; at least 2.
    int samples_per_element = 4;
    /// Its numbers of elements are not read.
    LayoutVolumeOptions volume = {};
    /// Of the hexahedra in each cuboid, per direction, at least 2; nothing: as many as control
    /// points.
    std::optional<int> n_points = {};
    /// Called with what is being done; may throw to stop.
    std::function<void(std::string_view)> progress = {};
};

/// What the stages made of a solid; those behind the last one are empty.
struct SolidMesh {
    /// With the elements of its sheets in its record.
    CuboidDecomposition cuboids;
    /// If it is the last stage, or the map follows it.
    std::optional<LayoutField> field;
    std::optional<LayoutMap> map;
    /// Of the map, if it is one-to-one: one cell for each spline element.
    std::optional<LayoutSamples> mapped_quads;
    /// The same when nodes have moved.
    std::optional<LayoutSamples> quads;
    std::optional<NodeRelocationReport> relocation;
    std::optional<QuadQuality> quad_quality;
    /// Only if they are the last stage: later ones make them again.
    std::optional<LayoutSurfaces> surfaces;
    std::optional<LayoutVolume> volume;
    std::optional<VolumeDistance> distance;
    std::optional<SampledHexahedra> hexes;
};

/// From a solid's cuboids to trivariate splines: cross field, aligned global map, quads whose nodes
/// have moved to better places, splines, hexahedra.
///
/// @param cuboids  of decompose_into_cuboids, repeat_cuboids or place_layout; numbers of elements
///                 and names of sides that its record has are kept
/// @throws InputError     for options out of range, and as the stages
/// @throws GeometryError  if triangles of the map are flipped and more than the map is wanted, if
///                        quads stay turned over, and as the stages
///
/// Source: [Maquart19] Fig. 4.12, Sec. 6.3.5.
[[nodiscard]] SolidMesh mesh_solid(CuboidDecomposition cuboids,
                                   const SolidMeshOptions& options = {});

}  // namespace couture::meshing
