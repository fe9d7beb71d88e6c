#include "iga/topology/dof_map.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::iga {

namespace {

/// Pairs of a function on the entity and the first function of its line in `direction`.
template <int d, typename Visit>
bool all_on_lines(const TensorSpace<d>& space, const PatchEntity<d>& entity, int direction,
                  Visit&& visit) {
    for (const int function : functions_on<d>(space, entity.position)) {
        std::array<int, d> i = space.indices(function);
        i[direction] = 0;
        if (!visit(function, space.index(i))) {
            return false;
        }
    }
    return true;
}

template <int d>
bool collapses(const Patch<d>& patch, const PatchEntity<d>& entity, int direction,
               double max_length) {
    return all_on_lines(patch.space(), entity, direction, [&](int function, int first) {
        return (patch.control_points().row(function) - patch.control_points().row(first)).norm() <=
               max_length;
    });
}

/// Calls visit(entity, direction) for each collapse, sides first.
template <int d, typename Visit>
void for_each_collapse(const MultiPatch<d>& geometry, double tolerance, Visit&& visit) {
    const double max_length = tolerance * geometry.size();
    for (int p = 0; p < geometry.n_patches(); ++p) {
        for (int dimension = d - 1; dimension >= 1; --dimension) {
            for (const PatchEntity<d>& entity : entities_of_patch<d>(p, dimension)) {
                for (int k = 0; k < d; ++k) {
                    if (entity.position[k] == End::free &&
                        collapses(geometry.patches[p], entity, k, max_length)) {
                        visit(entity, k);
                    }
                }
            }
        }
    }
}

}  // namespace

template <int d>
DofMap make_dof_map(const MultiPatch<d>& geometry, const std::vector<TensorSpace<d>>& spaces,
                    double tolerance) {
    check_combinatorics(geometry);
    if (spaces.size() != geometry.patches.size()) {
        throw TopologyError("make_dof_map: {} spaces for {} patches; each patch takes one",
                            spaces.size(), geometry.patches.size());
    }
    std::vector<int> offset(spaces.size() + 1, 0);
    for (std::size_t p = 0; p < spaces.size(); ++p) {
        offset[p + 1] = offset[p] + spaces[p].n_basis();
    }
    DisjointSets classes(offset.back());
    for (const Interface<d>& interface : geometry.interfaces) {
        const TensorSpace<d>& first = spaces[interface.first_patch];
        const TensorSpace<d>& second = spaces[interface.second_patch];
        if (const std::optional<int> i = nonconforming_direction(first, second, interface)) {
            throw TopologyError(
                "make_dof_map: spaces on {} do not conform in direction {} of patch {}; degrees "
                "and knots must be equal up to scale",
                to_string(interface), tangential_directions<d>(interface.first_side)[*i],
                interface.first_patch);
        }
        const std::vector<int> here =
            functions_on<d>(first, make_side<d>(0, interface.first_side).position);
        const std::vector<int> there = matching_functions(second, interface);
        for (std::size_t i = 0; i < here.size(); ++i) {
            classes.join(offset[interface.first_patch] + here[i],
                         offset[interface.second_patch] + there[i]);
        }
    }
    for_each_collapse(geometry, tolerance, [&](const PatchEntity<d>& entity, int direction) {
        const int start = offset[entity.patch];
        all_on_lines(spaces[entity.patch], entity, direction, [&](int function, int first) {
            classes.join(start + function, start + first);
            return true;
        });
    });

    DofMap map;
    map.global.resize(spaces.size());
    std::vector<int> number(offset.back(), 0);
    for (std::size_t p = 0; p < spaces.size(); ++p) {
        map.global[p].reserve(offset[p + 1] - offset[p]);
        for (int i = offset[p]; i < offset[p + 1]; ++i) {
            const int root = classes.find(i);
            if (root == i) {
                number[i] = map.n_dofs++;
            }
            map.global[p].push_back(number[root]);
        }
    }
    return map;
}

template <int d>
std::string CollapsedEntity<d>::name() const {
    return fmt::format("{} collapses in direction{} {}", entity.name(),
                       directions.size() > 1 ? "s" : "", fmt::join(directions, " and "));
}

template <int d>
std::vector<CollapsedEntity<d>> collapsed_entities(const MultiPatch<d>& geometry,
                                                   double tolerance) {
    std::vector<CollapsedEntity<d>> result;
    for_each_collapse(geometry, tolerance, [&](const PatchEntity<d>& entity, int direction) {
        // Whether a side reported before holds this edge and collapses in the same direction.
        bool is_known = false;
        for (auto other = result.rbegin();
             other != result.rend() && other->entity.patch == entity.patch; ++other) {
            bool contains = other->entity != entity;
            for (int k = 0; k < d; ++k) {
                contains = contains && (other->entity.position[k] == End::free ||
                                        other->entity.position[k] == entity.position[k]);
            }
            const std::vector<int>& known = other->directions;
            is_known = is_known || (contains && std::count(known.begin(), known.end(), direction));
        }
        if (is_known) {
            return;
        }
        if (!result.empty() && result.back().entity == entity) {
            result.back().directions.push_back(direction);
        } else {
            result.push_back({entity, {direction}});
        }
    });
    return result;
}

#define COUTURE_INSTANTIATE(d)                                                             \
    template DofMap make_dof_map(const MultiPatch<d>&, const std::vector<TensorSpace<d>>&, \
                                 double);                                                  \
    template struct CollapsedEntity<d>;                                                    \
    template std::vector<CollapsedEntity<d>> collapsed_entities(const MultiPatch<d>&, double);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
