#include "iga/post/finite_stress.h"

#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/field_grid.h"
#include "iga/assembly/linear_form.h"
#include "iga/core/error.h"
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

/// Row i, column J from nine numbers, entry (i, J) at 3 i + J.
Matrix<3> to_matrix(const VectorX& entries) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries.data());
}

/// The displacement since the reference and, beside it, the reference's own displacement and
/// gradient: columns U - U_b, U_b, F_b - I.
template <int d>
MatrixX columns_of(const SteppingState<d>& state) {
    const ReferenceConfiguration<d>& reference = *state.reference;
    const Eigen::Index n = reference.space->n_dofs();
    const MatrixX U = state.displacement.size() > 0 ? state.displacement : MatrixX::Zero(n, d);
    if (reference.is_undeformed()) {
        return U;
    }
    MatrixX columns(n, 2 * d + 9);
    columns << U - reference.displacement, reference.displacement, reference.gradient;
    return columns;
}

/// F - I from what `columns_of` has at a point of the reference's mesh at x.
template <int d>
Matrix<3> displacement_gradient(const Problem& problem, const Vector3& x, const VectorX& value,
                                const MatrixX& gradient) {
    Matrix<3> H = Matrix<3>::Zero();
    H.topLeftCorner<d, d>() = gradient.topRows<d>();
    if (d == 2 && problem.kinematics == Kinematics::axisymmetric) {
        // On the axis u_r / r tends to du_r / dr.
        H(2, 2) = x[0] > 0.0 ? value[0] / x[0] : gradient(0, 0);
    }
    if (value.size() == d) {
        return H;
    }
    const Matrix<3> H_b = to_matrix(value.tail<9>());
    return H + H_b + H * H_b;
}

FiniteState state_of(const Material& material, const Matrix<3>& H) {
    FiniteState result;
    result.H = H;
    result.det_F = 1.0 + volume_change(H);
    const Matrix<3> E = 0.5 * (H + H.transpose() + H.transpose() * H);
    result.state.strain = to_voigt(E, 2.0);
    if (!material.hyperelastic) {
        throw InputError("[material.{}]: stresses at finite strain need a hyperelastic material",
                         material.name);
    }
    const Matrix<3> P = piola_stress(*material.hyperelastic, H);
    result.state.stress = to_voigt(cauchy_stress(P, H), 1.0);
    return result;
}

/// Calls body(i_point, x, columns at the point, state) for each quadrature point of each plane.
template <int d>
class StateGrid {
  public:
    StateGrid(const Problem& problem, const SteppingState<d>& state)
        : problem_(problem),
          columns_{state.reference->space, columns_of(state)},
          materials_(materials_of_patches(problem, columns_.space->n_patches())) {}

    template <typename Body>
    void visit_plane(int patch, const GeometryGrid<d>& grid, int i_plane,
                     const GeometryPlane<d>& plane, const Body& body) const {
        FieldGrid<d> values(columns_, patch, grid);
        values.evaluate(i_plane, plane);
        const Material& material = problem_.materials[materials_[patch]];
        for (int q = 0; q < plane.n_points; ++q) {
            const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
            const VectorX value = values.value(q);
            const Matrix<3> H = displacement_gradient<d>(problem_, x, value, values.gradient(q));
            body(q, x, value, state_of(material, H));
        }
    }

  private:
    const Problem& problem_;
    Field<d> columns_;
    std::vector<int> materials_;
};

}  // namespace

template <int d>
FiniteState finite_state_at(const Problem& problem, const SteppingState<d>& state, int patch,
                            const Vector<d>& xi) {
    const Field<d> columns{state.reference->space, columns_of(state)};
    const std::vector<int> materials = materials_of_patches(problem, columns.space->n_patches());
    Vector3 x = Vector3::Zero();
    x.head<d>() = columns.space->geometry().patches[patch].point(xi);
    const Matrix<3> H =
        displacement_gradient<d>(problem, x, columns.value(patch, xi), columns.gradient(patch, xi));
    return state_of(problem.materials[materials[patch]], H);
}

template <int d>
FiniteFields project_finite_state(const Problem& problem, const SteppingState<d>& state) {
    constexpr int n_columns = 13;
    const Space<d>& space = *state.reference->space;
    const StateGrid<d> states(problem, state);
    LinearForm<d> form;
    form.n_components = n_columns;
    form.coefficients = [&](int patch, const GeometryGrid<d>& grid, int i_plane,
                            const GeometryPlane<d>& plane, double* b) {
        states.visit_plane(patch, grid, i_plane, plane,
                           [&](int q, const Vector3&, const VectorX&, const FiniteState& here) {
                               Vector<n_columns> row;
                               row << here.state.stress, here.state.strain, here.det_F;
                               for (int i = 0; i < n_columns; ++i) {
                                   b[(static_cast<std::size_t>(q) * n_columns + i) * (d + 1) + d] =
                                       row[i];
                               }
                           });
    };
    const MatrixX rhs = integrate(space, form);
    const BlockMatrix mass = assemble(space, scalar_form<d>(0.0, 1.0));
    const std::unique_ptr<LinearSolver> solver = make_linear_solver({});
    solver->factorize({mass, {}, {}});
    MatrixX result;
    (void)solver->solve(rhs, result);
    return {result.leftCols(6), result.middleCols(6, 6), result.rightCols(1)};
}

namespace {

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

template <int d>
FiniteGaussPoints gauss_point_states(const Problem& problem, const SteppingState<d>& state,
                                     std::optional<int> n_gauss_points) {
    const Space<d>& space = *state.reference->space;
    const StateGrid<d> states(problem, state);
    std::vector<VectorX> rows;
    FiniteGaussPoints result;
    for (int p = 0; p < space.n_patches(); ++p) {
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), n_gauss_points));
        append_cells<d>(grid, static_cast<int>(rows.size()), result.cells);
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            states.visit_plane(
                p, grid, i, plane,
                [&](int, const Vector3& x, const VectorX& value, const FiniteState& here) {
                    Vector3 before = Vector3::Zero();
                    if (value.size() > d) {
                        before.head<d>() = value.segment<d>(d);
                    }
                    Vector3 u = before;
                    u.head<d>() += value.head<d>();
                    VectorX row(19);
                    row << x - before, u, here.state.stress, here.state.strain, here.det_F;
                    rows.push_back(std::move(row));
                });
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
double deformed_volume(const Problem& problem, const SteppingState<d>& state) {
    const SpacePtr<d>& space = state.reference->space;
    // Since the reference only: its mesh is the deformed body of then.
    const Field<d> motion{space, columns_of(state).leftCols(d)};
    double sum = 0.0;
    for (int p = 0; p < space->n_patches(); ++p) {
        const GeometryGrid<d> grid(space->geometry().patches[p], space->tensor(p),
                                   gauss_points<d>(space->tensor(p), {}));
        FieldGrid<d> values(motion, p, grid);
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            values.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                const Matrix<3> H =
                    displacement_gradient<d>(problem, x, values.value(q), values.gradient(q));
                sum += plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                       measure(problem.kinematics, problem.thickness, x) * (1.0 + volume_change(H));
            }
        }
    }
    return sum;
}

#define COUTURE_INSTANTIATE(d)                                                             \
    template FiniteState finite_state_at(const Problem&, const SteppingState<d>&, int,     \
                                         const Vector<d>&);                                \
    template FiniteFields project_finite_state(const Problem&, const SteppingState<d>&);   \
    template FiniteGaussPoints gauss_point_states(const Problem&, const SteppingState<d>&, \
                                                  std::optional<int>);                     \
    template double deformed_volume(const Problem&, const SteppingState<d>&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
