#pragma once

#include <array>
#include <memory>
#include <vector>

#include "iga/linalg/univariate.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Functions of a patch: three directions, the third of a surface constant.
struct PatchFunctions {
    std::array<std::shared_ptr<const Univariate>, 3> directions;
    /// Global number of each, first direction fastest.
    std::vector<int> dofs;

    [[nodiscard]] int size(int direction) const { return directions[direction]->size(); }
    [[nodiscard]] int index(const std::array<int, 3>& i) const {
        return i[0] + size(0) * (i[1] + size(1) * i[2]);
    }
};

/// The two directions other than `direction`, ascending.
constexpr std::array<int, 2> other_directions(int direction) {
    return {direction == 0 ? 1 : 0, direction == 2 ? 1 : 2};
}

/// Two sides of patches that are one place.
struct Meeting {
    std::array<int, 2> patch{};
    std::array<int, 2> side{};
    /// Tangential direction i of the first side is tangential direction axis[i] of the second.
    std::array<int, 2> axis{0, 1};
};

/// Where a function lies: in one patch, on one interface and no more, or on an edge or corner
/// where interfaces meet (or on a collapsed line).
enum class Place : char { interior, face, wire };

/// A space as substructuring sees it, the same for surfaces and volumes.
struct PatchStructure {
    int n_dofs = 0;
    /// 4 or 6.
    int n_sides = 0;
    std::vector<PatchFunctions> patches;
    std::vector<Meeting> meetings;
    /// Of each global function.
    std::vector<Place> places;

    /// Numbers of the patch's functions on a side, first tangential direction fastest.
    [[nodiscard]] std::vector<int> functions_on_side(int patch, int side) const;
};

template <int d>
[[nodiscard]] PatchStructure make_patch_structure(const Space<d>& space);

}  // namespace couture::iga
