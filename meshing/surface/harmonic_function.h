#pragma once

#include <array>
#include <span>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// How much a vertex is pulled by each of its neighbours; all weights are positive.
enum class HarmonicWeights {
    /// Mean value coordinates (tan(gamma/2) + tan(delta/2)) / length, with the two angles beside
    /// the edge: exact for linear functions on a plane.
    mean_value,
    /// All neighbours alike: every vertex in the middle of its neighbours, whatever the shape.
    uniform
};

/// The discrete Dirichlet problem sum_j w_ij (f_j - f_i) = 0 at every free vertex.
///
/// A free vertex on the boundary pulls towards its neighbours like one inside, each triangle at it
/// giving its share of the weights (one angle instead of two for the edges along the boundary): its
/// value is a mean of its neighbours' values, and f has no slope across the boundary in the limit
/// of a mesh that is symmetric there.
struct HarmonicProblem {
    /// Vertex numbers of each triangle.
    std::span<const std::array<int, 3>> triangles;
    /// One point per vertex.
    std::span<const Vector3> points;
    /// For each vertex whether its values are given.
    std::vector<char> is_fixed;
    /// n_vertices x k: given values; other rows don't matter. Columns are solved for together.
    MatrixX values;
    HarmonicWeights weights = HarmonicWeights::mean_value;
    /// For each vertex the one that it is a copy of, or itself; empty: no copies. Copies are free
    /// and their originals are no copies.
    std::vector<int> original;
    /// k values: f at a copy less f at its original.
    VectorX jump;
};

struct HarmonicSolution {
    /// n_vertices x k; given values as they were, zero at a vertex without triangles.
    MatrixX values;
    /// Largest |sum_j w_ij (f_j - f_i)| / sum_j w_ij of a free vertex, over the range of the given
    /// values and jumps.
    double residual = 0.0;
};

/// Solves it by one factorization for all columns.
///
/// Weights are bounded from below and above (angles of no less than 2e-10 and no more than
/// pi - 2e-10, edges of no less than 1e-12 of the mean length), so that triangles without area do
/// no harm.
///
/// @throws InputError   if no vertex of a component is fixed, or sizes don't match
/// @throws SolverError  if the residual exceeds 1e-10
///
/// Source: [Maquart19] Eq. (2.30)-(2.32), [Floater03], [Tutte63].
[[nodiscard]] HarmonicSolution solve_harmonic(const HarmonicProblem& problem);

/// The harmonic function of a piece with given values at some vertices, free elsewhere.
///
/// @param vertices  different vertices of the piece, at least one in each component
/// @param values    one for each
/// @return a value for each vertex of the piece
/// @throws InputError  for a vertex that does not exist or stands twice, and as solve_harmonic
///
/// Source: [Maquart19] Eq. (2.29)-(2.32).
[[nodiscard]] VectorX harmonic_function(const CutSurface& surface, std::span<const int> vertices,
                                        std::span<const double> values,
                                        HarmonicWeights weights = HarmonicWeights::mean_value);

}  // namespace couture::meshing
