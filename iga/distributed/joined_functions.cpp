#include "iga/distributed/joined_functions.h"

#include <algorithm>

namespace couture::iga {

template <int d>
JoinedFunctions<d>::JoinedFunctions(const MultiPatch<d>& geometry,
                                    std::vector<TensorSpace<d>> spaces)
    : spaces_(std::move(spaces)),
      interfaces_(spaces_.size() * n_sides<d>),
      collapsed_(spaces_.size()) {
    for (const Interface<d>& interface : geometry.interfaces) {
        interfaces_[interface.first_patch * n_sides<d> + interface.first_side].push_back(interface);
        interfaces_[interface.second_patch * n_sides<d> + interface.second_side].push_back(
            {interface.second_patch, interface.second_side, interface.first_patch,
             interface.first_side, interface.map.inverse()});
    }
    for (const CollapsedEntity<d>& collapsed : collapsed_entities(geometry)) {
        collapsed_[collapsed.entity.patch].push_back(collapsed);
    }
}

template <int d>
void JoinedFunctions<d>::collect_joined(const Place& place, std::vector<Place>& joined) const {
    const auto [patch, i] = place;
    const std::array<int, d> n = spaces_[patch].sizes();
    for (int side = 0; side < n_sides<d>; ++side) {
        const int normal = side_direction(side);
        if (i[normal] != (side_is_high(side) ? n[normal] - 1 : 0)) {
            continue;
        }
        for (const Interface<d>& interface : interfaces_[patch * n_sides<d> + side]) {
            const std::array<int, d - 1> here = tangential_directions<d>(side);
            const std::array<int, d - 1> there = tangential_directions<d>(interface.second_side);
            const int far_normal = side_direction(interface.second_side);
            Place other{interface.second_patch, {}};
            other.i[far_normal] = side_is_high(interface.second_side)
                                      ? spaces_[other.patch].knots[far_normal].n_basis() - 1
                                      : 0;
            for (int t = 0; t < d - 1; ++t) {
                const int at = i[here[t]];
                other.i[there[interface.map.axis[t]]] =
                    interface.map.reversed[t] ? n[here[t]] - 1 - at : at;
            }
            joined.push_back(other);
        }
    }
    for (const CollapsedEntity<d>& collapsed : collapsed_[patch]) {
        bool lies_on = true;
        for (int k = 0; k < d; ++k) {
            const End end = collapsed.entity.position[k];
            lies_on = lies_on && (end == End::free || i[k] == (end == End::high ? n[k] - 1 : 0));
        }
        for (const int direction : lies_on ? collapsed.directions : std::vector<int>{}) {
            Place other = place;
            for (other.i[direction] = 0; other.i[direction] < n[direction]; ++other.i[direction]) {
                joined.push_back(other);
            }
        }
    }
}

template <int d>
FunctionKey JoinedFunctions<d>::first(int patch, const std::array<int, d>& i) {
    const FunctionKey own = key(patch, i);
    const std::array<int, d> n = spaces_[patch].sizes();
    bool is_inside = true;
    for (int k = 0; k < d; ++k) {
        is_inside = is_inside && i[k] > 0 && i[k] < n[k] - 1;
    }
    if (is_inside) {
        return own;
    }
    if (const auto known = known_.find(own); known != known_.end()) {
        return known->second;
    }
    std::vector<Place> all{{patch, i}};
    std::vector<FunctionKey> keys{own};
    std::vector<Place> joined;
    for (std::size_t at = 0; at < all.size(); ++at) {
        joined.clear();
        collect_joined(all[at], joined);
        for (const Place& place : joined) {
            const FunctionKey other = key(place.patch, place.i);
            if (std::find(keys.begin(), keys.end(), other) == keys.end()) {
                all.push_back(place);
                keys.push_back(other);
            }
        }
    }
    const FunctionKey least = *std::min_element(keys.begin(), keys.end());
    for (const FunctionKey other : keys) {
        known_[other] = least;
    }
    return least;
}

template class JoinedFunctions<2>;
template class JoinedFunctions<3>;

}  // namespace couture::iga
