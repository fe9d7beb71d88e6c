#pragma once

#include <functional>

#include "iga/assembly/geometry_grid.h"

namespace couture::iga {

/// A symmetric bilinear form a(v, u) = integral of sum D_s v_a A[a, b][s, t] D_t u_b, where
/// D_s = d/dx_s for s < d and D_d is the value itself. Physics enters here as a pure function of
/// one point; the assembly knows nothing else of it.
template <int d>
struct BilinearForm {
    int n_components = 1;
    /// A has entries with the value (s = d or t = d).
    bool has_value = false;
    /// A depends on the place (else it is asked for once per patch).
    bool varies = false;
    /// Fills A, [a][b][s][t], n_components^2 (d + 1)^2 numbers, cleared before.
    /// @param x  position (z = 0 in the plane)
    std::function<void(int patch, const Vector3& x, double* A)> coefficients;
    /// If set, asked instead of `coefficients` (A depends on a field): fills A,
    /// [point][a][b][s][t], of a plane of quadrature points, cleared before; several planes at once
    /// from several threads.
    std::function<void(int patch, const GeometryGrid<d>& grid, int i_plane,
                       const GeometryPlane<d>& plane, double* A)>
        plane_coefficients;

    [[nodiscard]] bool is_constant() const { return !varies && !plane_coefficients; }

    [[nodiscard]] int size() const { return n_components * n_components * (d + 1) * (d + 1); }
};

/// A of a form at the points of a plane, [point][a][b][s][t]; of a constant form one for all.
template <int d>
void evaluate_coefficients(const BilinearForm<d>& form, int patch, const GeometryGrid<d>& grid,
                           int i_plane, const GeometryPlane<d>& plane, Buffer<double>& A) {
    const auto size = static_cast<std::size_t>(form.size());
    if (form.is_constant()) {
        A.assign(size, 0.0);
        form.coefficients(patch, Vector3::Zero(), A.data());
        return;
    }
    A.assign(plane.n_points * size, 0.0);
    if (form.plane_coefficients) {
        form.plane_coefficients(patch, grid, i_plane, plane, A.data());
        return;
    }
    for (int q = 0; q < plane.n_points; ++q) {
        form.coefficients(patch, Vector3(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]),
                          &A[q * size]);
    }
}

/// k times the product of gradients, plus c times the product of values.
template <int d>
[[nodiscard]] BilinearForm<d> scalar_form(double k, double c) {
    BilinearForm<d> form;
    form.has_value = c != 0.0;
    form.coefficients = [k, c](int, const Vector3&, double* A) {
        for (int s = 0; s < d; ++s) {
            A[s * (d + 1) + s] = k;
        }
        A[d * (d + 1) + d] = c;
    };
    return form;
}

}  // namespace couture::iga
