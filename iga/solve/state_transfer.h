#pragma once

#include "iga/assembly/reference_configuration.h"
#include "iga/mechanics/problem.h"

namespace couture::iga {

/// What is carried over to a new mesh.
enum class Transfer {
    /// The displacement alone: the new mesh is moved back by it and becomes one of the undeformed
    /// body, F = I + grad U there. What a hyperelastic body needs: nothing is lost but what the
    /// elements can't show.
    displacement,
    /// The displacement, and the deformation gradient at the quadrature points as a field of its
    /// own: F = F_f F_b on the deformed body as the reference. Also where the elements are so
    /// deformed that the new mesh, moved back, would fold; elements of low degree smooth F_b.
    gradient
};

/// A deformed body on a new mesh.
template <int d>
struct TransferredState {
    ReferencePtr<d> reference;
    /// Total displacement on the reference's space, n_dofs x d.
    MatrixX displacement;
    /// As asked for, or `gradient` where the new mesh folds when it is moved back.
    Transfer transfer = Transfer::displacement;
    /// |F_b - F| over |F - I| in L2, F that of the transferred displacement.
    double gradient_drift = 0.0;
    /// Smallest det F_b at the quadrature points.
    double min_det_F = 1.0;
    /// Farthest that a point of the new mesh lay outside the old one, a length.
    double largest_gap = 0.0;
};

struct TransferOptions {
    std::optional<int> n_gauss_points;
    Transfer transfer = Transfer::displacement;
    /// Largest accepted distance of a point of the new mesh to the old one, relative to the body's
    /// size: curved faces are met to the accuracy of their elements only.
    double tolerance = 0.02;
};

/// Carries displacement and deformation gradient to a new mesh of the deformed body. Displacement:
/// interpolated at the Greville points of the new functions, each found in the old mesh by point
/// inversion and evaluated there. Deformation gradient: evaluated likewise at the quadrature points
/// and projected onto the new functions in L2; with `Transfer::displacement` for comparison only.
/// Points outside the old mesh take the values of the nearest point.
///
/// @param displacement  total, n_dofs x d of the old reference
/// @param mesh  the deformed body; its own functions become the new ones
/// @throws GeometryError  if a point is too far outside (patch, place, distance), or if det F_b is
///                        not positive at a quadrature point
///
/// Source: [Maquart19] Sec. 7.1.2.3, for `Transfer::gradient`. Differs: there the deformation
/// gradient is always carried over; of a hyperelastic body it follows from the displacement.
template <int d>
[[nodiscard]] TransferredState<d> transfer_state(const ReferenceConfiguration<d>& old,
                                                 Kinematics kinematics, const MatrixX& displacement,
                                                 const MultiPatch<d>& mesh,
                                                 const TransferOptions& options = {});

/// The body that a displacement makes of a reference: its control points moved.
///
/// @throws InputError  if the field's functions are not those of the geometry
template <int d>
[[nodiscard]] MultiPatch<d> deformed_body(const ReferenceConfiguration<d>& reference,
                                          const MatrixX& displacement);

}  // namespace couture::iga
