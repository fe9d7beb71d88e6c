#include "rom/stress_gradient.h"

#include <Eigen/LU>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/mechanics/kinematics.h"
#include "iga/post/stress.h"

namespace couture::rom {

namespace {

Vector<6> to_strain(const Matrix<3>& H) {
    return (Vector<6>() << H(0, 0), H(1, 1), H(2, 2), H(1, 2) + H(2, 1), H(0, 2) + H(2, 0),
            H(0, 1) + H(1, 0))
        .finished();
}

Vector<6> to_voigt(const Matrix<3>& s) {
    return (Vector<6>() << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)).finished();
}

/// Stress at a displacement gradient, and its change with that gradient.
class StressLaw {
  public:
    StressLaw(const iga::Material& material, const Matrix<3>& H) : material_(material), H_(H) {
        if (!material.hyperelastic) {
            stress_ = material.stiffness * to_strain(H);
            return;
        }
        F_ += H;
        P_ = iga::piola_stress(*material.hyperelastic, H);
        tangent_ = iga::piola_tangent(*material.hyperelastic, H);
        sigma_ = iga::cauchy_stress(P_, H);
        stress_ = to_voigt(sigma_);
    }

    [[nodiscard]] const Vector<6>& stress() const { return stress_; }

    [[nodiscard]] Vector<6> change(const Matrix<3>& dH) const {
        if (!material_.hyperelastic) {
            return material_.stiffness * to_strain(dH);
        }
        const Vector<9> flat = dH.transpose().reshaped();
        const Vector<9> dP = tangent_ * flat;
        const Matrix<3> dP_tensor = dP.reshaped(3, 3).transpose();
        const double J = F_.determinant();
        return to_voigt((dP_tensor * F_.transpose() + P_ * dH.transpose()) / J -
                        sigma_ * (F_.inverse() * dH).trace());
    }

  private:
    const iga::Material& material_;
    Matrix<3> H_;
    Matrix<3> F_ = Matrix<3>::Identity();
    Matrix<3> P_ = Matrix<3>::Zero();
    Matrix<3> sigma_ = Matrix<3>::Zero();
    Matrix<9> tangent_ = Matrix<9>::Zero();
    Vector<6> stress_ = Vector<6>::Zero();
};

/// Derivative of the von Mises stress by the stress.
Vector<6> von_mises_slopes(const Vector<6>& s, double von_mises) {
    if (von_mises == 0.0) {
        return Vector<6>::Zero();
    }
    const double mean = (s[0] + s[1] + s[2]) / 3.0;
    Vector<6> slopes = 3.0 * s / von_mises;
    slopes.head<3>() = 1.5 * (s.head<3>().array() - mean) / von_mises;
    return slopes;
}

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
    const StressLaw law(material, H);

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
            result.stress_gradient.col(p) += stiffness_slopes[p] * to_strain(H);
        }
    }
    result.von_mises_gradient =
        result.stress_gradient.transpose() * von_mises_slopes(result.stress, result.von_mises);
    return result;
}

}  // namespace couture::rom
