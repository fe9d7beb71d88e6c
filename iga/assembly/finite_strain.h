#pragma once

#include <optional>
#include <vector>

#include "iga/core/buffer.h"
#include "iga/linalg/block_matrix.h"
#include "iga/mechanics/problem.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// How the volumetric part of the stored energy is integrated.
enum class Volumetric {
    full,       ///< as it is; locks near incompressibility
    projected,  ///< through the projection of the change of volume onto splines of one degree less
    automatic   ///< projected where Poisson's ratio is above 0.49
};

/// Where a deformation compresses its body most.
template <int d>
struct SmallestVolume {
    double det_F = 1.0;
    int patch = 0;
    Vector<d> xi = Vector<d>::Zero();
};

/// A hyperelastic body in total Lagrangian form: its forces and its tangent at a displacement,
/// from the displacement gradients that it keeps at the quadrature points of the assembly.
template <int d>
class FiniteStrain {
  public:
    /// @param problem  must outlive this
    /// @param n_gauss_points  per direction and element; nothing: degree + 1
    /// @throws InputError  if a patch has no hyperelastic material, or for plane stress
    FiniteStrain(const SpacePtr<d>& space, const Problem& problem,
                 std::optional<int> n_gauss_points = {});

    /// Moves the body. With det F <= 0 anywhere the other functions have no meaning.
    ///
    /// @param displacement  n_dofs x d
    SmallestVolume<d> deform(const MatrixX& displacement);

    /// Integral of P : grad v on each function: n_dofs x d.
    [[nodiscard]] MatrixX internal_forces() const;
    /// Derivative of the internal forces, into a matrix made by `make_pattern`.
    void tangent(BlockMatrix& matrix) const;
    /// Integral of the stored energy.
    [[nodiscard]] double energy() const;

    /// F - I at a quadrature point of a plane of a patch.
    [[nodiscard]] Matrix<3> displacement_gradient(int patch, int i_plane, int i_point) const;

  private:
    [[nodiscard]] const Hyperelastic& material(int patch) const;

    SpacePtr<d> space_;
    const Problem& problem_;
    std::optional<int> n_gauss_points_;
    std::vector<int> materials_;
    /// Of each patch: points per plane, and [plane][point][3 x 3].
    struct PatchGradients {
        int points_per_plane = 0;
        int n_planes = 0;
        Buffer<double> H;
    };
    std::vector<PatchGradients> gradients_;
};

}  // namespace couture::iga
