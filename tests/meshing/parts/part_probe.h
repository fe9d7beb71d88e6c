#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <functional>
#include <limits>

#include "iga/topology/multipatch.h"
#include "meshing/parts/parts.h"

namespace couture::meshing {

[[nodiscard]] inline iga::MultiPatch<2> make_plane_part(
    const std::string& name, const std::map<std::string, double>& parameters = {}) {
    return std::get<iga::MultiPatch<2>>(make_part(name, parameters));
}

[[nodiscard]] inline iga::MultiPatch<3> make_solid_part(
    const std::string& name, const std::map<std::string, double>& parameters = {}) {
    return std::get<iga::MultiPatch<3>>(make_part(name, parameters));
}

/// Calls `visit` with a grid of n points per free direction of an entity.
template <int d>
void for_each_parameter(const iga::MultiPatch<d>& part, const iga::PatchEntity<d>& entity, int n,
                        const std::function<void(const Vector<d>&)>& visit) {
    const iga::Patch<d>& patch = part.patches[entity.patch];
    int n_points = 1;
    for (int k = 0; k < entity.dimension(); ++k) {
        n_points *= n;
    }
    for (int point = 0; point < n_points; ++point) {
        Vector<d> xi;
        int rest = point;
        for (int k = 0; k < d; ++k) {
            const double front = patch.knots(k).front();
            const double back = patch.knots(k).back();
            switch (entity.position[k]) {
                case iga::End::low:
                    xi[k] = front;
                    break;
                case iga::End::high:
                    xi[k] = back;
                    break;
                case iga::End::free:
                    xi[k] = front + (back - front) * (rest % n) / (n - 1);
                    rest /= n;
                    break;
            }
        }
        visit(xi);
    }
}

/// Largest |f(x)| over a grid of points of all entities of a named set.
template <int d>
[[nodiscard]] double largest_on(const iga::MultiPatch<d>& part, const std::string& set,
                                const std::function<double(const VectorX&)>& f) {
    double largest = 0.0;
    for (const iga::PatchEntity<d>& entity : part.boundary_set(set)) {
        for_each_parameter<d>(part, entity, 7, [&](const Vector<d>& xi) {
            largest = std::max(largest, std::abs(f(part.patches[entity.patch].point(xi))));
        });
    }
    return largest;
}

/// Smallest determinant of J (with `is_scaled`: over the lengths of its columns) on a grid.
template <int d>
[[nodiscard]] double smallest_jacobian(const iga::MultiPatch<d>& part, bool is_scaled) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int patch = 0; patch < part.n_patches(); ++patch) {
        for_each_parameter<d>(part, iga::PatchEntity<d>{patch, {}}, 5, [&](const Vector<d>& xi) {
            const Matrix<d> J = part.patches[patch].jacobian(xi);
            const double scale = is_scaled ? J.colwise().norm().prod() : 1.0;
            smallest = std::min(smallest, J.determinant() / scale);
        });
    }
    return smallest;
}

}  // namespace couture::meshing
