#include "iga/topology/multipatch.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "iga/core/error.h"
#include "iga/core/nearest_name.h"
#include "iga/topology/side_gap.h"

namespace couture::iga {

template <int d>
int MultiPatch<d>::n_control_points() const {
    int n = 0;
    for (const Patch<d>& patch : patches) {
        n += patch.space().n_basis();
    }
    return n;
}

template <int d>
MatrixX MultiPatch<d>::bounding_box() const {
    MatrixX box = MatrixX::Zero(dimension(), 2);
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const VectorX low = patches[p].control_points().colwise().minCoeff();
        const VectorX high = patches[p].control_points().colwise().maxCoeff();
        box.col(0) = p == 0 ? low : VectorX(box.col(0).cwiseMin(low));
        box.col(1) = p == 0 ? high : VectorX(box.col(1).cwiseMax(high));
    }
    return box;
}

template <int d>
double MultiPatch<d>::size() const {
    const MatrixX box = bounding_box();
    return (box.col(1) - box.col(0)).norm();
}

template <int d>
std::vector<PatchEntity<d>> MultiPatch<d>::outer_sides() const {
    std::vector<bool> is_inner(patches.size() * n_sides<d>, false);
    for (const Interface<d>& interface : interfaces) {
        is_inner[interface.first_patch * n_sides<d> + interface.first_side] = true;
        is_inner[interface.second_patch * n_sides<d> + interface.second_side] = true;
    }
    std::vector<PatchEntity<d>> result;
    for (int p = 0; p < n_patches(); ++p) {
        for (int side = 0; side < n_sides<d>; ++side) {
            if (!is_inner[p * n_sides<d> + side]) {
                result.push_back(make_side<d>(p, side));
            }
        }
    }
    return result;
}

template <int d>
const BoundarySet<d>& MultiPatch<d>::boundary_set(const std::string& name) const {
    const auto found = boundary_sets.find(name);
    if (found != boundary_sets.end()) {
        return found->second;
    }
    std::vector<std::string> names;
    for (const auto& [each, entities] : boundary_sets) {
        names.push_back(each);
    }
    const std::optional<std::string> nearest = nearest_name(name, names);
    if (!nearest) {
        throw TopologyError("MultiPatch: no boundary set '{}'; the geometry has none at all", name);
    }
    throw TopologyError("MultiPatch: no boundary set '{}'; did you mean '{}'? There are: {}", name,
                        *nearest, fmt::join(names, ", "));
}

namespace {

template <int d>
void check_side(const MultiPatch<d>& multipatch, std::size_t i_interface, int patch, int side,
                std::set<std::pair<int, int>>& used) {
    if (patch < 0 || patch >= multipatch.n_patches() || side < 0 || side >= n_sides<d>) {
        throw TopologyError(
            "MultiPatch: interface {} names patch {} side {}; there are {} patches with sides 0 to "
            "{}",
            i_interface, patch, side, multipatch.n_patches(), n_sides<d> - 1);
    }
    if (!used.emplace(patch, side).second) {
        throw TopologyError(
            "MultiPatch: interface {} names {} again; a side meets at most one other side",
            i_interface, make_side<d>(patch, side).name());
    }
}

template <int d>
void check_conforming(const MultiPatch<d>& multipatch, const Interface<d>& interface) {
    const TensorSpace<d>& first = multipatch.patches[interface.first_patch].space();
    const TensorSpace<d>& second = multipatch.patches[interface.second_patch].space();
    const std::optional<int> i = nonconforming_direction(first, second, interface);
    if (!i) {
        return;
    }
    const int here = tangential_directions<d>(interface.first_side)[*i];
    const int there = tangential_directions<d>(interface.second_side)[interface.map.axis[*i]];
    throw TopologyError(
        "MultiPatch: {} do not conform: direction {} of patch {} has degree {} and {} elements, "
        "direction {} of patch {} degree {} and {} elements; degrees and knots must be equal up to "
        "scale (make_conforming refines them)",
        to_string(interface), here, interface.first_patch, first.knots[here].degree(),
        first.knots[here].n_elements(), there, interface.second_patch, second.knots[there].degree(),
        second.knots[there].n_elements());
}

template <int d>
void check_geometry(const MultiPatch<d>& multipatch, const Interface<d>& interface,
                    double tolerance, double size) {
    const Patch<d>& first = multipatch.patches[interface.first_patch];
    const Patch<d>& second = multipatch.patches[interface.second_patch];
    const SideGap gap = side_gap(first, second, interface);
    if (!(gap.distance <= tolerance * size)) {
        throw GeometryError(
            "MultiPatch: {} are an interface but their control points lie up to {:.3g} apart; "
            "allowed is {:.3g} ({:g} of the size)",
            to_string(interface), gap.distance, tolerance * size, tolerance);
    }
    if (!(gap.weight <= tolerance)) {
        throw GeometryError(
            "MultiPatch: {} are an interface but their weights differ by {:.3g} after scaling to "
            "a common factor; allowed is {:g}",
            to_string(interface), gap.weight, tolerance);
    }
}

}  // namespace

template <int d>
void check_combinatorics(const MultiPatch<d>& multipatch) {
    if (multipatch.patches.empty()) {
        throw TopologyError("MultiPatch: no patches; a geometry has at least one");
    }
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        if (multipatch.patches[p].dimension() != multipatch.dimension()) {
            throw TopologyError(
                "MultiPatch: control points of patch {} have {} coordinates, those of patch 0 have "
                "{}; all must have the same number",
                p, multipatch.patches[p].dimension(), multipatch.dimension());
        }
    }
    std::set<std::pair<int, int>> used;
    const std::vector<SideMap<d>> maps = all_side_maps<d>();
    for (std::size_t i = 0; i < multipatch.interfaces.size(); ++i) {
        const Interface<d>& interface = multipatch.interfaces[i];
        check_side(multipatch, i, interface.first_patch, interface.first_side, used);
        check_side(multipatch, i, interface.second_patch, interface.second_side, used);
        if (std::find(maps.begin(), maps.end(), interface.map) == maps.end()) {
            throw TopologyError(
                "MultiPatch: interface {} ({}) maps tangential directions to {}; they must be a "
                "permutation of 0 to {}",
                i, to_string(interface), fmt::join(interface.map.axis, ", "), d - 2);
        }
        check_conforming(multipatch, interface);
    }
    for (const auto& [name, entities] : multipatch.boundary_sets) {
        for (const PatchEntity<d>& entity : entities) {
            if (entity.patch < 0 || entity.patch >= multipatch.n_patches()) {
                throw TopologyError("MultiPatch: boundary set '{}' names patch {}; there are {}",
                                    name, entity.patch, multipatch.n_patches());
            }
            if (entity.dimension() == d) {
                throw TopologyError(
                    "MultiPatch: boundary set '{}' names all of patch {}; it may hold sides, edges "
                    "and corners",
                    name, entity.patch);
            }
        }
    }
}

template <int d>
void check(const MultiPatch<d>& multipatch, double tolerance) {
    check_combinatorics(multipatch);
    const double size = multipatch.size();
    for (const Interface<d>& interface : multipatch.interfaces) {
        check_geometry(multipatch, interface, tolerance, size);
    }
}

#define COUTURE_INSTANTIATE(d)                               \
    template struct MultiPatch<d>;                           \
    template void check_combinatorics(const MultiPatch<d>&); \
    template void check(const MultiPatch<d>&, double);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
