#pragma once

#include <optional>
#include <vector>

#include "iga/assembly/bilinear_form.h"
#include "iga/assembly/reference_configuration.h"
#include "iga/assembly/volumetric_projection.h"
#include "iga/linalg/block_matrix.h"
#include "iga/mechanics/problem.h"

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

/// What the projected part of a tangent adds beyond the pattern of the space: with K the matrix of
/// `FiniteStrain::tangent`, the tangent is K + B (M / k)^-1 B^T, that is the Schur complement of
/// [K, B; B^T, -M / k].
struct VolumetricCoupling {
    /// n_components * dof + component by functions of the projection.
    SparseMatrix B;
    /// Mass matrix over the modulus.
    SparseMatrix compliance;
};

/// A hyperelastic body in total Lagrangian form: its forces and its tangent at a displacement,
/// from the deformation that it keeps at the quadrature points of the assembly.
///
/// On a deformed reference the equations are pulled back: with F = F_f F_b and J_b = det F_b,
/// energy W(F) / J_b, stress P(F) F_b^T / J_b. Where the volumetric part is projected, W = W_0 +
/// k/2 g^2 (see `Dilatation`) becomes W_0 + p g - p^2 / (2 k) with p = k times the projection of g:
/// symmetric, and for degree 1 the mean dilatation of B-bar.
///
/// Source: [Elguedj08], [SimoTaylorPister85]. Differs: [Elguedj08] scales F (F-bar), which has no
/// energy and no symmetric tangent; here the energy itself is projected.
template <int d>
class FiniteStrain {
  public:
    /// @param problem  must outlive this
    /// @param n_gauss_points  per direction and element; nothing: degree + 1
    /// @throws InputError  if a patch has no hyperelastic material, or for plane stress
    /// @throws GeometryError  if det F_b is not positive at a quadrature point: patch, place, value
    FiniteStrain(ReferencePtr<d> reference, const Problem& problem,
                 std::optional<int> n_gauss_points = {},
                 Volumetric volumetric = Volumetric::automatic);
    ~FiniteStrain();

    /// Moves the body. With det F <= 0 anywhere the other functions have no meaning.
    ///
    /// @param displacement  total, n_dofs x d
    SmallestVolume<d> deform(const MatrixX& displacement);

    /// Work of the stress on each function: n_dofs x d.
    [[nodiscard]] MatrixX internal_forces() const;
    /// Derivative of the internal forces, into a matrix made by `make_pattern`; without the
    /// `coupling`.
    void tangent(BlockMatrix& matrix) const;
    /// The tangent as a form, without what projections add: reads the deformation whenever it is
    /// asked. This must outlive it.
    [[nodiscard]] BilinearForm<d> tangent_form() const;
    /// A patch's volumetric part is projected.
    [[nodiscard]] bool is_projected() const { return projection_.has_value(); }
    /// Of the patches whose projection reaches beyond elements; nothing if there are none.
    [[nodiscard]] std::optional<VolumetricCoupling> coupling() const;
    /// Integral of the stored energy.
    [[nodiscard]] double energy() const;

    /// F - I, F from the undeformed body, at a quadrature point of a plane of a patch.
    [[nodiscard]] Matrix<3> displacement_gradient(int patch, int i_plane, int i_point) const;
    /// First Piola stress by the undeformed body there, with the projected pressure.
    [[nodiscard]] Matrix<3> piola(int patch, int i_plane, int i_point) const;
    /// The same at a parameter of a patch. @param H  F - I there
    [[nodiscard]] Matrix<3> piola_at(int patch, const Vector<d>& xi, const Matrix<3>& H) const;

  private:
    struct PatchState;
    [[nodiscard]] const Hyperelastic& material(int patch) const;
    void set_up_reference();
    void set_up_projection();
    void project_dilatation(int patch);
    void add_elementwise_stiffness(int patch, BlockMatrix& matrix) const;
    /// Derivative of g by the displacement at all points, as `VolumetricProjection::coupling` takes
    /// it.
    [[nodiscard]] Buffer<double> dilatation_operator(int patch) const;

    ReferencePtr<d> reference_;
    const Problem& problem_;
    std::optional<int> n_gauss_points_;
    std::vector<int> materials_;
    std::vector<char> is_projected_;
    std::optional<VolumetricProjection<d>> projection_;
    std::vector<PatchState> patches_;
};

/// F - I from the undeformed body at a parameter of a patch, (i, J).
///
/// @param displacement  total, n_dofs x d of the reference's space
template <int d>
[[nodiscard]] Matrix<3> total_displacement_gradient(const ReferenceConfiguration<d>& reference,
                                                    Kinematics kinematics,
                                                    const MatrixX& displacement, int patch,
                                                    const Vector<d>& xi);

}  // namespace couture::iga
