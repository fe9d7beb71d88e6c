#include "iga/topology/patch_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace couture::iga {

template <int d>
int PatchEntity<d>::dimension() const {
    return static_cast<int>(std::count(position.begin(), position.end(), End::free));
}

template <int d>
int PatchEntity<d>::side() const {
    assert(is_side());
    for (int k = 0; k < d; ++k) {
        if (position[k] != End::free) {
            return 2 * k + (position[k] == End::high ? 1 : 0);
        }
    }
    return 0;
}

template <int d>
std::string PatchEntity<d>::name() const {
    std::string text = fmt::format("patch {} ", patch);
    text += is_side() ? "side" : dimension() == 0 ? "corner" : "edge";
    for (int k = 0; k < d; ++k) {
        if (position[k] != End::free) {
            text += fmt::format(" {}:{}", k, position[k] == End::low ? "low" : "high");
        }
    }
    return text;
}

template <int d>
PatchEntity<d> make_side(int patch, int side) {
    PatchEntity<d> entity;
    entity.patch = patch;
    entity.position[side_direction(side)] = side_is_high(side) ? End::high : End::low;
    return entity;
}

template <int d>
std::array<int, d - 1> tangential_directions(int side) {
    std::array<int, d - 1> directions{};
    for (int k = 0, i = 0; k < d; ++k) {
        if (k != side_direction(side)) {
            directions[i++] = k;
        }
    }
    return directions;
}

template <int d>
std::vector<PatchEntity<d>> entities_of_patch(int patch, int dimension) {
    int n_codes = 1;
    for (int k = 0; k < d; ++k) {
        n_codes *= 3;
    }
    std::vector<PatchEntity<d>> result;
    for (int code = 0; code < n_codes; ++code) {
        PatchEntity<d> entity;
        entity.patch = patch;
        int rest = code;
        for (int k = 0; k < d; ++k) {
            entity.position[k] = static_cast<End>(rest % 3 - 1);
            rest /= 3;
        }
        if (entity.dimension() == dimension) {
            result.push_back(entity);
        }
    }
    if (dimension == d - 1) {
        std::sort(result.begin(), result.end(),
                  [](const auto& a, const auto& b) { return a.side() < b.side(); });
    }
    return result;
}

template <int d>
std::vector<int> functions_on(const TensorSpace<d>& space, const std::array<End, d>& position) {
    const std::array<int, d> n = space.sizes();
    std::array<int, d> i{};
    for (int k = 0; k < d; ++k) {
        i[k] = position[k] == End::high ? n[k] - 1 : 0;
    }
    std::vector<int> result;
    while (true) {
        result.push_back(space.index(i));
        int k = 0;
        for (; k < d; ++k) {
            if (position[k] != End::free) {
                continue;
            }
            if (++i[k] < n[k]) {
                break;
            }
            i[k] = 0;
        }
        if (k == d) {
            return result;
        }
    }
}

template <int d>
SideMap<d> SideMap<d>::identity() {
    SideMap map;
    for (int i = 0; i < d - 1; ++i) {
        map.axis[i] = i;
    }
    return map;
}

template <int d>
SideMap<d> SideMap<d>::inverse() const {
    SideMap map;
    for (int i = 0; i < d - 1; ++i) {
        map.axis[axis[i]] = i;
        map.reversed[axis[i]] = reversed[i];
    }
    return map;
}

template <int d>
std::vector<SideMap<d>> all_side_maps() {
    std::vector<SideMap<d>> maps;
    const int n_permutations = d == 3 ? 2 : 1;
    for (int permutation = 0; permutation < n_permutations; ++permutation) {
        for (int flips = 0; flips < (1 << (d - 1)); ++flips) {
            SideMap<d> map = SideMap<d>::identity();
            if (permutation == 1) {
                std::reverse(map.axis.begin(), map.axis.end());
            }
            for (int i = 0; i < d - 1; ++i) {
                map.reversed[i] = ((flips >> i) & 1) != 0;
            }
            maps.push_back(map);
        }
    }
    return maps;
}

template <int d>
std::string to_string(const Interface<d>& interface) {
    return make_side<d>(interface.first_patch, interface.first_side).name() + " and " +
           make_side<d>(interface.second_patch, interface.second_side).name();
}

template <int d>
std::optional<int> nonconforming_direction(const TensorSpace<d>& first_space,
                                           const TensorSpace<d>& second_space,
                                           const Interface<d>& interface) {
    const std::array<int, d - 1> first = tangential_directions<d>(interface.first_side);
    const std::array<int, d - 1> second = tangential_directions<d>(interface.second_side);
    for (int i = 0; i < d - 1; ++i) {
        const KnotVector& here = first_space.knots[first[i]];
        const KnotVector& there = second_space.knots[second[interface.map.axis[i]]];
        const bool conforms = interface.map.reversed[i] ? here.conforms_to(there.reversed())
                                                        : here.conforms_to(there);
        if (!conforms) {
            return i;
        }
    }
    return std::nullopt;
}

template <int d>
std::vector<int> matching_functions(const TensorSpace<d>& second_space,
                                    const Interface<d>& interface) {
    const std::array<int, d> n = second_space.sizes();
    const int normal = side_direction(interface.second_side);
    const std::array<int, d - 1> tangents = tangential_directions<d>(interface.second_side);
    // Sizes in the order of the first side's tangential directions.
    std::array<int, d - 1> size{};
    int n_functions = 1;
    for (int i = 0; i < d - 1; ++i) {
        size[i] = n[tangents[interface.map.axis[i]]];
        n_functions *= size[i];
    }
    std::vector<int> result(n_functions);
    for (int j = 0; j < n_functions; ++j) {
        std::array<int, d> index{};
        index[normal] = side_is_high(interface.second_side) ? n[normal] - 1 : 0;
        int rest = j;
        for (int i = 0; i < d - 1; ++i) {
            const int here = rest % size[i];
            rest /= size[i];
            index[tangents[interface.map.axis[i]]] =
                interface.map.reversed[i] ? size[i] - 1 - here : here;
        }
        result[j] = second_space.index(index);
    }
    return result;
}

#define COUTURE_INSTANTIATE(d)                                                                   \
    template struct PatchEntity<d>;                                                              \
    template struct SideMap<d>;                                                                  \
    template PatchEntity<d> make_side(int, int);                                                 \
    template std::array<int, d - 1> tangential_directions<d>(int);                               \
    template std::vector<PatchEntity<d>> entities_of_patch(int, int);                            \
    template std::vector<int> functions_on<d>(const TensorSpace<d>&, const std::array<End, d>&); \
    template std::vector<SideMap<d>> all_side_maps();                                            \
    template std::string to_string(const Interface<d>&);                                         \
    template std::optional<int> nonconforming_direction(                                         \
        const TensorSpace<d>&, const TensorSpace<d>&, const Interface<d>&);                      \
    template std::vector<int> matching_functions(const TensorSpace<d>&, const Interface<d>&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
