#pragma once

#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// Conjugate gradients with smoothed-aggregation multigrid (PETSc's CG and GAMG), the near null
/// space given to the latter; GMRES for matrices that are not stored as symmetric. Fixed unknowns
/// stay as identity rows, so that blocks stay whole. SolverOptions::petsc_options overrides any of
/// this. PETSc is initialised at the first use and finalised at exit; it neither catches signals
/// nor reads the command line.
[[nodiscard]] std::unique_ptr<LinearSolver> make_petsc_solver(const SolverOptions& options);

}  // namespace couture::iga
