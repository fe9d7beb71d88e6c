#pragma once

#include <vector>

#include "meshing/field/dual_cycles.h"
#include "meshing/field/field_topology.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Connection angles x_ij: how far a field turns counter-clockwise against parallel transport from
/// face i to face j; x_ji = -x_ij.
class Connection {
  public:
    /// @param angles  for each edge from the face on the left of its halfedge 0 to that on its
    /// right,
    ///                in radians
    explicit Connection(std::vector<double> angles) : angles_(std::move(angles)) {}

    /// From the face on the left of a halfedge to that on its right.
    [[nodiscard]] double operator()(const SurfaceMesh& mesh, HalfedgeHandle h) const {
        const EdgeHandle edge = mesh.edge_handle(h);
        return mesh.halfedge_handle(edge, 0) == h ? angles_[edge.idx()] : -angles_[edge.idx()];
    }
    [[nodiscard]] const std::vector<double>& angles() const { return angles_; }

  private:
    std::vector<double> angles_;
};

/// How far a cycle turns to the left against a field: kappa - sum x, in radians. That of a field
/// that closes is a multiple of a full turn over its symmetry.
[[nodiscard]] double turns_against(const SurfaceMesh& mesh, const DualCycle& cycle,
                                   const Connection& connection);

/// The connection of a topology with the least sum of squares: sum x = kappa - (2 pi / n) turns
/// along each cycle, with n - index turns around a vertex. One equation of each component follows
/// from the others by the index formula, which is checked, and is left out:
/// x = A^T (A A^T)^-1 b, by a sparse Cholesky factorization.
///
/// @throws as check_topology; SolverError
///
/// Source: [CraneDesbrunSchroeder10], [Maquart19] Eq. (4.5), (4.12)
[[nodiscard]] Connection trivial_connection(const SurfaceMesh& mesh, const DualCycles& cycles,
                                            const FieldTopology& topology);

/// The topology with generator turns as they come with the least sum of squares when nothing is
/// asked of generators, rounded.
///
/// @throws as check_topology; SolverError
[[nodiscard]] FieldTopology with_smooth_generators(const SurfaceMesh& mesh,
                                                   const DualCycles& cycles,
                                                   FieldTopology topology);

}  // namespace couture::meshing
