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

/// `project_stress` on all ranks: rows of this rank's pieces.
///
/// @param on_pieces  the problem on the rank's pieces
template <int d>
[[nodiscard]] MatrixX project_stress(const Communicator& ranks, const DistributedSpace<d>& space,
                                     const Problem& on_pieces, const Field<d>& displacement,
                                     const std::string& load_case);

}  // namespace couture::iga
