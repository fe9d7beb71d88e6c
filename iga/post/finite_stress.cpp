#include "iga/post/finite_stress.h"

#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/field_grid.h"
#include "iga/assembly/linear_form.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/mechanics/kinematics.h"

namespace couture::iga {

namespace {

Vector<6> to_voigt(const Matrix<3>& tensor, double shear_factor) {
    Vector<6> v;
    v << tensor(0, 0), tensor(1, 1), tensor(2, 2), shear_factor * tensor(1, 2),
        shear_factor * tensor(0, 2), shear_factor * tensor(0, 1);
    return v;
}

/// @param P  first Piola stress
FiniteState make_state(const Matrix<3>& H, const Matrix<3>& P) {
    const Matrix<3> E = 0.5 * (H + H.transpose() + H.transpose() * H);
    return {H, 1.0 + volume_change(H), {to_voigt(E, 2.0), to_voigt(cauchy_stress(P, H), 1.0)}};
}

/// Cells of the Gauss points of each element of a patch, whose first point is `first`.
template <int d>
void append_cells(const GeometryGrid<d>& grid, int first, std::vector<std::vector<int>>& cells) {
    std::array<int, 3> n_points{1, 1, 1};
    std::array<int, 3> per_element{2, 2, 2};
    for (int k = 0; k < d; ++k) {
        n_points[k] = grid.line(k).n_points();
        per_element[k] = grid.line(k).points_per_element;
    }
    const auto number = [&](int i, int j, int k) {
        return first + i + n_points[0] * (j + n_points[1] * k);
    };
    // The last point of an element and the first of the next make no cell.
    const auto is_cell = [&](int direction, int i) {
        return i + 1 < n_points[direction] && (i + 1) % per_element[direction] != 0;
    };
    for (int k = 0; k < n_points[2]; ++k) {
        for (int j = 0; j < n_points[1]; ++j) {
            for (int i = 0; i < n_points[0]; ++i) {
                if (!is_cell(0, i) || !is_cell(1, j) || (d == 3 && !is_cell(2, k))) {
                    continue;
                }
                std::vector<int> cell;
                for (int up = 0; up < d - 1; ++up) {
                    for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                        cell.push_back(number(i + a, j + b, k + up));
                    }
                }
                cells.push_back(std::move(cell));
            }
        }
    }
}

}  // namespace

FiniteFields FiniteFields::from(const MatrixX& coefficients) {
    return {coefficients.leftCols(6), coefficients.middleCols(6, 6), coefficients.rightCols(1)};
}

template <int d>
FiniteStresses<d>::FiniteStresses(const Problem& problem, const SteppingState<d>& state,
                                  std::optional<int> n_gauss_points, Volumetric volumetric)
    : problem_(problem),
      reference_(state.reference),
      undeformed_(state.reference->undeformed()),
      displacement_(state.displacement.size() > 0 ? state.displacement
                                                  : MatrixX::Zero(undeformed_->n_dofs(), d)),
      n_gauss_points_(n_gauss_points),
      body_(state.reference, problem, n_gauss_points, volumetric) {
    static_cast<void>(body_.deform(displacement_));
}

template <int d>
FiniteState FiniteStresses<d>::at(int patch, const Vector<d>& xi) const {
    const Matrix<3> H =
        total_displacement_gradient<d>(*reference_, problem_.kinematics, displacement_, patch, xi);
    return make_state(H, body_.piola_at(patch, xi, H));
}

template <int d>
MatrixX FiniteStresses<d>::integrals() const {
    constexpr int n_columns = 13;
    LinearForm<d> form;
    form.n_components = n_columns;
    form.coefficients = [&](int patch, const GeometryGrid<d>&, int i_plane,
                            const GeometryPlane<d>& plane, double* b) {
        for (int q = 0; q < plane.n_points; ++q) {
            const FiniteState here = make_state(body_.displacement_gradient(patch, i_plane, q),
                                                body_.piola(patch, i_plane, q));
            Vector<n_columns> row;
            row << here.state.stress, here.state.strain, here.det_F;
            for (int i = 0; i < n_columns; ++i) {
                b[(static_cast<std::size_t>(q) * n_columns + i) * (d + 1) + d] = row[i];
            }
        }
    };
    return integrate(*undeformed_, form, {}, n_gauss_points_);
}

template <int d>
FiniteFields FiniteStresses<d>::project() const {
    const MatrixX rhs = integrals();
    const BlockMatrix mass = assemble(*undeformed_, scalar_form<d>(0.0, 1.0));
    const std::unique_ptr<LinearSolver> solver = make_linear_solver({});
    solver->factorize({mass, {}, {}});
    MatrixX result;
    (void)solver->solve(rhs, result);
    return FiniteFields::from(result);
}

template <int d>
FiniteGaussPoints FiniteStresses<d>::at_gauss_points() const {
    const Field<d> field{undeformed_, displacement_};
    std::vector<VectorX> rows;
    FiniteGaussPoints result;
    for (int p = 0; p < undeformed_->n_patches(); ++p) {
        const GeometryGrid<d> grid(undeformed_->geometry().patches[p], undeformed_->tensor(p),
                                   gauss_points<d>(undeformed_->tensor(p), n_gauss_points_));
        append_cells<d>(grid, static_cast<int>(rows.size()), result.cells);
        FieldGrid<d> values(field, p, grid);
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            values.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const FiniteState here =
                    make_state(body_.displacement_gradient(p, i, q), body_.piola(p, i, q));
                Vector3 u = Vector3::Zero();
                u.head<d>() = values.value(q);
                VectorX row(19);
                row << plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2], u, here.state.stress,
                    here.state.strain, here.det_F;
                rows.push_back(std::move(row));
            }
        }
    }
    MatrixX all(rows.size(), 19);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        all.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
    }
    result.points = all.leftCols(3);
    result.displacement = all.middleCols(3, 3);
    result.stress = all.middleCols(6, 6);
    result.strain = all.middleCols(12, 6);
    result.det_F = all.rightCols(1);
    return result;
}

template <int d>
double FiniteStresses<d>::volume() const {
    double sum = 0.0;
    for (int p = 0; p < undeformed_->n_patches(); ++p) {
        const GeometryGrid<d> grid(undeformed_->geometry().patches[p], undeformed_->tensor(p),
                                   gauss_points<d>(undeformed_->tensor(p), n_gauss_points_));
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                sum += plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                       measure(problem_.kinematics, problem_.thickness, x) *
                       (1.0 + volume_change(body_.displacement_gradient(p, i, q)));
            }
        }
    }
    return sum;
}

template class FiniteStresses<2>;
template class FiniteStresses<3>;

}  // namespace couture::iga
