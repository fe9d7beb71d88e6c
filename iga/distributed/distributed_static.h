#pragma once

#include "iga/distributed/distributed_space.h"
#include "iga/solve/linear_static.h"

namespace couture::iga {

/// `solve_linear_static` on all ranks: displacements are those of this rank's pieces, numbers those
/// of the whole. "petsc" (and "auto") assembles rows, "matrix_free" does not.
///
/// @throws  as `solve_linear_static`, the same on all ranks; InputError for another solver
template <int d>
[[nodiscard]] LinearStaticResult<d> solve_linear_static(const Communicator& ranks,
                                                        RefinedGeometry<d>& geometry,
                                                        const DistributedSpace<d>& space,
                                                        const Problem& problem,
                                                        const LinearStaticOptions& options);

/// Fields of which the ranks have integrals times functions: coefficients of this rank's pieces by
/// L2 projection.
///
/// @param integrals  shares of this rank's elements, n_dofs x fields
template <int d>
[[nodiscard]] MatrixX project(const Communicator& ranks, const DistributedSpace<d>& space,
                              const MatrixX& integrals);

}  // namespace couture::iga
