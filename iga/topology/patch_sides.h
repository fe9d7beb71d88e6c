#pragma once

#include <array>
#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "iga/spline/tensor_space.h"

namespace couture::iga {

/// Where an entity of the parameter box lies in one direction.
enum class End : signed char { low = -1, free = 0, high = 1 };

/// A side (one direction fixed), an edge (two) or a corner (three) of a patch; in two dimensions
/// a side fixes one direction and a corner two.
template <int d>
struct PatchEntity {
    int patch = 0;
    std::array<End, d> position{};

    /// Number of free directions.
    [[nodiscard]] int dimension() const;
    [[nodiscard]] bool is_side() const { return dimension() == d - 1; }
    /// Number of the side, 2 * direction + (0 low, 1 high). Only for sides.
    [[nodiscard]] int side() const;
    /// "patch 3 side 0:low" or "patch 3 edge 0:low 2:high".
    [[nodiscard]] std::string name() const;
    auto operator<=>(const PatchEntity&) const = default;
};

template <int d>
[[nodiscard]] PatchEntity<d> make_side(int patch, int side);

constexpr int side_direction(int side) { return side / 2; }
constexpr bool side_is_high(int side) { return side % 2 == 1; }
template <int d>
constexpr int n_sides = 2 * d;

/// Directions other than the side's own, ascending.
template <int d>
[[nodiscard]] std::array<int, d - 1> tangential_directions(int side);

/// All entities of a patch with `dimension` free directions: 2 d sides for dimension d - 1, ...
template <int d>
[[nodiscard]] std::vector<PatchEntity<d>> entities_of_patch(int patch, int dimension);

/// Function numbers (patch-local) of the control points on the entity: first free direction
/// fastest.
template <int d>
[[nodiscard]] std::vector<int> functions_on(const TensorSpace<d>& space,
                                            const std::array<End, d>& position);

/// How the tangential directions of one side run on the other. Tangential directions are those
/// other than the side's own, ascending.
template <int d>
struct SideMap {
    /// Tangential direction i of the first side is tangential direction axis[i] of the second ...
    std::array<int, d - 1> axis{};
    /// ... read backwards if reversed[i].
    std::array<bool, d - 1> reversed{};

    [[nodiscard]] static SideMap identity();
    [[nodiscard]] SideMap inverse() const;
    bool operator==(const SideMap&) const = default;
};

/// All 8 maps of a volume's side (2 for d = 2).
template <int d>
[[nodiscard]] std::vector<SideMap<d>> all_side_maps();

/// Two sides that are one place. A patch may meet itself.
template <int d>
struct Interface {
    int first_patch = 0;
    int first_side = 0;
    int second_patch = 0;
    int second_side = 0;
    SideMap<d> map = SideMap<d>::identity();
    bool operator==(const Interface&) const = default;
};

/// "patch 0 side 0:high and patch 1 side 2:low".
template <int d>
[[nodiscard]] std::string to_string(const Interface<d>& interface);

/// Tangential direction of the first side (from 0 to d - 2) in which the two spaces differ in
/// degree or knots, up to an affine change and the interface's orientation; nothing if they
/// conform.
template <int d>
[[nodiscard]] std::optional<int> nonconforming_direction(const TensorSpace<d>& first_space,
                                                         const TensorSpace<d>& second_space,
                                                         const Interface<d>& interface);

/// Function numbers on the second side in the order of the first side's own: entry k is the
/// function of the second patch that coincides with functions_on(first side)[k].
template <int d>
[[nodiscard]] std::vector<int> matching_functions(const TensorSpace<d>& second_space,
                                                  const Interface<d>& interface);

}  // namespace couture::iga
