#include "verification/manufactured/wave.h"

#include <cmath>

#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double youngs_modulus = 10.0;
constexpr double poissons_ratio = 0.3;
constexpr double conductivity = 2.0;

constexpr double shear_modulus = 3.0;
constexpr double bulk_modulus = 20.0;

double argument(const PlaneWave& wave, const Vector3& x) {
    return wave.direction.dot(x) + wave.phase;
}

/// Gives a problem the body force, and the waves' first components on the set "outer".
void drive(Problem& problem, const WaveSolution& solution, int n_components,
           const std::function<Vector3(const Vector3& x)>& load) {
    Support support;
    support.on = "outer";
    BodyForce force;
    for (int a = 0; a < 3; ++a) {
        force.components[a] = [load, a](const Vector3& x, double) { return load(x)[a]; };
        if (a < n_components) {
            support.components[a] = [solution, a](const Vector3& x, double) {
                return solution.value(x)[a];
            };
        }
    }
    problem.supports = {support};
    problem.body_forces = {force};
}

}  // namespace

Vector3 WaveSolution::value(const Vector3& x) const {
    Vector3 sum = Vector3::Zero();
    for (const PlaneWave& wave : waves) {
        sum += wave.amplitude * profile(argument(wave, x), 0);
    }
    return sum;
}

Matrix<3> WaveSolution::gradient(const Vector3& x) const {
    Matrix<3> sum = Matrix<3>::Zero();
    for (const PlaneWave& wave : waves) {
        sum += wave.amplitude * wave.direction.transpose() * profile(argument(wave, x), 1);
    }
    return sum;
}

template <int d>
ExactSolution<d> WaveSolution::exact(int n_components) const {
    return {
        [*this, n_components](const Vector3& x) -> VectorX { return value(x).head(n_components); },
        [*this, n_components](const Vector3& x) -> MatrixX {
            return gradient(x).topLeftCorner(n_components, d);
        }};
}

template <int d>
Problem wave_problem(const WaveSolution& solution, Physics physics) {
    const double lambda =
        youngs_modulus * poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
    const double mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
    // Of one wave: -div stress = -((lambda + mu) (a . A) a + mu |a|^2 A) f''.
    const auto load = [=](const Vector3& x) -> Vector3 {
        Vector3 sum = Vector3::Zero();
        for (const PlaneWave& wave : solution.waves) {
            const Vector3& a = wave.direction;
            const Vector3& A = wave.amplitude;
            const Vector3 divergence =
                physics == Physics::poisson
                    ? Vector3(conductivity * a.squaredNorm() * A)
                    : Vector3((lambda + mu) * a.dot(A) * a + mu * a.squaredNorm() * A);
            sum -= divergence * solution.profile(argument(wave, x), 2);
        }
        return sum;
    };
    Problem problem;
    problem.physics = physics;
    if (d == 2) {
        problem.kinematics = Kinematics::plane_strain;
    }
    problem.materials = {make_isotropic("solid", youngs_modulus, poissons_ratio)};
    problem.materials[0].conductivity = conductivity;
    drive(problem, solution, physics == Physics::poisson ? 1 : d, load);
    return problem;
}

template <int d>
Problem neo_hookean_wave_problem(const WaveSolution& solution) {
    Problem problem = neo_hookean_problem(d == 2 ? Kinematics::plane_strain : Kinematics::solid,
                                          shear_modulus, bulk_modulus);
    const Hyperelastic material = *problem.materials[0].hyperelastic;
    drive(problem, solution, d, [=](const Vector3& x) -> Vector3 {
        const Matrix<9> A = piola_tangent(material, solution.gradient(x));
        Vector3 sum = Vector3::Zero();
        for (const PlaneWave& wave : solution.waves) {
            // Entry 3 k + L of A's columns meets amplitude_k direction_L.
            const Matrix<3> outer = wave.direction * wave.amplitude.transpose();
            const Vector<9> dP = A * outer.reshaped();
            sum -= dP.reshaped<Eigen::RowMajor>(3, 3) * wave.direction *
                   solution.profile(argument(wave, x), 2);
        }
        return sum;
    });
    return problem;
}

Profile power(int degree) {
    return [degree](double s, int derivative) {
        if (degree < derivative) {
            return 0.0;
        }
        double factor = 1.0;
        for (int k = 0; k < derivative; ++k) {
            factor *= degree - k;
        }
        return factor * std::pow(1.0 + s, degree - derivative);
    };
}

Profile sine() {
    return [](double s, int derivative) {
        const double sign = derivative < 2 ? 1.0 : -1.0;
        return sign * (derivative % 2 == 0 ? std::sin(s) : std::cos(s));
    };
}

template ExactSolution<2> WaveSolution::exact<2>(int) const;
template ExactSolution<3> WaveSolution::exact<3>(int) const;
template Problem wave_problem<2>(const WaveSolution&, Physics);
template Problem wave_problem<3>(const WaveSolution&, Physics);
template Problem neo_hookean_wave_problem<2>(const WaveSolution&);
template Problem neo_hookean_wave_problem<3>(const WaveSolution&);

}  // namespace couture::verification
