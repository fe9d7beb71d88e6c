#include "iga/linalg/patch_structure.h"

#include <utility>

namespace couture::iga {

namespace {

/// A function inside a patch has one number there, one inside an interface two.
std::vector<Place> places_of(const PatchStructure& structure) {
    std::vector<int> n_copies(structure.n_dofs, 0);
    std::vector<int> n_meetings(structure.n_dofs, 0);
    for (const PatchFunctions& patch : structure.patches) {
        for (const int dof : patch.dofs) {
            ++n_copies[dof];
        }
    }
    std::vector<int> last_meeting(structure.n_dofs, -1);
    for (std::size_t m = 0; m < structure.meetings.size(); ++m) {
        const Meeting& meeting = structure.meetings[m];
        for (const int i : structure.functions_on_side(meeting.patch[0], meeting.side[0])) {
            const int dof = structure.patches[meeting.patch[0]].dofs[i];
            if (std::exchange(last_meeting[dof], static_cast<int>(m)) != static_cast<int>(m)) {
                ++n_meetings[dof];
            }
        }
    }
    std::vector<Place> places(structure.n_dofs, Place::wire);
    for (int i = 0; i < structure.n_dofs; ++i) {
        if (n_meetings[i] == 0 && n_copies[i] == 1) {
            places[i] = Place::interior;
        } else if (n_meetings[i] == 1 && n_copies[i] == 2) {
            places[i] = Place::face;
        }
    }
    return places;
}

}  // namespace

std::vector<int> PatchStructure::functions_on_side(int patch, int side) const {
    const PatchFunctions& functions = patches[patch];
    const int normal = side_direction(side);
    const auto [t0, t1] = other_directions(normal);
    std::array<int, 3> i{};
    i[normal] = side_is_high(side) ? functions.size(normal) - 1 : 0;
    std::vector<int> result;
    result.reserve(static_cast<std::size_t>(functions.size(t0)) * functions.size(t1));
    for (i[t1] = 0; i[t1] < functions.size(t1); ++i[t1]) {
        for (i[t0] = 0; i[t0] < functions.size(t0); ++i[t0]) {
            result.push_back(functions.index(i));
        }
    }
    return result;
}

template <int d>
PatchStructure make_patch_structure(const Space<d>& space) {
    PatchStructure result;
    result.n_dofs = space.n_dofs();
    result.n_sides = n_sides<d>;
    std::vector<std::pair<KnotVector, std::shared_ptr<const Univariate>>> known;
    const auto univariate = [&](const KnotVector& knots) {
        for (const auto& [other, functions] : known) {
            if (other == knots) {
                return functions;
            }
        }
        known.emplace_back(knots, std::make_shared<const Univariate>(make_univariate(knots)));
        return known.back().second;
    };
    const auto constant = std::make_shared<const Univariate>(make_constant());
    for (int p = 0; p < space.n_patches(); ++p) {
        PatchFunctions patch;
        patch.directions.fill(constant);
        for (int k = 0; k < d; ++k) {
            patch.directions[k] = univariate(space.tensor(p).knots[k]);
        }
        patch.dofs = space.dofs(p);
        result.patches.push_back(std::move(patch));
    }
    for (const Interface<d>& interface : space.geometry().interfaces) {
        Meeting meeting;
        meeting.patch = {interface.first_patch, interface.second_patch};
        meeting.side = {interface.first_side, interface.second_side};
        for (int k = 0; k + 1 < d; ++k) {
            meeting.axis[k] = interface.map.axis[k];
        }
        result.meetings.push_back(meeting);
    }
    result.places = places_of(result);
    return result;
}

template PatchStructure make_patch_structure(const Space<2>&);
template PatchStructure make_patch_structure(const Space<3>&);

}  // namespace couture::iga
