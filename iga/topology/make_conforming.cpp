#include <algorithm>
#include <map>
#include <numeric>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/topology/interface_match.h"
#include "iga/topology/side_gap.h"
#include "iga/topology/snap_knots.h"

namespace couture::iga {

namespace {

/// Parametric directions of patches, numbered patch * d + direction, joined into sheets: those that
/// share a knot vector across interfaces, with the sense in which each reads it.
class Sheets {
  public:
    explicit Sheets(int n) : parent_(n), is_reversed_(n, false) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    struct Member {
        int sheet = 0;
        /// Against the sheet's own direction.
        bool is_reversed = false;
    };

    Member find(int i) {
        // Halving the path keeps the senses relative to the new parents.
        bool is_reversed = false;
        while (parent_[i] != i) {
            const int up = parent_[i];
            is_reversed_[i] = is_reversed_[i] != is_reversed_[up];
            parent_[i] = parent_[up];
            is_reversed = is_reversed != is_reversed_[i];
            i = parent_[i];
        }
        return {i, is_reversed};
    }
    void join(int i, int j, bool is_reversed) {
        const Member a = find(i);
        const Member b = find(j);
        if (a.sheet != b.sheet) {
            parent_[b.sheet] = a.sheet;
            is_reversed_[b.sheet] = is_reversed != (a.is_reversed != b.is_reversed);
        }
    }

  private:
    std::vector<int> parent_;
    std::vector<bool> is_reversed_;
};

KnotVector join(const KnotVector& a, const KnotVector& b) {
    return common_refinement(a, snap_knots(b, a));
}

KnotVector oriented(const KnotVector& knots, bool is_reversed) {
    return is_reversed ? knots.reversed() : knots;
}

/// Calls visit(first, second, reversed) for the directions, numbered as in Sheets, that each
/// interface joins.
template <int d, typename Visit>
void for_each_joined_direction(const std::vector<Interface<d>>& interfaces, Visit&& visit) {
    for (const Interface<d>& interface : interfaces) {
        const std::array<int, d - 1> here = tangential_directions<d>(interface.first_side);
        const std::array<int, d - 1> there = tangential_directions<d>(interface.second_side);
        for (int i = 0; i < d - 1; ++i) {
            visit(interface.first_patch * d + here[i],
                  interface.second_patch * d + there[interface.map.axis[i]],
                  static_cast<bool>(interface.map.reversed[i]));
        }
    }
}

}  // namespace

template <int d>
bool make_conforming(std::vector<TensorSpace<d>>& spaces,
                     const std::vector<Interface<d>>& interfaces) {
    const bool conforms =
        std::all_of(interfaces.begin(), interfaces.end(), [&](const Interface<d>& interface) {
            return !nonconforming_direction(spaces[interface.first_patch],
                                            spaces[interface.second_patch], interface);
        });
    if (conforms) {
        return false;
    }
    const int n_directions = static_cast<int>(spaces.size()) * d;
    Sheets sheets(n_directions);
    for_each_joined_direction<d>(interfaces, [&](int first, int second, bool is_reversed) {
        sheets.join(first, second, is_reversed);
    });
    // A sheet that meets itself backwards (a Moebius band) needs knots that read the same both
    // ways.
    std::vector<bool> is_two_way(n_directions, false);
    for_each_joined_direction<d>(interfaces, [&](int first, int second, bool is_reversed) {
        const Sheets::Member a = sheets.find(first);
        const Sheets::Member b = sheets.find(second);
        if ((a.is_reversed != b.is_reversed) != is_reversed) {
            is_two_way[a.sheet] = true;
        }
    });

    std::map<int, KnotVector> common;
    const auto own_knots = [&](int i) -> const KnotVector& { return spaces[i / d].knots[i % d]; };
    for (int i = 0; i < n_directions; ++i) {
        const Sheets::Member member = sheets.find(i);
        const KnotVector knots = oriented(own_knots(i).rescaled(0.0, 1.0), member.is_reversed);
        const auto [sheet, is_new] = common.emplace(member.sheet, knots);
        if (is_new && is_two_way[member.sheet] && !knots.conforms_to(knots.reversed())) {
            sheet->second = join(knots, knots.reversed());
        }
        if (!is_new && !sheet->second.conforms_to(knots)) {
            sheet->second = join(sheet->second, knots);
            if (is_two_way[member.sheet]) {
                sheet->second = join(sheet->second, sheet->second.reversed());
            }
        }
    }
    for (int i = 0; i < n_directions; ++i) {
        const Sheets::Member member = sheets.find(i);
        const KnotVector target = oriented(common.at(member.sheet), member.is_reversed);
        KnotVector& knots = spaces[i / d].knots[i % d];
        if (!knots.conforms_to(target)) {
            knots = snap_knots(target.rescaled(knots.front(), knots.back()), knots);
        }
    }
    return true;
}

template <int d>
void make_conforming(MultiPatch<d>& multipatch, double tolerance) {
    const double max_distance = tolerance * multipatch.size();
    for (const Interface<d>& interface : multipatch.interfaces) {
        const SideGap gap = side_gap(multipatch.patches[interface.first_patch],
                                     multipatch.patches[interface.second_patch], interface);
        if (gap.distance > max_distance || gap.weight > tolerance) {
            throw TopologyError(
                "make_conforming: {} are an interface but their shapes differ: largest gap {:.3g}, "
                "weights {:.3g}; allowed are {:.3g} and {:g}",
                to_string(interface), gap.distance, gap.weight, max_distance, tolerance);
        }
    }
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : multipatch.patches) {
        spaces.push_back(patch.space());
    }
    if (!make_conforming<d>(spaces, multipatch.interfaces)) {
        return;
    }
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        if (spaces[p] != multipatch.patches[p].space()) {
            multipatch.patches[p] = refine_to(multipatch.patches[p], spaces[p]);
        }
    }
}

template bool make_conforming(std::vector<TensorSpace<2>>&, const std::vector<Interface<2>>&);
template bool make_conforming(std::vector<TensorSpace<3>>&, const std::vector<Interface<3>>&);
template void make_conforming(MultiPatch<2>&, double);
template void make_conforming(MultiPatch<3>&, double);

}  // namespace couture::iga
