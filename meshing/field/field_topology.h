#pragma once

#include <vector>

#include "meshing/field/dual_cycles.h"
#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/invariants.h"

namespace couture::meshing {

struct Singularity {
    /// Number of an inner vertex.
    int vertex = 0;
    /// Parts of a full turn (of the field's symmetry) that the field makes around it.
    int index = 0;
    auto operator<=>(const Singularity&) const = default;
};

/// What decides about an n-symmetric direction field up to smooth change. All numbers count n-th
/// parts of a full turn. Fields on one mesh are equivalent if and only if these are equal.
///
/// Source: [Maquart19] Def. 2.8, Eq. (2.17), Prop. 2.2
struct FieldTopology {
    /// 1, 2, 4 or 6: a vector, a line, a cross, a star.
    int symmetry = 4;
    /// By ascending vertices; indices are not 0.
    std::vector<Singularity> singularities;
    /// For each boundary cycle (DualCycles) how far it turns against the field, to the left; 0
    /// where the field keeps to the boundary.
    std::vector<int> boundary_turns;
    /// The same for each generator.
    std::vector<int> generator_turns;
    bool operator==(const FieldTopology&) const = default;
};

/// Turning number of a field along a cycle that turns against it: T = -turns / symmetry. Around a
/// vertex of index I (in full turns) it is I - 1.
///
/// Source: [Maquart19] Eq. (2.15), (2.16). Differs: the signs of Table 4.1, where T = -v / 4 at
/// nodes needs T = -(n_n - n_a) / 4 along cycles.
[[nodiscard]] double turning_number(int turns, int symmetry);

/// How many of the numbers of a topology can be chosen: 2 g + b + s - 1, or 2 g if there is neither
/// boundary nor singularity.
///
/// Source: [Maquart19] Prop. 2.2
[[nodiscard]] int topological_freedom(const SurfaceInvariants& surface, int n_singularities);

/// The index formula, for each component: sum of indices + sum of boundary turns = symmetry chi.
///
/// @throws InputError     if sizes don't fit the cycles, the symmetry is none of 1, 2, 4 and 6, or
/// a
///                        singularity is not at an inner vertex of its own
/// @throws TopologyError  if the formula is not satisfied; with the numbers
///
/// Source: [Maquart19] Eq. (2.7), Theorem 2.2
void check_topology(const SurfaceMesh& mesh, const DualCycles& cycles,
                    const FieldTopology& topology);

}  // namespace couture::meshing
