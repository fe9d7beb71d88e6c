#include "iga/topology/interface_match.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "iga/core/error.h"
#include "iga/topology/side_gap.h"

namespace couture::iga {

namespace {

/// Numbers points so that those within a tolerance of each other get the same number.
class PointNumbers {
  public:
    explicit PointNumbers(double tolerance) : tolerance_(tolerance), cell_(4.0 * tolerance) {}

    int number_of(const Vector3& x) {
        const Cell low = cell_of(x.array() - tolerance_);
        const Cell high = cell_of(x.array() + tolerance_);
        for (std::int64_t i = low[0]; i <= high[0]; ++i) {
            for (std::int64_t j = low[1]; j <= high[1]; ++j) {
                for (std::int64_t k = low[2]; k <= high[2]; ++k) {
                    const auto found = cells_.find({i, j, k});
                    if (found == cells_.end()) {
                        continue;
                    }
                    for (const int n : found->second) {
                        if ((points_[n] - x).norm() <= tolerance_) {
                            return n;
                        }
                    }
                }
            }
        }
        const int n = static_cast<int>(points_.size());
        points_.push_back(x);
        cells_[cell_of(x)].push_back(n);
        return n;
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    struct Hash {
        std::size_t operator()(const Cell& cell) const {
            std::uint64_t hash = 0;
            for (const std::int64_t c : cell) {
                hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL;
                hash ^= hash >> 32;
            }
            return hash;
        }
    };
    [[nodiscard]] Cell cell_of(const Vector3& x) const {
        Cell cell;
        for (int k = 0; k < 3; ++k) {
            cell[k] = static_cast<std::int64_t>(std::floor(x[k] / cell_));
        }
        return cell;
    }

    double tolerance_;
    double cell_;
    std::vector<Vector3> points_;
    std::unordered_map<Cell, std::vector<int>, Hash> cells_;
};

template <int d>
constexpr int n_side_corners = 1 << (d - 1);

/// A side that may be an interface, with the numbers of its corner points: bit i of a corner tells
/// whether tangential direction i is high.
template <int d>
struct Candidate {
    int patch;
    int side;
    std::array<int, n_side_corners<d>> corners;
};

/// Whether every line of the side's control points in some tangential direction is one point.
template <int d>
bool is_collapsed(const Patch<d>& patch, int side, double tolerance) {
    const std::vector<int> functions =
        functions_on<d>(patch.space(), make_side<d>(0, side).position);
    for (const int k : tangential_directions<d>(side)) {
        const bool collapses = std::all_of(functions.begin(), functions.end(), [&](int function) {
            std::array<int, d> i = patch.space().indices(function);
            i[k] = 0;
            const int first = patch.space().index(i);
            return (patch.control_points().row(function) - patch.control_points().row(first))
                       .norm() <= tolerance;
        });
        if (collapses) {
            return true;
        }
    }
    return false;
}

template <int d>
std::vector<Candidate<d>> find_candidates(const MultiPatch<d>& multipatch, double tolerance) {
    PointNumbers numbers(tolerance);
    std::vector<Candidate<d>> candidates;
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        const Patch<d>& patch = multipatch.patches[p];
        std::array<int, 2 * n_side_corners<d>> patch_corners;
        for (int corner = 0; corner < 2 * n_side_corners<d>; ++corner) {
            std::array<int, d> i = patch.space().sizes();
            for (int k = 0; k < d; ++k) {
                i[k] = ((corner >> k) & 1) != 0 ? i[k] - 1 : 0;
            }
            Vector3 x = Vector3::Zero();
            x.head(patch.dimension()) = patch.control_points().row(patch.space().index(i));
            patch_corners[corner] = numbers.number_of(x);
        }
        for (int side = 0; side < n_sides<d>; ++side) {
            if (is_collapsed(patch, side, tolerance)) {
                continue;
            }
            Candidate<d> candidate{p, side, {}};
            const std::array<int, d - 1> tangents = tangential_directions<d>(side);
            for (int c = 0; c < n_side_corners<d>; ++c) {
                int corner = side_is_high(side) ? 1 << side_direction(side) : 0;
                for (int i = 0; i < d - 1; ++i) {
                    corner |= ((c >> i) & 1) << tangents[i];
                }
                candidate.corners[c] = patch_corners[corner];
            }
            candidates.push_back(candidate);
        }
    }
    return candidates;
}

template <int d>
bool corners_agree(const Candidate<d>& first, const Candidate<d>& second, const SideMap<d>& map) {
    for (int c = 0; c < n_side_corners<d>; ++c) {
        int there = 0;
        for (int i = 0; i < d - 1; ++i) {
            const int bit = ((c >> i) & 1) ^ (map.reversed[i] ? 1 : 0);
            there |= bit << map.axis[i];
        }
        if (first.corners[c] != second.corners[there]) {
            return false;
        }
    }
    return true;
}

/// The orientation in which two sides are nearest to each other.
template <int d>
struct Match {
    Interface<d> interface;
    SideGap gap;
};

template <int d>
std::optional<Match<d>> best_match(const MultiPatch<d>& multipatch, const Candidate<d>& first,
                                   const Candidate<d>& second) {
    std::optional<Match<d>> best;
    for (const SideMap<d>& map : all_side_maps<d>()) {
        if (!corners_agree(first, second, map)) {
            continue;
        }
        const Interface<d> interface { first.patch, first.side, second.patch, second.side, map };
        const SideGap gap =
            side_gap(multipatch.patches[first.patch], multipatch.patches[second.patch], interface);
        if (!best ||
            std::pair(gap.distance, gap.weight) < std::pair(best->gap.distance, best->gap.weight)) {
            best = Match<d>{interface, gap};
        }
    }
    return best;
}

/// Diagonal of the box around the side's control points.
template <int d>
double side_extent(const Patch<d>& patch, int side) {
    const std::vector<int> functions =
        functions_on<d>(patch.space(), make_side<d>(0, side).position);
    Eigen::RowVectorXd low = patch.control_points().row(functions.front());
    Eigen::RowVectorXd high = low;
    for (const int i : functions) {
        low = low.cwiseMin(patch.control_points().row(i));
        high = high.cwiseMax(patch.control_points().row(i));
    }
    return (high - low).norm();
}

/// Which side each side meets, patch * n_sides + side.
template <int d>
class Partners {
  public:
    explicit Partners(const MultiPatch<d>& multipatch)
        : partner_(multipatch.patches.size() * n_sides<d>) {
        for (const Interface<d>& interface : multipatch.interfaces) {
            join(interface);
        }
    }
    [[nodiscard]] const std::optional<PatchEntity<d>>& of(int patch, int side) const {
        return partner_[patch * n_sides<d> + side];
    }
    /// @throws TopologyError  if one of the sides already has another partner
    void join(const Interface<d>& interface) {
        set(interface.first_patch, interface.first_side, interface.second_patch,
            interface.second_side);
        set(interface.second_patch, interface.second_side, interface.first_patch,
            interface.first_side);
    }

  private:
    void set(int patch, int side, int other_patch, int other_side) {
        std::optional<PatchEntity<d>>& partner = partner_[patch * n_sides<d> + side];
        const PatchEntity<d> other = make_side<d>(other_patch, other_side);
        if (partner) {
            throw TopologyError(
                "find_interfaces: {}, {} and {} coincide; at most two sides may meet, remove a "
                "patch that lies on another",
                make_side<d>(patch, side).name(), partner->name(), other.name());
        }
        partner = other;
    }

    std::vector<std::optional<PatchEntity<d>>> partner_;
};

template <int d>
std::string warning(const Match<d>& match, double max_distance, double size) {
    if (match.gap.distance <= max_distance) {
        return fmt::format(
            "find_interfaces: {} have the same control points but their weights differ by {:.3g}; "
            "they are not joined",
            to_string(match.interface), match.gap.weight);
    }
    return fmt::format(
        "find_interfaces: {} have the same corners but their shapes or parametrisations differ: "
        "largest gap {:.3g} ({:.2g} of the size); they are not joined",
        to_string(match.interface), match.gap.distance, match.gap.distance / size);
}

/// A patch all of whose sides meet one other patch lies on it: bodies have no such neighbours
/// (closed surfaces in space may).
template <int d>
void refuse_repeated_patches(const MultiPatch<d>& multipatch, const Partners<d>& partners) {
    for (int p = 0; p < multipatch.n_patches() && multipatch.dimension() == d; ++p) {
        const std::optional<PatchEntity<d>>& first = partners.of(p, 0);
        bool lies_on_other = first && first->patch != p;
        for (int side = 1; side < n_sides<d> && lies_on_other; ++side) {
            const std::optional<PatchEntity<d>>& other = partners.of(p, side);
            lies_on_other = other && other->patch == first->patch;
        }
        if (lies_on_other) {
            throw TopologyError(
                "find_interfaces: all sides of patch {} coincide with those of patch {}: one lies "
                "on "
                "the other; remove it",
                p, first->patch);
        }
    }
}

}  // namespace

template <int d>
std::vector<std::string> find_interfaces(MultiPatch<d>& multipatch, double tolerance) {
    if (!(tolerance > 0.0)) {
        throw InputError("find_interfaces: tolerance = {}; must be positive", tolerance);
    }
    const double size = multipatch.size();
    if (!(size > 0.0)) {
        return {};
    }
    const double max_distance = tolerance * size;
    Partners<d> partners(multipatch);

    // Sides with the same corners, whatever their order.
    std::map<std::array<int, n_side_corners<d>>, std::vector<Candidate<d>>> groups;
    for (const Candidate<d>& candidate : find_candidates(multipatch, max_distance)) {
        auto key = candidate.corners;
        std::sort(key.begin(), key.end());
        groups[key].push_back(candidate);
    }
    std::vector<Interface<d>> found;
    std::vector<Match<d>> near;
    for (const auto& [key, group] : groups) {
        for (std::size_t i = 0; i < group.size(); ++i) {
            for (std::size_t j = i + 1; j < group.size(); ++j) {
                const std::optional<PatchEntity<d>>& partner =
                    partners.of(group[i].patch, group[i].side);
                if (partner == make_side<d>(group[j].patch, group[j].side)) {
                    continue;
                }
                const std::optional<Match<d>> match = best_match(multipatch, group[i], group[j]);
                if (!match) {
                    continue;
                }
                if (match->gap.distance <= max_distance && match->gap.weight <= tolerance) {
                    partners.join(match->interface);
                    found.push_back(match->interface);
                } else {
                    near.push_back(*match);
                }
            }
        }
    }
    refuse_repeated_patches(multipatch, partners);
    const auto order = [](const Interface<d>& a, const Interface<d>& b) {
        return std::pair(a.first_patch, a.first_side) < std::pair(b.first_patch, b.first_side);
    };
    std::sort(found.begin(), found.end(), order);
    std::sort(near.begin(), near.end(), [&](const Match<d>& a, const Match<d>& b) {
        return order(a.interface, b.interface);
    });
    std::vector<std::string> warnings;
    for (const Match<d>& match : near) {
        const Interface<d>& interface = match.interface;
        const double extent = std::min(
            side_extent(multipatch.patches[interface.first_patch], interface.first_side),
            side_extent(multipatch.patches[interface.second_patch], interface.second_side));
        if (!partners.of(interface.first_patch, interface.first_side) &&
            !partners.of(interface.second_patch, interface.second_side) &&
            match.gap.distance <= 0.5 * extent) {
            warnings.push_back(warning(match, max_distance, size));
        }
    }
    multipatch.interfaces.insert(multipatch.interfaces.end(), found.begin(), found.end());
    const bool conforms =
        std::all_of(found.begin(), found.end(), [&](const Interface<d>& interface) {
            return !nonconforming_direction(multipatch.patches[interface.first_patch].space(),
                                            multipatch.patches[interface.second_patch].space(),
                                            interface);
        });
    if (!conforms) {
        make_conforming(multipatch, tolerance);
    }
    return warnings;
}

template std::vector<std::string> find_interfaces(MultiPatch<2>&, double);
template std::vector<std::string> find_interfaces(MultiPatch<3>&, double);

}  // namespace couture::iga
