#pragma once

#include <memory>

#include "iga/topology/space.h"

namespace couture::iga {

/// The shape that displacements are discretised on: the undeformed body, or the body as it was when
/// it was meshed again.
///
/// Displacements are always total ones, from the undeformed body: with U the unknown and U_b what
/// it was at the remeshing, F = F_f F_b with F_f = I + grad(U - U_b) on the new mesh.
///
/// Source: [Maquart19] Eq. (7.3).
template <int d>
struct ReferenceConfiguration {
    SpacePtr<d> space;
    /// U_b at the remeshing, n_dofs x d; empty for the undeformed body.
    MatrixX displacement;
    /// F_b - I, n_dofs x 9 coefficients on the space, entry (i, J) in column 3 i + J; empty for the
    /// undeformed body.
    MatrixX gradient;

    [[nodiscard]] bool is_undeformed() const { return displacement.size() == 0; }
    /// The undeformed body in the patches of this mesh: control points moved back by U_b. Supports
    /// and loads are taken there, so that places, areas and volumes are the undeformed ones.
    [[nodiscard]] SpacePtr<d> undeformed() const;
};

template <int d>
using ReferencePtr = std::shared_ptr<const ReferenceConfiguration<d>>;

/// The undeformed body as its own reference.
template <int d>
[[nodiscard]] ReferencePtr<d> make_reference(const SpacePtr<d>& space);

}  // namespace couture::iga
