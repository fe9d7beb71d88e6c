#pragma once

#include <functional>
#include <map>

#include "iga/core/timer.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/mechanics/problem.h"
#include "iga/topology/field.h"

namespace couture::iga {

struct LinearStaticOptions {
    SolverOptions solver;
    /// Gauss points per direction and element; nothing: degree + 1 of the space.
    std::optional<int> n_gauss_points;
    /// Solves instead of a new one: what it knows of the matrix' pattern serves again where that is
    /// the same. Must outlive the call; null: a new one.
    LinearSolver* reused_solver = nullptr;
};

/// One load case or combination.
template <int d>
struct CaseResult {
    std::string name;
    /// n_dofs x components.
    Field<d> displacement;
    /// Half the integral of stress : elastic strain.
    double energy = 0.0;
    /// Sum of external forces (loads) and of reactions of each support set, 3 components.
    Vector3 applied_force = Vector3::Zero();
    std::map<std::string, Vector3> reactions;
    /// |applied + reactions + foundation| over the largest of them.
    double balance = 0.0;
    /// Force of the foundations on the body.
    Vector3 foundation_force = Vector3::Zero();
};

template <int d>
struct LinearStaticResult {
    std::vector<CaseResult<d>> cases;
    SolveReport solver;
    std::vector<Phase> phases;
    int n_unknowns = 0;
    int n_elements = 0;
};

/// Appends the combinations of load cases, their energies by `energy`.
///
/// @throws InputError  for a load case that there is not
template <int d>
void add_combinations(std::vector<CaseResult<d>>& cases, const Problem& problem,
                      const std::function<double(const CaseResult<d>&)>& energy);

/// |applied + reactions + foundations| over the largest of them and of `load_norm`.
[[nodiscard]] double force_balance(const Problem& problem, const Vector3& applied,
                                   const std::map<std::string, Vector3>& reactions,
                                   const Vector3& foundations, double load_norm);

/// Solves the linear problem on a space, all load cases with one factorization, then the
/// combinations.
///
/// @throws InputError     for a load or a support that can't hold (names it), if rigid-body motions
///                        are free (names them)
/// @throws TopologyError  for a set that does not exist
/// @throws GeometryError  if a quadrature point sees det J change sign: patch, place, value
/// @throws SolverError    if the solver fails
template <int d>
[[nodiscard]] LinearStaticResult<d> solve_linear_static(const SpacePtr<d>& space,
                                                        const Problem& problem,
                                                        const LinearStaticOptions& options = {});

}  // namespace couture::iga
