#pragma once

#include <memory>
#include <vector>

#include "iga/assembly/geometry_grid.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Projection of functions at quadrature points onto splines of one degree less than a space's, in
/// L2 over the undeformed body, patch by patch: constants of each element for degree 1 (the mean
/// dilatation of B-bar), splines of degree p - 1 and one continuity less for degree p.
///
/// Source: [Elguedj08] Sec. 3.2; [SimoTaylorPister85] for degree 1.
template <int d>
class VolumetricProjection {
  public:
    /// @param volumes  of each patch the undeformed volume of its quadrature points, [plane][point]
    VolumetricProjection(const SpacePtr<d>& space, std::optional<int> n_gauss_points,
                         std::vector<VectorX> volumes);
    VolumetricProjection(VolumetricProjection&&) noexcept;
    ~VolumetricProjection();

    /// Functions of a patch.
    [[nodiscard]] int n_functions(int patch) const;
    /// Constants of each element: their share of a tangent couples no more functions than meet.
    [[nodiscard]] bool is_elementwise(int patch) const;
    /// Mass matrix of a patch.
    [[nodiscard]] const SparseMatrix& mass(int patch) const;

    /// Coefficients of the projection of a patch's values at quadrature points.
    [[nodiscard]] VectorX project(int patch, const VectorX& values) const;
    /// The projection's values at the quadrature points, and at a parameter.
    [[nodiscard]] VectorX at_points(int patch, const VectorX& coefficients) const;
    [[nodiscard]] double value(int patch, const VectorX& coefficients, const Vector<d>& xi) const;

    /// Integrals of sum_s b[a][s] D_s v_a q over the functions v of the space and q of the patch:
    /// rows d * dof + a, columns q. D_s as in `LinearForm`.
    ///
    /// @param b  [plane][point][a][s], d x (d + 1) numbers each, with the quadrature weights
    [[nodiscard]] SparseMatrix coupling(int patch, const Buffer<double>& b) const;

  private:
    struct PatchData;
    SpacePtr<d> space_;
    std::vector<PatchData> patches_;
};

}  // namespace couture::iga
