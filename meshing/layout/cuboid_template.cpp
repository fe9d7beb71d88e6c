#include "meshing/layout/cuboid_template.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "iga/core/nearest_name.h"
#include "meshing/layout/layout_validity.h"

namespace couture::meshing {

namespace {

void check_positions(const CuboidTemplate& shape) {
    if (static_cast<int>(shape.positions.size()) != shape.layout.n_nodes) {
        throw InputError("{} positions for {} nodes", shape.positions.size(), shape.layout.n_nodes);
    }
    for (int c = 0; c < shape.layout.n_cuboids(); ++c) {
        const auto& nodes = shape.layout.cuboids[c];
        for (int corner = 0; corner < 8; ++corner) {
            Matrix<3, 3> edges;
            for (int k = 0; k < 3; ++k) {
                const double sign = (corner >> k & 1) == 0 ? 1.0 : -1.0;
                edges.col(k) = sign * (shape.positions[nodes[corner ^ (1 << k)]] -
                                       shape.positions[nodes[corner]]);
            }
            if (edges.determinant() <= 0.0) {
                throw InputError(
                    "cuboid {} is flat or turned inside out at its corner {} (node {}): the edges "
                    "there have determinant {}; corner i lies at (i & 1, i >> 1 & 1, i >> 2 & 1)",
                    c, corner, nodes[corner], edges.determinant());
            }
        }
    }
}

void check_connected(const VolumetricLayout& layout) {
    if (layout.cuboids.empty()) throw InputError("there are no cuboids");
    DisjointSets parts(layout.n_nodes);
    for (const auto& nodes : layout.cuboids) {
        for (const int node : nodes) parts.join(nodes[0], node);
    }
    for (int node = 0; node < layout.n_nodes; ++node) {
        if (parts.find(node) != parts.find(0)) {
            throw TopologyError("node {} is not connected with node 0", node);
        }
    }
}

// Patches are pieces of genus 0, so that what fills one and its caps is a ball.
void check_ball(const VolumeTopology& topology) {
    if (topology.genera == std::vector<int>{0}) return;
    const auto n_tunnels = std::accumulate(topology.genera.begin(), topology.genera.end(), 0);
    throw TopologyError(
        "the cuboids have {} tunnels and {} cavities; they must be a ball, as a patch of a surface "
        "and its caps bound one: open a ring at a pair of caps",
        n_tunnels, topology.genera.size() - 1);
}

void check_caps(const CuboidTemplate& shape, const LayoutBoundary& boundary) {
    const std::set<std::string> names(shape.caps.begin(), shape.caps.end());
    if (names.size() != shape.caps.size() || names.size() != shape.layout.sets.size()) {
        throw InputError("{} caps are listed, {} of them different, and there are {} sets",
                         shape.caps.size(), names.size(), shape.layout.sets.size());
    }
    std::map<int, std::string> cap_of_node;
    for (const std::string& name : shape.caps) {
        if (!shape.layout.sets.contains(name)) throw InputError("cap '{}' has no sides", name);
        std::set<int> nodes;
        for (const CuboidSide& side : shape.layout.sets.at(name)) {
            if (!std::ranges::binary_search(boundary.sides, side)) {
                throw TopologyError("cap '{}' has side {} of cuboid {}, which is no outer side",
                                    name, side.side, side.cuboid);
            }
            for (const int node : shape.layout.nodes_of(side)) nodes.insert(node);
        }
        for (const int node : nodes) {
            const auto [at, is_new] = cap_of_node.emplace(node, name);
            if (!is_new) {
                throw TopologyError("caps '{}' and '{}' share node {}; caps may not touch",
                                    at->second, name, node);
            }
        }
        try {
            static_cast<void>(make_cap_pattern(quads_of(shape.layout, shape.layout.sets.at(name))));
        } catch (const TopologyError& error) {
            throw TopologyError("cap '{}': {}", name, error.what());
        }
    }
}

Vector3 normal(const CuboidTemplate& shape, const std::array<int, 4>& quad) {
    const auto at = [&](int k) -> const Vector3& { return shape.positions[quad[k]]; };
    return (at(2) - at(0)).cross(at(3) - at(1)).normalized();
}

constexpr double largest_bend = std::numbers::sqrt2 / 2.0;  // cosine of 45 degrees

}  // namespace

void check_template(const CuboidTemplate& shape) {
    try {
        const LayoutBoundary boundary = layout_boundary(shape.layout);
        check_connected(shape.layout);
        check_ball(volume_topology(shape.layout));
        check_positions(shape);
        check_caps(shape, boundary);
    } catch (const InputError& error) {
        throw InputError("template '{}': {}", shape.name, error.what());
    } catch (const TopologyError& error) {
        throw TopologyError("template '{}': {}", shape.name, error.what());
    }
}

CapPattern cap_pattern(const CuboidTemplate& shape, int cap) {
    return make_cap_pattern(quads_of(shape.layout, shape.cap_sides(cap)));
}

LayoutBoundary wall_of(const CuboidTemplate& shape) {
    LayoutBoundary wall = layout_boundary(shape.layout);
    for (const std::string& cap : shape.caps) {
        for (const CuboidSide& side : shape.layout.sets.at(cap)) std::erase(wall.sides, side);
    }
    wall.layout = QuadLayout(shape.layout.n_nodes, quads_of(shape.layout, wall.sides));
    return wall;
}

std::vector<ArcKind> arc_kinds(const CuboidTemplate& shape, const LayoutBoundary& boundary) {
    const QuadLayout& layout = boundary.layout;
    std::vector<ArcKind> kinds(layout.n_arcs(), ArcKind::convex);
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (layout.is_boundary_arc(a)) continue;
        const Vector3 left = normal(shape, layout.quads()[layout.arc_quads(a)[0].quad]);
        const Vector3 right = normal(shape, layout.quads()[layout.arc_quads(a)[1].quad]);
        const auto& [from, to] = layout.arcs()[a];
        const Vector3 along = shape.positions[to] - shape.positions[from];
        if (left.dot(right) > largest_bend) {
            kinds[a] = ArcKind::flat;
        } else if (left.cross(right).dot(along) < 0.0) {
            kinds[a] = ArcKind::reflex;
        }
    }
    return kinds;
}

std::vector<bool> corner_nodes(const CuboidTemplate& shape, const LayoutBoundary& boundary) {
    const auto kinds = arc_kinds(shape, boundary);
    std::vector<std::vector<Vector3>> directions(shape.layout.n_nodes);
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        if (kinds[a] == ArcKind::flat) continue;
        const auto& [from, to] = boundary.layout.arcs()[a];
        const Vector3 along = (shape.positions[to] - shape.positions[from]).normalized();
        directions[from].push_back(along);
        directions[to].push_back(-along);
    }
    std::vector<bool> is_corner(shape.layout.n_nodes, false);
    for (int node = 0; node < shape.layout.n_nodes; ++node) {
        const auto& there = directions[node];
        is_corner[node] = there.size() == 1 || there.size() > 2 ||
                          (there.size() == 2 && there[0].dot(there[1]) > -largest_bend);
    }
    return is_corner;
}

void TemplateLibrary::add(CuboidTemplate shape) {
    check_template(shape);
    const auto key = [](const CuboidTemplate& t) {
        return std::tuple(t.n_caps(), t.layout.n_cuboids(), t.name);
    };
    for (const CuboidTemplate& other : templates_) {
        if (other.name == shape.name) {
            throw InputError("template '{}' is there already; give another name", shape.name);
        }
    }
    templates_.insert(std::ranges::upper_bound(templates_, key(shape), {}, key), std::move(shape));
}

std::span<const CuboidTemplate> TemplateLibrary::with_caps(int n_caps) const {
    const auto [begin, end] =
        std::ranges::equal_range(templates_, n_caps, {}, &CuboidTemplate::n_caps);
    return {begin, end};
}

const CuboidTemplate& TemplateLibrary::find(std::string_view name) const {
    const auto found = std::ranges::find(templates_, name, &CuboidTemplate::name);
    if (found != templates_.end()) return *found;
    std::vector<std::string> names;
    for (const CuboidTemplate& shape : templates_) names.push_back(shape.name);
    const auto nearest = nearest_name(name, names);
    throw InputError(
        "there is no template '{}'{}", name,
        nearest ? fmt::format("; did you mean '{}'?", *nearest) : " (the library is empty)");
}

}  // namespace couture::meshing
