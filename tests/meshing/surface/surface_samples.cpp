#include "tests/meshing/surface/surface_samples.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace couture::meshing {

namespace {

// Adds the two triangles of quads with corners counter-clockwise.
void add_quad(TriangleSoup& soup, int a, int b, int c, int d) {
    soup.triangles.push_back({a, b, c});
    soup.triangles.push_back({a, c, d});
}

// Faces of unit cubes that border on no other cube of the set, each divided n x n.
TriangleSoup make_voxel_surface(const std::vector<std::array<int, 3>>& cubes, int n) {
    std::map<std::array<int, 3>, bool> is_full;
    for (const auto& cube : cubes) is_full[cube] = true;
    TriangleSoup soup;
    std::map<std::array<int, 3>, int> number;
    const auto vertex = [&](const std::array<int, 3>& place) {
        const auto [entry, is_new] = number.try_emplace(place, static_cast<int>(number.size()));
        if (is_new) {
            soup.points.emplace_back(static_cast<double>(place[0]) / n,
                                     static_cast<double>(place[1]) / n,
                                     static_cast<double>(place[2]) / n);
        }
        return entry->second;
    };
    for (const auto& cube : cubes) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                auto neighbour = cube;
                neighbour[axis] += side == 1 ? 1 : -1;
                if (is_full.contains(neighbour)) continue;
                const int u = (axis + 1) % 3;
                const int v = (axis + 2) % 3;
                const auto at = [&](int i, int j) {
                    std::array<int, 3> place{n * cube[0], n * cube[1], n * cube[2]};
                    place[axis] += n * side;
                    place[u] += i;
                    place[v] += j;
                    return vertex(place);
                };
                for (int i = 0; i < n; ++i) {
                    for (int j = 0; j < n; ++j) {
                        if (side == 1) {
                            add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                        } else {
                            add_quad(soup, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
                        }
                    }
                }
            }
        }
    }
    return soup;
}

}  // namespace

TriangleSoup make_tetrahedron() {
    const double s = 1.0 / std::sqrt(8.0);
    return {.points = {s * Vector3(1, 1, 1), s * Vector3(1, -1, -1), s * Vector3(-1, 1, -1),
                       s * Vector3(-1, -1, 1)},
            .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

TriangleSoup make_cube(int n) { return make_voxel_surface({{0, 0, 0}}, n); }

TriangleSoup make_square(int n) {
    TriangleSoup soup;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            soup.points.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0);
        }
    }
    const auto at = [&](int i, int j) { return (n + 1) * j + i; };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return soup;
}

TriangleSoup make_torus(int n_around, int n_tube, double radius, double tube_radius) {
    TriangleSoup soup;
    for (int i = 0; i < n_around; ++i) {
        const double around = 2.0 * std::numbers::pi * i / n_around;
        for (int j = 0; j < n_tube; ++j) {
            const double tube = 2.0 * std::numbers::pi * j / n_tube;
            const double r = radius + tube_radius * std::cos(tube);
            soup.points.emplace_back(r * std::cos(around), r * std::sin(around),
                                     tube_radius * std::sin(tube));
        }
    }
    const auto at = [&](int i, int j) { return n_tube * (i % n_around) + j % n_tube; };
    for (int i = 0; i < n_around; ++i) {
        for (int j = 0; j < n_tube; ++j) {
            add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return soup;
}

TriangleSoup make_tube(int n_around, int n_along, double radius, double length) {
    TriangleSoup soup;
    for (int i = 0; i <= n_along; ++i) {
        for (int j = 0; j < n_around; ++j) {
            const double angle = 2.0 * std::numbers::pi * j / n_around;
            soup.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                     length * i / n_along);
        }
    }
    const auto at = [&](int i, int j) { return n_around * i + j % n_around; };
    for (int i = 0; i < n_along; ++i) {
        for (int j = 0; j < n_around; ++j) {
            add_quad(soup, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
        }
    }
    return soup;
}

TriangleSoup make_plate_with_holes(int genus, int n) {
    std::vector<std::array<int, 3>> cubes;
    for (int i = 0; i <= 2 * genus; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (i % 2 == 0 || j != 1) cubes.push_back({i, j, 0});
        }
    }
    return make_voxel_surface(cubes, n);
}

TriangleSoup join(const TriangleSoup& a, const TriangleSoup& b) {
    TriangleSoup soup = a;
    const int n = static_cast<int>(a.points.size());
    soup.points.insert(soup.points.end(), b.points.begin(), b.points.end());
    for (const auto& [i, j, k] : b.triangles) soup.triangles.push_back({i + n, j + n, k + n});
    return soup;
}

}  // namespace couture::meshing
