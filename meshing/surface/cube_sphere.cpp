#include "meshing/surface/cube_sphere.h"

#include <cmath>
#include <map>
#include <numbers>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

/// A node of the grid on the cube [0, n]^3.
using Node = std::array<int, 3>;

}  // namespace

QuadMesh make_cube_sphere(int n) {
    constexpr int most = 1000;
    if (n < 1 || n > most) {
        throw InputError("make_cube_sphere: {} quads along an edge; there must be 1 to {}", n,
                         most);
    }
    QuadMesh sphere;
    std::map<Node, int> numbers;
    const auto number_of = [&](const Node& node) {
        const auto [found, is_new] = numbers.try_emplace(node, sphere.points.size());
        if (is_new) {
            Vector3 point;
            for (int axis = 0; axis < 3; ++axis) {
                point[axis] = std::tan(std::numbers::pi / 4.0 * (2.0 * node[axis] / n - 1.0));
            }
            sphere.points.push_back(point.normalized());
        }
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_high : {false, true}) {
            const auto node = [&](int u, int v) {
                Node result{};
                result[axis] = is_high ? n : 0;
                // Seen from outside u turns to v counter-clockwise.
                result[(axis + 1) % 3] = is_high ? u : v;
                result[(axis + 2) % 3] = is_high ? v : u;
                return number_of(result);
            };
            for (int v = 0; v < n; ++v) {
                for (int u = 0; u < n; ++u) {
                    sphere.quads.push_back(
                        {node(u, v), node(u + 1, v), node(u + 1, v + 1), node(u, v + 1)});
                }
            }
        }
    }
    return sphere;
}

}  // namespace couture::meshing
