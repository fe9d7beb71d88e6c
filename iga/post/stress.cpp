#include "iga/post/stress.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/field_grid.h"
#include "iga/assembly/linear_form.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/mechanics/kinematics.h"

namespace couture::iga {

double von_mises(const Vector<6>& s) {
    const double a = s[0] - s[1];
    const double b = s[1] - s[2];
    const double c = s[2] - s[0];
    return std::sqrt(0.5 * (a * a + b * b + c * c) +
                     3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

Matrix<3> to_tensor(const Vector<6>& s) {
    Matrix<3> tensor;
    tensor << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    return tensor;
}

Vector3 principal_stresses(const Vector<6>& stress) {
    const Eigen::SelfAdjointEigenSolver<Matrix<3>> solver(to_tensor(stress),
                                                          Eigen::EigenvaluesOnly);
    return solver.eigenvalues().reverse();
}

namespace {

/// Strain and stress from the displacement's value and gradient at a place.
template <int d>
StressState state(const Problem& problem, const Material& material, int patch,
                  const std::string& load_case, const Vector3& x, const VectorX& value,
                  const MatrixX& gradient) {
    StressState result{Vector<6>::Zero(), Vector<6>::Zero()};
    if (problem.physics == Physics::poisson) {
        result.strain.head<d>() = gradient.row(0).transpose();
        result.stress.head<d>() = -material.conductivity * gradient.row(0).transpose();
        return result;
    }
    result.strain = total_strain<d>(problem.kinematics, x, gradient, value);
    const Vector<6> thermal = thermal_strain(problem, material, patch, load_case, x);
    if (problem.kinematics == Kinematics::plane_stress) {
        const Vector<6> elastic = result.strain - thermal;
        result.stress = elastic_stress<d>(problem, material, elastic);
        // No stress across the plane: the strains there follow.
        const std::array<int, 3> plane = {0, 1, 5};
        const std::array<int, 3> across = {2, 3, 4};
        const Matrix<3> D_aa = material.stiffness(across, across);
        const Matrix<3> D_ap = material.stiffness(across, plane);
        const Vector3 in_plane = elastic(plane);
        const Vector3 thermal_across = thermal(across);
        result.strain(across) = thermal_across - D_aa.inverse() * (D_ap * in_plane);
        return result;
    }
    result.stress = elastic_stress<d>(problem, material, result.strain - thermal);
    return result;
}

/// Calls body(patch, i_plane, plane, i_point, state) for every quadrature point of a plane.
template <int d>
class StressGrid {
  public:
    StressGrid(const Problem& problem, const Field<d>& displacement, const std::string& load_case)
        : problem_(problem),
          displacement_(displacement),
          load_case_(load_case),
          materials_(materials_of_patches(problem, displacement.space->n_patches())) {}

    template <typename Body>
    void visit_plane(int patch, const GeometryGrid<d>& grid, int i_plane,
                     const GeometryPlane<d>& plane, const Body& body) const {
        FieldGrid<d> values(displacement_, patch, grid);
        values.evaluate(i_plane, plane);
        for (int q = 0; q < plane.n_points; ++q) {
            const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
            body(q, x,
                 state<d>(problem_, problem_.materials[materials_[patch]], patch, load_case_, x,
                          values.value(q), values.gradient(q)));
        }
    }

  private:
    const Problem& problem_;
    const Field<d>& displacement_;
    const std::string& load_case_;
    std::vector<int> materials_;
};

}  // namespace

template <int d>
StressState stress_at(const Problem& problem, const Field<d>& displacement,
                      const std::string& load_case, int patch, const Vector<d>& xi) {
    const std::vector<int> materials =
        materials_of_patches(problem, displacement.space->n_patches());
    Vector3 x = Vector3::Zero();
    x.head<d>() = displacement.space->geometry().patches[patch].point(xi);
    return state<d>(problem, problem.materials[materials[patch]], patch, load_case, x,
                    displacement.value(patch, xi), displacement.gradient(patch, xi));
}

template <int d>
MatrixX stress_integrals(const Problem& problem, const Field<d>& displacement,
                         const std::string& load_case) {
    const StressGrid<d> stresses(problem, displacement, load_case);
    LinearForm<d> form;
    form.n_components = 6;
    form.coefficients = [&](int patch, const GeometryGrid<d>& grid, int i_plane,
                            const GeometryPlane<d>& plane, double* b) {
        stresses.visit_plane(
            patch, grid, i_plane, plane, [&](int q, const Vector3&, const StressState& s) {
                for (int i = 0; i < 6; ++i) {
                    b[(static_cast<std::size_t>(q) * 6 + i) * (d + 1) + d] = s.stress[i];
                }
            });
    };
    return integrate(*displacement.space, form);
}

template <int d>
MatrixX project_stress(const Problem& problem, const Field<d>& displacement,
                       const std::string& load_case) {
    const Space<d>& space = *displacement.space;
    const MatrixX rhs = stress_integrals(problem, displacement, load_case);
    const BlockMatrix mass = assemble(space, scalar_form<d>(0.0, 1.0));
    const std::unique_ptr<LinearSolver> solver = make_linear_solver({});
    solver->factorize({mass, {}, {}});
    MatrixX result;
    (void)solver->solve(rhs, result);
    return result;
}

template <int d>
GaussPointStresses gauss_point_stresses(const Problem& problem, const Field<d>& displacement,
                                        const std::string& load_case) {
    const Space<d>& space = *displacement.space;
    const StressGrid<d> stresses(problem, displacement, load_case);
    std::vector<Vector3> points;
    std::vector<Vector<6>> values;
    for (int p = 0; p < space.n_patches(); ++p) {
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), {}));
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            stresses.visit_plane(p, grid, i, plane,
                                 [&](int, const Vector3& x, const StressState& s) {
                                     points.push_back(x);
                                     values.push_back(s.stress);
                                 });
        }
    }
    GaussPointStresses result{MatrixX(points.size(), 3), MatrixX(values.size(), 6)};
    for (std::size_t i = 0; i < points.size(); ++i) {
        result.points.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
        result.stresses.row(static_cast<Eigen::Index>(i)) = values[i].transpose();
    }
    return result;
}

#define COUTURE_INSTANTIATE(d)                                                               \
    template StressState stress_at(const Problem&, const Field<d>&, const std::string&, int, \
                                   const Vector<d>&);                                        \
    template MatrixX stress_integrals(const Problem&, const Field<d>&, const std::string&);  \
    template MatrixX project_stress(const Problem&, const Field<d>&, const std::string&);    \
    template GaussPointStresses gauss_point_stresses(const Problem&, const Field<d>&,        \
                                                     const std::string&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
