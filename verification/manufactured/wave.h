#pragma once

#include "iga/mechanics/problem.h"
#include "iga/post/norms.h"

namespace couture::verification {

/// A solution u(x) = sum of amplitude f(direction . x + phase) over plane waves, f a function of
/// one variable with two derivatives; the load that it needs follows in closed form.
struct PlaneWave {
    Vector3 amplitude;
    Vector3 direction;
    double phase = 0.0;
};

/// f, f', f''.
using Profile = std::function<double(double s, int derivative)>;

struct WaveSolution {
    Profile profile;
    std::vector<PlaneWave> waves;

    [[nodiscard]] Vector3 value(const Vector3& x) const;
    [[nodiscard]] Matrix<3> gradient(const Vector3& x) const;
    /// For the norms of an error: components x d of it.
    template <int d>
    [[nodiscard]] iga::ExactSolution<d> exact(int n_components) const;
};

/// The problem that the waves solve: their values on the set "outer", and the body force
/// -div stress (Poisson: -k laplace u, of component 0). Elastic problems are solids for d = 3 and
/// in plane strain for d = 2; E = 10, nu = 0.3; k = 2.
template <int d>
[[nodiscard]] iga::Problem wave_problem(const WaveSolution& solution, iga::Physics physics);

/// The same for the body of `StoredEnergy::neo_hookean` with mu = 3, kappa = 20: the body force per
/// undeformed volume is -Div P = -A_iJkL u_k,LJ with the tangent A = dP/dF at the waves' gradient.
template <int d>
[[nodiscard]] iga::Problem neo_hookean_wave_problem(const WaveSolution& solution);

/// Polynomial (1 + s)^degree.
[[nodiscard]] Profile power(int degree);
[[nodiscard]] Profile sine();

}  // namespace couture::verification
