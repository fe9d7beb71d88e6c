#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

namespace couture::meshing {

/// A disc of quads that closes a boundary loop of a layout: one side of a cut, or an outer face.
struct CapPattern {
    /// Nodes of its boundary, counter-clockwise seen from outside the volume that it bounds; the
    /// smallest first.
    std::vector<int> loop;
    /// Corners counter-clockwise seen from outside; all nodes that are not on the loop lie inside.
    std::vector<std::array<int, 4>> quads;
};

/// The pattern of the quads, with its loop.
///
/// @throws TopologyError  unless they form a disc
[[nodiscard]] CapPattern make_cap_pattern(std::vector<std::array<int, 4>> quads);

/// The nodes of `second` that the nodes of `first` come to lie on when the two are laid face to
/// face: loop node k of the first on loop node (rotation - k) modulo their number of the second.
/// Nothing if quads don't come to lie on quads.
///
/// @param rotation  in 0 .. size of the loops - 1
[[nodiscard]] std::optional<std::map<int, int>> match_caps(const CapPattern& first,
                                                           const CapPattern& second, int rotation);

/// All rotations at which the two match.
[[nodiscard]] std::vector<int> admissible_rotations(const CapPattern& first,
                                                    const CapPattern& second);

}  // namespace couture::meshing
