#include "io/mfem_topology.h"

#include <algorithm>
#include <map>

#include "iga/core/error.h"

namespace couture::io {

template <int d>
std::vector<PatchEdge> patch_edges() {
    std::vector<PatchEdge> result;
    for (int k = 0; k < d; ++k) {
        for (int corner = 0; corner < (1 << d); ++corner) {
            if ((corner >> k & 1) == 0) {
                result.push_back({k, corner, corner | (1 << k)});
            }
        }
    }
    return result;
}

template <int d>
std::vector<int> side_corners(int side) {
    std::vector<int> result;
    for (int corner = 0; corner < (1 << d); ++corner) {
        if ((corner >> iga::side_direction(side) & 1) == (iga::side_is_high(side) ? 1 : 0)) {
            result.push_back(corner);
        }
    }
    return result;
}

template <int d>
std::vector<int> mfem_side_corners(int side) {
    constexpr std::array<std::array<int, 2>, 4> squares = {{{3, 0}, {1, 2}, {0, 1}, {2, 3}}};
    constexpr std::array<std::array<int, 4>, 6> cubes = {
        {{3, 0, 4, 7}, {1, 2, 6, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {3, 2, 1, 0}, {4, 5, 6, 7}}};
    std::vector<int> result;
    const auto append = [&](const auto& numbers) {
        for (const int i : numbers) {
            result.push_back(mfem_corner_bits<d>[i]);
        }
    };
    if constexpr (d == 2) {
        append(squares[side]);
    } else {
        append(cubes[side]);
    }
    return result;
}

namespace {

/// How the vertices of one side lie on the other.
template <int d>
iga::SideMap<d> side_map(const std::vector<int>& first, const std::vector<int>& second,
                         const std::string& names) {
    const auto place = [&](int vertex) {
        return static_cast<int>(std::find(second.begin(), second.end(), vertex) - second.begin());
    };
    iga::SideMap<d> map = iga::SideMap<d>::identity();
    const int origin = place(first[0]);
    for (int i = 0; i < d - 1; ++i) {
        const int step = place(first[std::size_t{1} << i]) ^ origin;
        if (step != 1 && step != 2) {
            throw TopologyError(
                "{} have the same vertices in another cyclic order; expected the same", names);
        }
        map.axis[i] = step - 1;
        map.reversed[i] = (origin & step) != 0;
    }
    return map;
}

}  // namespace

template <int d>
std::vector<iga::Interface<d>> interfaces_of_vertices(
    const std::vector<CornerVertices<d>>& elements) {
    struct Side {
        iga::PatchEntity<d> entity;
        std::vector<int> vertices;
        bool is_matched = false;
    };
    std::map<std::vector<int>, Side> open;
    std::vector<iga::Interface<d>> result;
    for (std::size_t element = 0; element < elements.size(); ++element) {
        for (int side = 0; side < iga::n_sides<d>; ++side) {
            Side here{iga::make_side<d>(static_cast<int>(element), side), {}};
            for (const int corner : side_corners<d>(side)) {
                here.vertices.push_back(elements[element][corner]);
            }
            std::vector<int> key = here.vertices;
            std::sort(key.begin(), key.end());
            const auto [place, is_new] = open.emplace(std::move(key), here);
            if (is_new) {
                continue;
            }
            Side& other = place->second;
            const std::string names =
                fmt::format("{} and {}", other.entity.name(), here.entity.name());
            if (other.is_matched) {
                throw TopologyError("{} and another side have the same vertices; expected two",
                                    names);
            }
            other.is_matched = true;
            result.push_back({other.entity.patch, other.entity.side(), here.entity.patch, side,
                              side_map<d>(other.vertices, here.vertices, names)});
        }
    }
    return result;
}

#define COUTURE_INSTANTIATE(d)                                         \
    template std::vector<PatchEdge> patch_edges<d>();                  \
    template std::vector<int> side_corners<d>(int);                    \
    template std::vector<int> mfem_side_corners<d>(int);               \
    template std::vector<iga::Interface<d>> interfaces_of_vertices<d>( \
        const std::vector<CornerVertices<d>>&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::io
