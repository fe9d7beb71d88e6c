#include "rom/stress_gradient.h"

#include <Eigen/LU>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/mechanics/kinematics.h"
#include "iga/post/stress.h"
#include "rom/stress_law.h"

namespace couture::rom {

namespace {

/// Rows of the patch's functions, functions x 3. @param field  3 n_nodes numbers
Eigen::Matrix<double, Eigen::Dynamic, 3> rows_of(const Eigen::Ref<const VectorX>& field,
                                                 const std::vector<int>& dofs,
                                                 const std::vector<int>& functions) {
    Eigen::Matrix<double, Eigen::Dynamic, 3> rows(functions.size(), 3);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        rows.row(static_cast<Eigen::Index>(i)) =
            field.segment<3>(3 * static_cast<Eigen::Index>(dofs[functions[i]])).transpose();
    }
    return rows;
}

void check(const ReducedModel& model, const iga::Problem& problem, int patch,
           std::size_t n_slopes) {
    if (patch < 0 || patch >= model.space()->n_patches()) {
        throw InputError("stress_gradient: patch {} does not exist; there are {}", patch,
                         model.space()->n_patches());
    }
    if (problem.physics != iga::Physics::elasticity ||
        problem.kinematics != iga::Kinematics::solid || !problem.temperatures.empty()) {
        throw InputError(
            "stress_gradient: the problem must be an elastic solid without temperatures");
    }
    if (n_slopes != 0 && n_slopes != static_cast<std::size_t>(model.parameters().size())) {
        throw InputError("stress_gradient: {} slopes of the stiffness for {} parameters", n_slopes,
                         model.parameters().size());
    }
}

}  // namespace

StressGradient stress_gradient(const ReducedModel& model, const Evaluation& evaluation,
                               const EvaluationGradient& gradient, const iga::Problem& problem,
                               const std::vector<iga::ElasticStiffness>& stiffness_slopes,
                               int patch, const Vector3& xi) {
    check(model, problem, patch, stiffness_slopes.size());
    const iga::Space<3>& space = *model.space();
    const iga::Material& material =
        problem.materials[iga::materials_of_patches(problem, space.n_patches())[patch]];
    if (material.hyperelastic && !stiffness_slopes.empty()) {
        throw InputError(
            "stress_gradient: material '{}' is hyperelastic; slopes of a stiffness are for linear "
            "elastic ones",
            material.name);
    }
    const iga::PointBasis<3> basis =
        iga::evaluate_basis(space.tensor(patch), space.weights(patch), xi);
    const auto rows = [&](const auto& field) {
        return rows_of(field, space.dofs(patch), basis.functions);
    };
    const auto X = rows(evaluation.control_points);
    const auto U = rows(evaluation.displacement);
    const Matrix<3> J = X.transpose() * basis.gradients;
    const double scale = J.col(0).norm() * J.col(1).norm() * J.col(2).norm();
    if (!(std::abs(J.determinant()) > 1e-12 * scale)) {
        throw GeometryError(
            "patch {}: the predicted map is singular (det J = {:.3g}) at parameter {}; take a "
            "point "
            "beside it",
            patch, J.determinant(), format_point(xi));
    }
    const Matrix<3> J_inverse = J.inverse();
    const Matrix<3> H = U.transpose() * basis.gradients * J_inverse;
    const StressLaw law(material, H, Vector<6>::Zero());

    const int n = model.parameters().size();
    StressGradient result;
    result.position = X.transpose() * basis.values;
    result.stress = law.stress();
    result.von_mises = iga::von_mises(result.stress);
    result.position_gradient.resize(3, n);
    result.stress_gradient.resize(6, n);
    for (int p = 0; p < n; ++p) {
        const auto dX = rows(gradient.control_points.col(p));
        const auto dU = rows(gradient.displacement.col(p));
        const Matrix<3> dJ = dX.transpose() * basis.gradients;
        const Matrix<3> dH = (dU.transpose() * basis.gradients - H * dJ) * J_inverse;
        result.position_gradient.col(p) = dX.transpose() * basis.values;
        result.stress_gradient.col(p) = law.change(dH);
        if (!stiffness_slopes.empty()) {
            result.stress_gradient.col(p) += stiffness_slopes[p] * small_strain(H);
        }
    }
    result.von_mises_gradient =
        result.stress_gradient.transpose() * von_mises_slopes(result.stress);
    return result;
}

}  // namespace couture::rom
