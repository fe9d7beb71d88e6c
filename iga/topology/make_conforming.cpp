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
void for_each_joined_direction(const MultiPatch<d>& multipatch, Visit&& visit) {
    for (const Interface<d>& interface : multipatch.interfaces) {
        const std::array<int, d - 1> here = tangential_directions<d>(interface.first_side);
        const std::array<int, d - 1> there = tangential_directions<d>(interface.second_side);
        for (int i = 0; i < d - 1; ++i) {
            visit(interface.first_patch * d + here[i],
                  interface.second_patch * d + there[interface.map.axis[i]],
                  static_cast<bool>(interface.map.reversed[i]));
        }
    }
}

template <int d>
void refine_sheets(MultiPatch<d>& multipatch) {
    const int n_directions = multipatch.n_patches() * d;
    Sheets sheets(n_directions);
    for_each_joined_direction(multipatch, [&](int first, int second, bool is_reversed) {
        sheets.join(first, second, is_reversed);
    });
    // A sheet that meets itself backwards (a Moebius band) needs knots that read the same both
    // ways.
    std::vector<bool> is_two_way(n_directions, false);
    for_each_joined_direction(multipatch, [&](int first, int second, bool is_reversed) {
        const Sheets::Member a = sheets.find(first);
        const Sheets::Member b = sheets.find(second);
        if ((a.is_reversed != b.is_reversed) != is_reversed) {
            is_two_way[a.sheet] = true;
        }
    });

    std::map<int, KnotVector> common;
    const auto own_knots = [&](int i) -> const KnotVector& {
        return multipatch.patches[i / d].knots(i % d);
    };
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
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        TensorSpace<d> space = multipatch.patches[p].space();
        bool is_changed = false;
        for (int k = 0; k < d; ++k) {
            const Sheets::Member member = sheets.find(p * d + k);
            const KnotVector target = oriented(common.at(member.sheet), member.is_reversed);
            KnotVector& knots = space.knots[k];
            if (!knots.conforms_to(target)) {
                knots = snap_knots(target.rescaled(knots.front(), knots.back()), knots);
                is_changed = true;
            }
        }
        if (is_changed) {
            multipatch.patches[p] = refine_to(multipatch.patches[p], space);
        }
    }
}

}  // namespace

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
    refine_sheets(multipatch);
}

template void make_conforming(MultiPatch<2>&, double);
template void make_conforming(MultiPatch<3>&, double);

}  // namespace couture::iga
