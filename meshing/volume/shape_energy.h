#pragma once

#include <array>
#include <vector>

#include "iga/spline/bspline_basis.h"
#include "iga/topology/dof_map.h"
#include "iga/topology/multipatch.h"
#include "meshing/volume/mean_ratio.h"

namespace couture::meshing {

struct EnergyGradient {
    double value = 0.0;
    /// 3 x n_dofs.
    MatrixX gradient;
};

/// The worst samples of all elements.
struct ShapeSummary {
    /// Smallest 1 / mean ratio, in [-1, 1]; negative where folded.
    double min_inverse_mean_ratio = 1.0;
    int patch = 0;
    Vector3 xi = Vector3::Zero();
    /// Largest shape ratio of the elements' corners (see shape_ratio).
    double max_shape_ratio = 0.0;
    /// Smallest det J over the product of the lengths of its columns.
    double min_scaled_jacobian = 1.0;
};

/// How far the elements of a multipatch volume are from cubes, as a function of its control points.
///
/// E = mean over elements of (mean over samples of mu^m + weight (S / sqrt(3))^n + the part of
/// sizes), mu =
/// |J|^3 / (3 sqrt(3) det J) the inverse mean ratio of the map from the unit cube to the element,
/// sampled at the element's corners and (degree + 1)^3 Gauss points (or as many as asked for), or
/// densely, also on its faces and edges, where asked for, S the smooth shape ratio of its corners.
/// 1 + weight for cubes, independent of size. Corners at
/// which `geometry` is singular (collapsed sides, corners with a straight angle) are left out, as
/// are samples on faces and edges between such corners only, and such elements have no S. Sums run
/// in a fixed order: results do not depend on the number of threads.
///
/// Source: [Knupp01] for the mean ratio; [Escobar03] for its regularisation; [Garanzha21] for
/// the part of sizes.
class ShapeEnergy {
  public:
    /// @param geometry  spaces and weights; its points choose the corners left out
    /// @param orientations  of the patches, +1 or -1
    /// @param boxes  for each patch the proportions of the box that its elements tend to in place
    /// of
    ///               a cube (the mean ratio is that of the map from the box of volume 1; shape
    ///               ratios remain those of cubes); empty: cubes
    /// @param n_more_points  Gauss points per direction beyond the degree, 0 or more
    ShapeEnergy(const iga::MultiPatch<3>& geometry, const iga::DofMap& dofs,
                const std::vector<int>& orientations, const std::vector<Vector3>& boxes = {},
                int n_more_points = 1);

    /// @param points  control points, 3 x n_dofs
    [[nodiscard]] double value(const MatrixX& points, const ShapeMeasure& measure) const;
    [[nodiscard]] EnergyGradient with_gradient(const MatrixX& points,
                                               const ShapeMeasure& measure) const;
    [[nodiscard]] ShapeSummary summary(const MatrixX& points) const;
    /// Mean size (|J| / sqrt(3)) of the elements around each control point, n_dofs.
    [[nodiscard]] VectorX sizes(const MatrixX& points) const;
    /// Takes the sizes of elements for regularised measures from `points`.
    void set_reference(const MatrixX& points);
    /// Samples elements of a patch at a grid of (2 degree + 1)^3 points, its border included.
    ///
    /// @param elements  of the patch, first direction fastest
    /// @return whether one of them was not sampled so before
    bool sample_densely(int patch, const std::vector<int>& elements);
    /// By patch, the elements without dense samples whose scaled Jacobian falls below `limit`
    /// at one.
    [[nodiscard]] std::vector<std::vector<int>> elements_below(const MatrixX& points,
                                                               double limit) const;

  private:
    /// The kinds of samples: each element has a grid of its corners, and Gauss points or a dense
    /// grid.
    enum Kind { corners, gauss, dense, n_kinds };
    /// Functions at the samples of one kind, by direction; derivatives by the coordinates of the
    /// unit cube.
    using Tables = std::array<iga::BasisTable, 3>;
    struct PatchTables {
        int orientation = 1;
        std::array<int, 3> n_basis{};
        std::array<int, 3> n_elements{};
        std::array<std::vector<double>, 3> breakpoints;
        std::array<Tables, n_kinds> tables;
        /// For each kind and sample the corners of the smallest face, edge or vertex of the unit
        /// cube that holds it: bit i is corner i.
        std::array<std::vector<unsigned char>, n_kinds> corners_around;
        /// Of the patch's first element, among all.
        int first_number = 0;
        /// Of each function: global number and weight.
        std::vector<int> dofs;
        VectorX weights;
    };
    /// Elements that one thread does at a time.
    struct Chunk {
        int patch = 0;
        int first_element = 0;
        int last_element = 0;
        /// Of the first element, among all.
        int first_number = 0;
    };
    class Element;

    [[nodiscard]] double evaluate(const MatrixX& points, const ShapeMeasure& measure,
                                  MatrixX* gradient) const;
    /// Mean size^3 of each element, n_elements.
    [[nodiscard]] std::vector<double> volumes(const MatrixX& points) const;

    std::vector<PatchTables> patches_;
    std::vector<Chunk> chunks_;
    int n_dofs_ = 0;
    int n_elements_ = 0;
    /// Corner samples left out, by element: bit i is corner i.
    std::vector<unsigned char> singular_corners_;
    std::vector<bool> is_dense_;
    /// Control points of each element.
    std::vector<std::vector<int>> element_dofs_;
    std::vector<double> reference_volumes_;
};

}  // namespace couture::meshing
