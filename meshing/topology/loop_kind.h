#pragma once

#include <vector>

#include "meshing/topology/integer_lattice.h"

namespace couture::meshing {

/// Handles bound inside the solid, tunnels outside.
enum class LoopKind { handle, tunnel };

/// Whether a homology class x is of a kind: xA = 0 for handles, xA = x for tunnels; 0 is of both.
///
/// @param projector  A, see linking_projector
[[nodiscard]] bool is_of_kind(const std::vector<int>& homology_class,
                              const IntegerMatrix& projector, LoopKind kind);

/// Basis of the classes of a kind, as rows.
[[nodiscard]] IntegerMatrix classes_of_kind(const IntegerMatrix& projector, LoopKind kind);

}  // namespace couture::meshing
