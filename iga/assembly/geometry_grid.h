#pragma once

#include <array>

#include "iga/core/buffer.h"
#include "iga/spline/bspline_basis.h"
#include "iga/spline/patch.h"

namespace couture::iga {

/// Gauss points of the elements of one direction, all elements in a row.
struct QuadratureLine {
    int n_elements = 0;
    int points_per_element = 0;
    /// Parameters and weights (with the element's length), n_elements * points_per_element.
    std::vector<double> points;
    std::vector<double> weights;
    /// Position of the points within the unit element.
    std::vector<double> unit_points;

    QuadratureLine(const KnotVector& elements, int points_per_element);
    [[nodiscard]] int n_points() const { return static_cast<int>(points.size()); }
};

/// Evaluates a spline with several columns, and its derivatives, on a tensor grid of points by sum
/// factorization, plane by plane (planes normal to the last direction; one for d = 2).
template <int d>
class SplineGrid {
  public:
    /// @param rows  n_basis x columns coefficients
    /// @param lines  points; their elements must refine those of `space`
    SplineGrid(const TensorSpace<d>& space, const TensorSpace<d>& elements, const MatrixX& rows,
               const std::array<QuadratureLine, d>& lines);

    /// Numbers from one row of columns to the next: the columns rounded up to full vectors.
    [[nodiscard]] int stride() const { return stride_; }
    /// Fills `values` with [point][0: value, 1 + k: derivative by xi_k][stride], direction 0 of the
    /// points fastest.
    void evaluate(int i_plane, Buffer<double>& values) const;

  private:
    std::array<const QuadratureLine*, d> lines_;
    std::array<BasisTable, d> tables_;
    std::array<int, d> sizes_{};
    int stride_;
    Buffer<double> rows_;
};

/// What the integrals need of the map at a plane of quadrature points (directions 0 and 1; all
/// points of a surface). Arrays run over the points, direction 0 fastest.
template <int d>
struct GeometryPlane {
    int n_points = 0;
    /// Position, 3 numbers each (z = 0 in the plane).
    Buffer<double> x;
    /// dxi_k / dx_i at [point][k][i].
    Buffer<double> inverse_jacobian;
    /// det J with its sign.
    Buffer<double> determinant;
    /// Product of the quadrature weights.
    Buffer<double> quadrature_weight;
    /// Denominator of the rational functions and its d derivatives by xi; 1 and 0 for B-splines.
    Buffer<double> denominator;
    Buffer<double> denominator_gradient;
    /// Work space: the homogeneous map.
    Buffer<double> map;
};

/// The map of a patch (of dimension d) on the tensor grid of quadrature points.
template <int d>
class GeometryGrid {
  public:
    /// @param elements  space whose elements carry the points; its breakpoints contain the patch's
    /// @throws GeometryError  if the patch is a surface in space
    GeometryGrid(const Patch<d>& patch, const TensorSpace<d>& elements,
                 const std::array<int, d>& points_per_element);
    GeometryGrid(const GeometryGrid&) = delete;
    GeometryGrid& operator=(const GeometryGrid&) = delete;

    [[nodiscard]] const QuadratureLine& line(int direction) const { return lines_[direction]; }
    /// Planes normal to the last direction (1 for d = 2).
    [[nodiscard]] int n_planes() const { return d == 3 ? lines_[d - 1].n_points() : 1; }
    [[nodiscard]] int points_per_plane() const {
        return lines_[0].n_points() * lines_[1].n_points();
    }
    /// Fills `plane` for plane `i_plane`; no error is raised where det J vanishes, its inverse is
    /// then not finite.
    void evaluate(int i_plane, GeometryPlane<d>& plane) const;
    /// @param orientation  the sign that det J must have everywhere
    /// @throws GeometryError  where it has another or vanishes: patch, place, value
    void require_orientation(int patch, int i_plane, const GeometryPlane<d>& plane,
                             double orientation) const;
    /// Parameter of a point of a plane.
    [[nodiscard]] Vector<d> parameter(int i_plane, int i_point) const;

    [[nodiscard]] const std::array<QuadratureLine, d>& lines() const { return lines_; }

  private:
    std::array<QuadratureLine, d> lines_;
    bool is_rational_;
    SplineGrid<d> map_;
};

}  // namespace couture::iga
