#pragma once

#include <map>
#include <optional>
#include <string>

#include "iga/mechanics/problem.h"
#include "iga/solve/linear_static.h"
#include "iga/solve/load_stepping.h"
#include "iga/topology/multipatch.h"
#include "iga/topology/space.h"

namespace couture::verification {

/// A part of `meshing/parts` of known dimension.
template <int d>
[[nodiscard]] iga::MultiPatch<d> part(const std::string& name,
                                      const std::map<std::string, double>& parameters = {});

/// Puts all outer sides into the set "outer".
template <int d>
void name_outer(iga::MultiPatch<d>& geometry);

/// Splines of one degree with at least `n_elements` per patch and direction, as smooth as degree
/// and geometry allow. The degree may be below the geometry's.
template <int d>
[[nodiscard]] iga::SpacePtr<d> make_space(const iga::MultiPatch<d>& geometry, int degree,
                                          const std::array<int, d>& n_elements);
template <int d>
[[nodiscard]] iga::SpacePtr<d> make_space(const iga::MultiPatch<d>& geometry, int degree,
                                          int n_elements);

/// The only load case of a problem.
template <int d>
[[nodiscard]] iga::CaseResult<d> solve(const iga::SpacePtr<d>& space, const iga::Problem& problem,
                                       std::optional<int> n_gauss_points = {});

/// A plane or solid body of `StoredEnergy::neo_hookean`, without supports and loads.
[[nodiscard]] iga::Problem neo_hookean_problem(iga::Kinematics kinematics, double shear_modulus,
                                               double bulk_modulus);
/// The last state of a stepped run from the undeformed body.
///
/// @throws SolverError  if it does not reach its end
template <int d>
[[nodiscard]] iga::AcceptedStep<d> run_to_end(const iga::SpacePtr<d>& space,
                                              const iga::Problem& problem,
                                              const iga::SteppingOptions& options = {});

/// Displacement at a point of the body. @throws GeometryError  if the point is outside
template <int d>
[[nodiscard]] VectorX displacement_at(const iga::Field<d>& u, const Vector3& point);
/// Stress (Voigt) at a point of the body; the first patch that has it where several do.
template <int d>
[[nodiscard]] Vector<6> stress_at(const iga::Problem& problem, const iga::Field<d>& u,
                                  const Vector3& point);

/// Largest | f(x) | over a grid of points of a set of sides: how far the geometry is from the
/// surface f = 0.
template <int d>
[[nodiscard]] double geometry_error(const iga::MultiPatch<d>& geometry, const std::string& set,
                                    const std::function<double(const Vector3&)>& f);

}  // namespace couture::verification
