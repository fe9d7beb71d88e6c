#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Eight nodes (corner i at (i & 1, i >> 1 & 1, i >> 2 & 1), of either handedness) all of whose
/// sides are among some quads.
struct SixFaces {
    std::array<int, 8> nodes{};
    /// The quads on sides 0 to 5.
    std::array<int, 6> faces{};
};

/// All sets of six quads that bound a cuboid, each once, in the order of their smallest quad.
///
/// @param quads  nodes in cyclic order; no two with the same nodes
[[nodiscard]] std::vector<SixFaces> find_six_faces(std::span<const std::array<int, 4>> quads);

/// The mirrored cuboid: its first direction backwards.
[[nodiscard]] SixFaces mirrored(SixFaces cuboid);

}  // namespace couture::meshing
