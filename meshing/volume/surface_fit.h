#pragma once

#include <array>

#include "iga/spline/tensor_space.h"

namespace couture::meshing {

struct FitOptions {
    /// Weight of the thin-plate energy in units of h^(2 degree + 2), with h the length of a knot
    /// span as part of the whole: where no boundary condition holds it moves the spline by its
    /// root, so the order of the error is kept.
    double fairness = 1e-5;
    /// How often samples move to the parameters of their nearest points of the spline, which is
    /// then fitted again.
    int n_corrections = 2;
};

struct SplineFit {
    /// n_basis x 3.
    MatrixX control_points;
    /// Distances of the samples from the spline, at their parameters after one more correction.
    double max_distance = 0.0;
    double sum_of_squares = 0.0;
};

/// The curve through the first and the last of some points and near the others: least squares with
/// a little bending energy, parameters uniform at first.
///
/// @param points  3 x n, n - 1 at least twice the number of elements (see check_n_samples)
[[nodiscard]] SplineFit fit_curve(const iga::KnotVector& knots, const MatrixX& points,
                                  const FitOptions& options = {});

/// The surface with a given border that is near the points of a grid: least squares with a little
/// thin-plate energy for the control points inside.
///
/// @param net  n_basis x 3; inner rows have no meaning
/// @param points  3 x (n[0] n[1]), first direction fastest
/// @param n  points per direction, those on the border included
[[nodiscard]] SplineFit fit_surface(const iga::TensorSpace<2>& space, const MatrixX& net,
                                    const MatrixX& points, const std::array<int, 2>& n,
                                    const FitOptions& options = {});

/// @throws InputError  for a fairness that is negative or not finite, or corrections out of [0, 20]
void check_fit_options(const FitOptions& options);

}  // namespace couture::meshing
