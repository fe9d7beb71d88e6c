#pragma once

#include <array>
#include <vector>

#include "iga/spline/patch.h"

namespace couture::iga {

/// A rational Bezier piece of a patch over a box of its parameters.
template <int d>
struct BezierCell {
    /// Corners of the parameter box.
    Vector<d> lower;
    Vector<d> upper;
    std::array<int, d> degrees;
    /// Homogeneous control points (weights times points, weights): prod(degree + 1) x
    /// (dimension + 1), first direction fastest.
    MatrixX rows;

    /// Control points in space, whose convex hull holds the piece.
    [[nodiscard]] MatrixX points() const {
        const VectorX inverse = rows.rightCols(1).cwiseInverse();
        return inverse.asDiagonal() * rows.leftCols(rows.cols() - 1);
    }
};

/// Point of a cell with its derivatives by the local parameter t in [0, 1]^d.
template <int d>
struct BezierPoint {
    VectorX x;
    /// dimension x d.
    Eigen::Matrix<double, Eigen::Dynamic, d> dx;
    /// d2x / dt_k dt_l in column k + d l: dimension x d^2.
    Eigen::Matrix<double, Eigen::Dynamic, d * d> ddx;
};

/// The elements of a patch, first direction fastest.
template <int d>
[[nodiscard]] std::vector<BezierCell<d>> bezier_cells(const Patch<d>& patch);

/// The two halves of a cell. Source: [PieglTiller97] Sec. 1.4 (de Casteljau).
template <int d>
[[nodiscard]] std::array<BezierCell<d>, 2> halve(const BezierCell<d>& cell, int direction);

/// Source: [PieglTiller97] Eq. (4.8), (4.20).
template <int d>
[[nodiscard]] BezierPoint<d> evaluate(const BezierCell<d>& cell, const Vector<d>& t);

}  // namespace couture::iga
