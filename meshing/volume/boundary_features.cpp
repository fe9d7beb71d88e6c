#include "meshing/volume/boundary_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "iga/topology/side_patch.h"

namespace couture::meshing {

using iga::End;
using iga::MultiPatch;
using Entity = iga::PatchEntity<3>;

namespace {

/// An edge of a side, found from its control points whatever patch it is seen from.
struct EdgeUse {
    int side = 0;
    Entity edge;
    /// Runs against the order of the key.
    bool is_reversed = false;
};

struct Edge {
    std::vector<EdgeUse> uses;
    std::set<std::string> names;
    bool is_feature = false;
};

Vector3 outward_normal(const MultiPatch<3>& geometry, const Entity& side, const Vector3& xi,
                       int orientation) {
    const iga::Patch<3>& patch = geometry.patches[side.patch];
    const MatrixX J = patch.jacobian(xi);
    const int k = iga::side_direction(side.side());
    const Vector3 a = J.col((k + 1) % 3);
    const Vector3 b = J.col((k + 2) % 3);
    return (iga::side_is_high(side.side()) ? orientation : -orientation) * a.cross(b);
}

double angle_between(const Vector3& a, const Vector3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// All the parts of the search, on the initial geometry.
struct Finder {
    const MultiPatch<3>& geometry;
    const iga::DofMap& dofs;
    const std::vector<int>& orientations;
    double feature_angle;

    std::vector<Entity> sides;
    std::vector<bool> is_inner;
    std::vector<std::set<std::string>> side_names;
    /// By the control points along it, in the direction that makes the list smaller.
    std::map<std::vector<int>, Edge> edges;
    std::vector<int> fixed_dofs;

    [[nodiscard]] std::vector<int> dofs_on(const Entity& entity) const {
        std::vector<int> result =
            iga::functions_on<3>(geometry.patches[entity.patch].space(), entity.position);
        for (int& function : result) {
            function = dofs.global[entity.patch][function];
        }
        return result;
    }

    void find_sides() {
        sides = geometry.outer_sides();
        is_inner.assign(sides.size(), false);
        std::map<std::vector<int>, int> known;
        const auto sorted_dofs = [&](const Entity& side) {
            std::vector<int> key = dofs_on(side);
            std::sort(key.begin(), key.end());
            return key;
        };
        for (std::size_t i = 0; i < sides.size(); ++i) {
            known.emplace(sorted_dofs(sides[i]), static_cast<int>(i));
        }
        side_names.resize(sides.size());
        for (const auto& [name, set] : geometry.boundary_sets) {
            for (const Entity& entity : set) {
                if (!entity.is_side()) {
                    continue;
                }
                const auto [found, is_new] =
                    known.emplace(sorted_dofs(entity), static_cast<int>(sides.size()));
                if (is_new) {
                    sides.push_back(entity);
                    is_inner.push_back(true);
                    side_names.emplace_back();
                }
                side_names[found->second].insert(name);
            }
        }
    }

    [[nodiscard]] std::pair<std::vector<int>, bool> edge_key(const Entity& edge) const {
        std::vector<int> key = dofs_on(edge);
        std::vector<int> reversed(key.rbegin(), key.rend());
        const bool is_reversed = reversed < key;
        return {is_reversed ? std::move(reversed) : std::move(key), is_reversed};
    }

    void find_edges() {
        for (std::size_t i = 0; i < sides.size(); ++i) {
            for (const int direction : iga::tangential_directions<3>(sides[i].side())) {
                for (const End end : {End::low, End::high}) {
                    Entity edge = sides[i];
                    edge.position[direction] = end;
                    const auto [key, is_reversed] = edge_key(edge);
                    edges[key].uses.push_back({static_cast<int>(i), edge, is_reversed});
                }
            }
        }
        for (const auto& [name, set] : geometry.boundary_sets) {
            for (const Entity& entity : set) {
                if (entity.is_side()) {
                    continue;
                }
                const std::vector<int> on = dofs_on(entity);
                const auto found =
                    entity.dimension() == 1 ? edges.find(edge_key(entity).first) : edges.end();
                if (found != edges.end()) {
                    found->second.names.insert(name);
                } else {
                    fixed_dofs.insert(fixed_dofs.end(), on.begin(), on.end());
                }
            }
        }
        for (auto& [key, edge] : edges) {
            edge.is_feature = !edge.names.empty() || edge.uses.size() != 2 ||
                              side_names[edge.uses[0].side] != side_names[edge.uses[1].side] ||
                              largest_angle(edge) > feature_angle;
        }
    }

    /// Between the normals of an edge's two sides, at its breakpoints and middles of elements.
    [[nodiscard]] double largest_angle(const Edge& edge) const {
        std::array<std::vector<Vector3>, 2> normals;
        for (int use = 0; use < 2; ++use) {
            const Entity& entity = edge.uses[use].edge;
            const Entity& side = sides[edge.uses[use].side];
            const iga::TensorSpace<3>& space = geometry.patches[entity.patch].space();
            const iga::TensorSpace<1> line = iga::entity_space<3, 1>(space, entity.position);
            const std::vector<double>& breakpoints = line.knots[0].breakpoints();
            for (std::size_t i = 0; i + 1 < 2 * breakpoints.size(); ++i) {
                const Vector<1> xi(0.5 * (breakpoints[i / 2] + breakpoints[(i + 1) / 2]));
                normals[use].push_back(outward_normal(
                    geometry, side, iga::entity_parameter<3, 1>(space, entity.position, xi),
                    orientations[side.patch]));
            }
            if (edge.uses[use].is_reversed) {
                std::reverse(normals[use].begin(), normals[use].end());
            }
        }
        const bool has_sign = !is_inner[edge.uses[0].side] && !is_inner[edge.uses[1].side];
        double largest = 0.0;
        for (std::size_t i = 0; i < normals[0].size(); ++i) {
            // Where a side collapses it has no normal.
            if (normals[0][i].norm() > 0.0 && normals[1][i].norm() > 0.0) {
                const double angle = angle_between(normals[0][i], normals[1][i]);
                largest =
                    std::max(largest, has_sign ? angle : std::min(angle, std::numbers::pi - angle));
            }
        }
        return largest;
    }

    /// The body fills more than a half around the edge somewhere: from it, one side runs out of the
    /// half space that the other one bounds.
    [[nodiscard]] bool is_reentrant(const Edge& edge) const {
        if (edge.uses.size() != 2 || is_inner[edge.uses[0].side] || is_inner[edge.uses[1].side]) {
            return false;
        }
        std::array<std::vector<Vector3>, 2> normals;
        std::array<std::vector<Vector3>, 2> inwards;
        for (int use = 0; use < 2; ++use) {
            const Entity& entity = edge.uses[use].edge;
            const Entity& side = sides[edge.uses[use].side];
            const iga::Patch<3>& patch = geometry.patches[entity.patch];
            int across = 0;
            while (entity.position[across] == End::free ||
                   across == iga::side_direction(side.side())) {
                ++across;
            }
            const double sign = entity.position[across] == End::low ? 1.0 : -1.0;
            const iga::KnotVector line =
                iga::entity_space<3, 1>(patch.space(), entity.position).knots[0];
            for (const double at : line.breakpoints()) {
                const Vector3 xi =
                    iga::entity_parameter<3, 1>(patch.space(), entity.position, Vector<1>(at));
                normals[use].push_back(
                    outward_normal(geometry, side, xi, orientations[side.patch]).normalized());
                inwards[use].push_back(sign * Vector3(patch.jacobian(xi).col(across)).normalized());
            }
            if (edge.uses[use].is_reversed) {
                std::reverse(normals[use].begin(), normals[use].end());
                std::reverse(inwards[use].begin(), inwards[use].end());
            }
        }
        for (std::size_t i = 0; i < normals[0].size(); ++i) {
            if (normals[0][i].dot(inwards[1][i]) > std::sin(feature_angle)) {
                return true;
            }
        }
        return false;
    }

    /// Tangent of an edge at its first or last control point in the order of the key, inwards.
    [[nodiscard]] Vector3 tangent(const Edge& edge, bool at_last) const {
        const EdgeUse& use = edge.uses[0];
        const iga::Curve curve =
            iga::entity_patch<3, 1>(geometry.patches[use.edge.patch], use.edge.position);
        const bool at_back = at_last != use.is_reversed;
        const Vector<1> xi(at_back ? curve.knots(0).back() : curve.knots(0).front());
        const Vector3 derivative = curve.jacobian(xi);
        return at_back ? Vector3(-derivative) : derivative;
    }
};

/// Numbers the classes in order of their first members.
template <typename Member>
std::vector<std::vector<Member>> grouped(const std::vector<Member>& members, DisjointSets& classes,
                                         std::vector<int>& group_of) {
    std::vector<std::vector<Member>> groups;
    group_of.assign(members.size(), -1);
    for (std::size_t i = 0; i < members.size(); ++i) {
        const int root = classes.find(static_cast<int>(i));
        if (group_of[root] < 0) {
            group_of[root] = static_cast<int>(groups.size());
            groups.emplace_back();
        }
        group_of[i] = group_of[root];
        groups[group_of[i]].push_back(members[i]);
    }
    return groups;
}

/// Numbers of the functions on an element.
std::vector<int> element_dofs(const iga::TensorSpace<3>& space, const std::vector<int>& global,
                              const std::array<int, 3>& element) {
    std::array<int, 3> first;
    std::array<int, 3> degree;
    for (int k = 0; k < 3; ++k) {
        degree[k] = space.knots[k].degree();
        first[k] = space.knots[k].span_of_element(element[k]) - degree[k];
    }
    std::vector<int> result;
    for (int c = 0; c <= degree[2]; ++c) {
        for (int b = 0; b <= degree[1]; ++b) {
            for (int a = 0; a <= degree[0]; ++a) {
                result.push_back(global[space.index({first[0] + a, first[1] + b, first[2] + c})]);
            }
        }
    }
    return result;
}

}  // namespace

BoundaryFeatures::BoundaryFeatures(const MultiPatch<3>& initial, double feature_angle) {
    if (!(feature_angle > 0.0 && feature_angle < std::numbers::pi)) {
        throw InputError(
            "BoundaryFeatures: feature angle {} is out of range; it must lie in (0, pi)",
            feature_angle);
    }
    if (initial.dimension() != 3) {
        throw InputError("BoundaryFeatures: patches of {} coordinates; volumes need 3",
                         initial.dimension());
    }
    signature_ = iga::signature(initial);
    std::vector<iga::TensorSpace<3>> spaces;
    for (const iga::Patch<3>& patch : initial.patches) {
        spaces.push_back(patch.space());
        orientations_.push_back(iga::orientation(patch));
    }
    dofs_ = iga::make_dof_map(initial, spaces);

    Finder finder{initial, dofs_, orientations_, feature_angle, {}, {}, {}, {}, {}};
    finder.find_sides();
    finder.find_edges();

    freedom_.assign(dofs_.n_dofs, Freedom::interior);
    feature_.assign(dofs_.n_dofs, -1);
    const auto set = [&](const std::vector<int>& on, Freedom freedom, int feature) {
        for (const int dof : on) {
            freedom_[dof] = freedom;
            feature_[dof] = feature;
        }
    };

    DisjointSets side_classes(finder.sides.size());
    std::vector<const Edge*> features;
    std::vector<Entity> feature_edges;
    struct EdgeEnd {
        int edge;
        bool is_last;
    };
    std::map<int, std::vector<EdgeEnd>> ends_at;
    for (const auto& [key, edge] : finder.edges) {
        if (!edge.is_feature) {
            side_classes.join(edge.uses[0].side, edge.uses[1].side);
            continue;
        }
        const int number = static_cast<int>(features.size());
        ends_at[key.front()].push_back({number, false});
        ends_at[key.back()].push_back({number, true});
        features.push_back(&edge);
        feature_edges.push_back(edge.uses[0].edge);
    }
    find_near_reentrant(initial, [&] {
        std::vector<bool> on_edge(dofs_.n_dofs, false);
        for (const Edge* edge : features) {
            if (finder.is_reentrant(*edge)) {
                for (const int dof : finder.dofs_on(edge->uses[0].edge)) {
                    on_edge[dof] = true;
                }
            }
        }
        return on_edge;
    }());
    std::vector<int> face_of;
    faces_ = grouped(finder.sides, side_classes, face_of);
    for (std::size_t i = 0; i < finder.sides.size(); ++i) {
        set(finder.dofs_on(finder.sides[i]), Freedom::face, face_of[i]);
    }

    DisjointSets edge_classes(features.size());
    for (const auto& [vertex, ends] : ends_at) {
        const bool is_smooth =
            ends.size() == 2 && features[ends[0].edge]->names == features[ends[1].edge]->names &&
            angle_between(-finder.tangent(*features[ends[0].edge], ends[0].is_last),
                          finder.tangent(*features[ends[1].edge], ends[1].is_last)) < feature_angle;
        if (is_smooth) {
            edge_classes.join(ends[0].edge, ends[1].edge);
        } else {
            corners_.push_back(vertex);
        }
    }
    std::vector<int> curve_of;
    curves_ = grouped(feature_edges, edge_classes, curve_of);
    for (std::size_t i = 0; i < feature_edges.size(); ++i) {
        set(finder.dofs_on(feature_edges[i]), Freedom::curve, curve_of[i]);
    }
    set(corners_, Freedom::fixed, -1);
    set(finder.fixed_dofs, Freedom::fixed, -1);
    for (const iga::CollapsedEntity<3>& collapsed : iga::collapsed_entities(initial)) {
        set(finder.dofs_on(collapsed.entity), Freedom::fixed, -1);
    }
}

void BoundaryFeatures::find_near_reentrant(const MultiPatch<3>& geometry,
                                           const std::vector<bool>& on_edge) {
    near_reentrant_.assign(dofs_.n_dofs, false);
    for (int p = 0; p < geometry.n_patches(); ++p) {
        const iga::TensorSpace<3>& space = geometry.patches[p].space();
        const std::array<int, 3> n = space.n_elements();
        for (int e = 0; e < n[0] * n[1] * n[2]; ++e) {
            const std::array<int, 3> at = {e % n[0], e / n[0] % n[1], e / (n[0] * n[1])};
            const std::vector<int> dofs = element_dofs(space, dofs_.global[p], at);
            if (std::any_of(dofs.begin(), dofs.end(), [&](int i) { return on_edge[i]; })) {
                for (const int dof : dofs) {
                    near_reentrant_[dof] = true;
                }
            }
        }
    }
}

std::vector<int> BoundaryFeatures::dofs_on(const MultiPatch<3>& geometry,
                                           const Entity& entity) const {
    std::vector<int> result =
        iga::functions_on<3>(geometry.patches[entity.patch].space(), entity.position);
    for (int& function : result) {
        function = dofs_.global[entity.patch][function];
    }
    return result;
}

}  // namespace couture::meshing
