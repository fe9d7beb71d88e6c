#include "rom/galerkin_newton.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/solve/equilibrium.h"
#include "iga/solve/static_system.h"

namespace couture::rom {

namespace {

/// A body under its loads, with its held unknowns.
class ProjectedBody {
  public:
    ProjectedBody(const iga::SpacePtr<3>& space, const iga::Problem& problem,
                  const GalerkinNewtonOptions& options)
        : body_(iga::make_reference<3>(space), problem, options.end, options.n_gauss_points,
                options.volumetric, {}),
          loads_(body_.loads_at(options.end)) {}

    /// Displacement as unknowns; held ones as prescribed.
    [[nodiscard]] VectorX unknowns(const VectorX& displacement) const {
        MatrixX u = displacement;
        constraints().to_frames(u);
        for (Eigen::Index i = 0; i < u.rows(); ++i) {
            if (constraints().is_fixed[i] != 0) {
                u(i, 0) = constraints().values(i, 0);
            }
        }
        return u;
    }
    [[nodiscard]] MatrixX free_modes(MatrixX modes) const {
        constraints().to_frames(modes);
        return free_part(std::move(modes));
    }
    [[nodiscard]] VectorX displacement(const VectorX& unknowns) const {
        MatrixX u = unknowns;
        constraints().to_global(u);
        return u.col(0);
    }

    void move_to(const VectorX& unknowns, const char* when) {
        if (!body_.move_to(loads_, unknowns)) {
            const iga::SmallestVolume<3>& smallest = body_.smallest_volume();
            throw SolverError(
                "Newton's step: the body is folded {} (det F = {:.3g} in patch {} at {}); take "
                "more modes or snapshots, or solve in full",
                when, smallest.det_F, smallest.patch, format_point(smallest.xi));
        }
    }
    /// Of the free unknowns.
    [[nodiscard]] VectorX residual() const { return free_part(body_.residual()); }
    [[nodiscard]] double force_scale() const {
        return std::max({body_.internal_forces().norm(), body_.external_forces().norm(), 1e-300});
    }
    [[nodiscard]] double energy() const { return body_.energy(); }
    void linearize() { body_.linearize(loads_); }
    [[nodiscard]] MatrixX tangent_times(const MatrixX& u) const { return body_.apply(u); }

  private:
    [[nodiscard]] const iga::Constraints<3>& constraints() const { return loads_.constraints; }
    [[nodiscard]] MatrixX free_part(MatrixX u) const {
        for (Eigen::Index i = 0; i < u.rows(); ++i) {
            if (constraints().is_fixed[i] != 0) {
                u.row(i).setZero();
            }
        }
        return u;
    }

    iga::Equilibrium<3> body_;
    iga::LoadState<3> loads_;
};

}  // namespace

GalerkinSolution galerkin_newton_step(const ReducedModel& model, const Evaluation& evaluation,
                                      const iga::Problem& problem,
                                      const GalerkinNewtonOptions& options) {
    const auto space = std::make_shared<const iga::Space<3>>(model.member(evaluation));
    ProjectedBody body(space, problem, options);
    const VectorX start = body.unknowns(evaluation.displacement);
    body.move_to(start, "as predicted");
    body.linearize();
    const VectorX residual = body.residual();
    GalerkinSolution solution;
    solution.relative_residual_of_kriging = residual.norm() / body.force_scale();

    // Columns of one length: modes that depend on each other show in the pivots.
    MatrixX V = body.free_modes(model.displacement_modes());
    const VectorX lengths = V.colwise().norm().cwiseMax(1e-300);
    V *= lengths.cwiseInverse().asDiagonal();
    const MatrixX KV = body.tangent_times(V);
    Eigen::ColPivHouseholderQR<MatrixX> projected(V.transpose() * KV);
    constexpr double rounding = 1e-12;
    projected.setThreshold(rounding);
    const VectorX a = projected.solve(-V.transpose() * residual);
    solution.n_modes = static_cast<int>(projected.rank());

    const VectorX end = start + V * a;
    const auto energy_norm = [&](const VectorX& v) {
        return std::sqrt(std::abs(v.dot(body.tangent_times(v).col(0))));
    };
    solution.relative_change = energy_norm(end - start) / std::max(energy_norm(end), 1e-300);
    body.move_to(end, "after the step");
    solution.displacement = body.displacement(end);
    solution.relative_residual = body.residual().norm() / body.force_scale();
    solution.energy = body.energy();
    return solution;
}

}  // namespace couture::rom
