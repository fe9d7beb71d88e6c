#pragma once

#include <vector>

#include "rom/procrustes.h"

namespace couture::tests {

/// 24 points of the unit sphere, symmetric in the planes of coordinates and not to their exchange.
[[nodiscard]] MatrixX sphere_points();

/// The points with their coordinates scaled.
[[nodiscard]] MatrixX ellipsoid(double x, double y, double z);

/// Ellipsoids whose first two axes are 1 - 2 a, 1, 1 + 2 a and 1 - a, 1, 1 + a: all pairs.
[[nodiscard]] std::vector<MatrixX> ellipsoids(double a);

/// A rotation and translation that follow from the number.
[[nodiscard]] rom::Similarity rigid_motion(int number);

/// Each member moved by its own rigid motion.
[[nodiscard]] std::vector<MatrixX> moved(const std::vector<MatrixX>& shapes);

/// n shapes without order: normally distributed points, each member near the same ones.
[[nodiscard]] std::vector<MatrixX> random_shapes(int n_members, int n_points, double spread);

}  // namespace couture::tests
