#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"
#include "meshing/surface/harmonic_function.h"
#include "meshing/surface/map_quality.h"

namespace couture::meshing {

/// How a map came about: each is tried when exact signs show that the one before it flips
/// triangles.
enum class MapRoute {
    mean_value,
    uniform,
    /// Mean value maps of pieces (divided_map.h).
    divided
};

struct HarmonicMapOptions {
    /// What is tried first.
    HarmonicWeights weights = HarmonicWeights::mean_value;
};

struct HarmonicMapReport {
    MapRoute route = MapRoute::mean_value;
    /// Triangles that each route flipped; -1 if it was not needed.
    int n_flipped_mean_value = -1;
    int n_flipped_uniform = -1;
    /// Divisions of the last route.
    int n_divisions = 0;
    int n_split_chords = 0;
    /// Of the linear system, see HarmonicSolution; the largest of those that were solved for the
    /// whole piece.
    double residual = 0.0;
    MapDistortion distortion;
};

/// A map of a piece to the plane; every triangle turns counter-clockwise there, exactly.
struct HarmonicMap {
    /// One per vertex; zero at a vertex without triangles.
    std::vector<Vector2> parameters;
    HarmonicMapReport report;
};

/// Corners of the square [0, 1]^2, counter-clockwise from the origin.
[[nodiscard]] std::vector<Vector2> square_corners();
/// Corners of [0, width] x [0, height], counter-clockwise from the origin.
[[nodiscard]] std::vector<Vector2> rectangle_corners(double width, double height);
/// n corners on the unit circle around the origin, counter-clockwise from (1, 0).
[[nodiscard]] std::vector<Vector2> regular_polygon_corners(int n);

/// The harmonic map of a disc to a convex polygon. Each boundary part between two corners goes to
/// a side by arc length; inside by mean value weights, which are positive, so that the map is
/// one-to-one but for rounding (Theorem of Radó, Kneser and Choquet). Exact signs of all
/// triangles are checked, see MapRoute for what follows if some are flipped.
///
/// Chords that join two vertices of one side would lose their triangles' area: they are split in
/// the middle first.
///
/// @param disc     split at those chords
/// @param corners  at least three boundary vertices, counter-clockwise around the disc (as
///                 boundary_loops runs)
/// @param polygon  one point for each; strictly convex and counter-clockwise
/// @throws TopologyError  if the piece is no disc
/// @throws InputError     if corners don't lie on the boundary or are out of order, or the polygon
///                        is not convex
/// @throws GeometryError  if a boundary edge has no length, or all routes leave flipped triangles
///
/// Source: [Maquart19] Eq. (2.30)-(2.32) and Theorem 2.4, [Floater03].
[[nodiscard]] HarmonicMap map_disc_to_polygon(CutSurface& disc, std::span<const int> corners,
                                              std::span<const Vector2> polygon,
                                              const HarmonicMapOptions& options = {});

/// The same with the whole boundary on the unit circle by arc length.
///
/// @param start  the boundary vertex that goes to (1, 0)
/// @throws as map_disc_to_polygon
[[nodiscard]] HarmonicMap map_disc_to_circle(CutSurface& disc, int start,
                                             const HarmonicMapOptions& options = {});

/// Opens an annulus along a path from one boundary to the other.
///
/// @param path  halfedges
/// @return the corners of the disc that it becomes, counter-clockwise: both copies of the path's
///         start (the second one on its left) and both of its end (the first one on its left), as
///         they go to the corners of a rectangle with the path's boundary of departure below
/// @throws TopologyError  if the piece is no annulus or the path does not join its boundaries
[[nodiscard]] std::array<int, 4> open_annulus(CutSurface& annulus, std::span<const int> path);

struct AnnulusMap {
    HarmonicMap map;
    /// Parameters of both copies of a seam vertex differ by (period, 0), exactly.
    double period = 0.0;
    /// Whether the seam is free.
    bool is_periodic = false;
};

/// The harmonic map of an opened annulus to [0, width] x [0, height]: its boundaries go to the
/// lower and the upper side by arc length, the seam to the others with both copies of a vertex at
/// the same height.
///
/// With `is_periodic` the seam is free: both copies of a vertex differ by the period, and the map
/// is that of the annulus to a cylinder, wherever the seam runs. The period is the width, rounded
/// to 40 binary digits, as are the seam's first parameters, so that sums are exact. If rounding
/// flips triangles of the cylinder, the seam is made straight after all, and the result says so.
///
/// @param corners  as open_annulus returns them
/// @throws as map_disc_to_polygon; GeometryError if the two sides of the seam don't match
///
/// Source: [Maquart19] Eq. (2.30)-(2.32) with 3.1; periodic: [GortlerGotsmanThurston06].
[[nodiscard]] AnnulusMap map_opened_annulus(CutSurface& disc, const std::array<int, 4>& corners,
                                            double width, double height, bool is_periodic,
                                            const HarmonicMapOptions& options = {});

/// The harmonic map of an opened pant to [0, width] x [0, height]: the first boundary goes to the
/// lower side, the last one to the upper side, both seams and the two parts of the middle boundary
/// to the others, each by arc length. Both copies of a seam vertex have the same height.
///
/// @param corners  as open_pant (open_pant.h) returns them
/// @throws as map_disc_to_polygon; GeometryError if the two sides of a seam don't match
///
/// Source: [Maquart19] Eq. (2.30)-(2.32).
[[nodiscard]] HarmonicMap map_opened_pant(CutSurface& disc, const std::array<int, 8>& corners,
                                          double width, double height,
                                          const HarmonicMapOptions& options = {});

}  // namespace couture::meshing
