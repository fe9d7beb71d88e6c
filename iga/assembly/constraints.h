#pragma once

#include <map>
#include <optional>

#include "iga/mechanics/problem.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// One held direction of one function.
template <int d>
struct HeldDirection {
    int dof = 0;
    Vector<d> direction = Vector<d>::Zero();
    /// Index into Problem::supports: who holds it (the first that asked).
    int support = 0;
    /// One prescribed coefficient per load case.
    VectorX values;
};

/// Supports turned into fixed unknowns. Functions held along slanted normals get a frame of their
/// own: u = frame^T u', and component k of u' is held.
template <int d>
struct Constraints {
    int n_components = d;
    /// n_components * dof + component (in the function's frame).
    std::vector<char> is_fixed;
    /// Prescribed coefficients, unknowns x load cases, zero where free.
    MatrixX values;
    /// Index into Problem::supports for fixed unknowns, -1 elsewhere.
    std::vector<int> support;
    /// Rows: axes of the frame; only functions whose frame is not the global one.
    std::map<int, Matrix<d>> frames;

    /// Coefficients (unknowns x n) from the frames to the global axes, and back.
    void to_global(MatrixX& unknowns) const;
    void to_frames(MatrixX& unknowns) const;
};

/// Prescribed functions are projected onto the set's functions in L2 (constants exactly).
///
/// @param load_cases  names; a support with another case is held at zero in it
/// @throws InputError  if two supports contradict each other, or a normal is asked on a curved set
/// @throws TopologyError  for a set that does not exist
template <int d>
[[nodiscard]] Constraints<d> make_constraints(const Space<d>& space, const Problem& problem,
                                              const std::vector<std::string>& load_cases);

/// Position of each function: its control point where the functions are the geometry's own, else
/// the image of its Greville point. n_dofs x 3.
template <int d>
[[nodiscard]] MatrixX dof_positions(const Space<d>& space);

/// Displacements of the functions under the body's rigid motions: unknowns x modes. 3D: three
/// translations and three rotations about the centre of the bounding box; plane: 2 + 1;
/// axisymmetric: 1; Poisson: the constant. `names` gets one per column.
///
/// @param centre  of the rotations; nothing: the middle of the bounding box
template <int d>
[[nodiscard]] MatrixX rigid_body_modes(const Space<d>& space, const Problem& problem,
                                       std::vector<std::string>& names,
                                       const std::optional<Vector3>& centre = {});

/// Names the rigid motions of every connected body that neither constraints nor foundations hold;
/// empty if all are held.
template <int d>
[[nodiscard]] std::vector<std::string> free_rigid_motions(const Space<d>& space,
                                                          const Problem& problem,
                                                          const Constraints<d>& constraints,
                                                          const SparseMatrix& foundations);

/// @throws InputError  if rigid-body motions are free: names them
template <int d>
void require_held(const Space<d>& space, const Problem& problem, const Constraints<d>& constraints,
                  const SparseMatrix& foundations);

}  // namespace couture::iga
