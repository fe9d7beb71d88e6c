#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "meshing/layout/embedded_layout.h"
#include "meshing/parameterization/layout_charts.h"
#include "meshing/surface/map_quality.h"

namespace couture::meshing {

/// Two perpendicular directions in each face of a mesh that a map's axes are to follow.
struct FaceDirections {
    /// For each face the angle, counter-clockwise, from its first edge (mesh.halfedge_handle(face))
    /// to the direction that the first axis of its quad's chart is to take, in radians
    /// (chart_directions).
    std::vector<double> angles;
};

/// How a map is made of those of the quads.
enum class LayoutMapRoute {
    /// They stay as they are, each harmonic on its own.
    harmonic,
    /// Least squares to the directions over the whole surface: triangles may flip.
    quadratic,
    /// Least distortion, drawn to the directions if there is a weight: no triangle flips.
    aligned,
};

struct LayoutMapOptions {
    LayoutMapRoute route = LayoutMapRoute::aligned;
    /// Wanted length of a cell on the surface, next to that of the others, for each sheet; empty:
    /// the same for all, so that cells are to be squares.
    std::vector<double> cell_lengths;
    /// Weight of the alignment with the directions, if there are some, on the aligned route.
    double alignment_weight = 0.0;
    /// The quadratic route needs them.
    std::optional<FaceDirections> directions;
    int max_iterations = 100;
    /// The optimisation ends when a step lowers the energy by less than this part of it.
    double tolerance = 1e-6;
};

struct LayoutMapReport {
    /// Of the start and after each step; for an isometry with the wanted cells along the directions
    /// 1, on the quadratic route 0.
    std::vector<double> energies;
    bool is_converged = false;
    /// Triangles that don't turn counter-clockwise, by exact signs.
    int n_flipped = 0;
    /// Length of a cell on the surface that fits best; for sheets it is multiplied by their cell
    /// lengths.
    double cell_size = 0.0;
    MapDistortion distortion;
    /// Of the gradient of the first coordinate to its direction, mean by area, in radians; zero
    /// without directions.
    double mean_angle_to_directions = 0.0;
};

/// A map of a surface to the charts of a layout: seamless, one-to-one if nothing is flipped, nodes
/// at the corners of their charts. A face is mapped to the chart of its quad in the embedding, but
/// may lie partly beyond its sides: arcs are where the images of the charts' sides come to lie,
/// feature and boundary arcs where they were.
struct LayoutMap {
    LayoutCharts charts;
    /// For each face its corners (in the order of face_vertices) in the chart of its quad.
    std::vector<std::array<Vector2, 3>> corners;
    LayoutMapReport report;
};

/// Splits the edges that join two vertices of arcs and are no part of an arc, so that every
/// triangle can keep its area in the map of its quad.
///
/// @return number of splits
int split_layout_chords(SurfaceMesh& mesh, EmbeddedLayout& embedding);

/// The aligned global map. Each quad is mapped to its chart by a harmonic map with arcs by arc
/// length; then the symmetric Dirichlet energy (and the quadratic alignment energy
/// |grad u - u_c|^2 + |grad v - v_c|^2, times its weight) of the whole surface is minimised by
/// Newton's method with projected Hessians. Unknowns are one point per vertex, in a chart of its
/// own; the transitions across arcs eliminate the others, so that nothing but nodes, and feature
/// and boundary arcs, is held. No step is longer than eight tenths of that to the first triangle
/// without area: the map stays one-to-one.
///
/// Parameters are multiples of 2^-36, so that transitions are exact.
///
/// @param embedding  without chords (split_layout_chords)
/// @param cells      along each arc (cells_of_arcs)
/// @throws InputError     if sizes don't match, or directions are missing
/// @throws TopologyError  if an arc or a quad is not as the embedding says; names it
/// @throws GeometryError  if the map of a quad is not one-to-one
///
/// On the quadratic route the alignment energy alone is minimised, by as many linear solutions as
/// the size of cells takes to settle; nothing keeps triangles from flipping, which are counted.
///
/// Source: [Maquart19] Eq. (4.14)-(4.17): the quadratic route; [SmithSchaefer15]. Differs: arcs
/// keep to isoparametric curves because nodes are held at the corners of their charts.
[[nodiscard]] LayoutMap make_layout_map(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                        std::vector<int> cells,
                                        const LayoutMapOptions& options = {});

}  // namespace couture::meshing
