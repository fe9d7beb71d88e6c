#include "rom/gradient_sampler.h"

#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/mechanics/kinematics.h"
#include "iga/post/stress.h"
#include "rom/grid_kernel.h"
#include "rom/stress_law.h"

namespace couture::rom {

namespace {

/// Position, displacement (or their changes) and gradient at each point of a grid.
struct PointFields {
    MatrixX x;  ///< 3 x n_points
    MatrixX u;
    MatrixX H;  ///< 9 x n_points, du_i / dx_j at 3 i + j

    [[nodiscard]] Matrix<3> gradient(Eigen::Index i) const {
        return H.col(i).reshaped(3, 3).transpose();
    }
};

PointFields fields_at(const GridKernel& kernel, int n_points, const double* control_points,
                      const double* displacement) {
    PointFields fields{MatrixX(3, n_points), MatrixX(3, n_points), MatrixX(9, n_points)};
    kernel.visit(control_points, displacement,
                 [&](int first, int stride, int count, const PointLanes& point) {
                     for (int lane = 0; lane < count; ++lane) {
                         const auto i = static_cast<Eigen::Index>(first) + lane * stride;
                         for (int c = 0; c < 3; ++c) {
                             fields.x(c, i) = point.x[c][lane];
                             fields.u(c, i) = point.u[c][lane];
                         }
                         for (int c = 0; c < 9; ++c) {
                             fields.H(c, i) = point.H[c][lane];
                         }
                     }
                 });
    return fields;
}

/// Stress of a patch's points in a problem.
class PatchStress {
  public:
    PatchStress(const iga::Problem& problem, int patch, int i_material)
        : problem_(problem), patch_(patch), material_(problem.materials[i_material]) {}

    [[nodiscard]] StressLaw at(const Vector3& x, const Matrix<3>& H) const {
        return {material_, H,
                problem_.temperatures.empty()
                    ? Vector<6>(Vector<6>::Zero())
                    : iga::thermal_strain(problem_, material_, patch_, "", x)};
    }

  private:
    const iga::Problem& problem_;
    int patch_;
    const iga::Material& material_;
};

}  // namespace

GradientSampler::GradientSampler(iga::SpacePtr<3> space, const std::vector<SampleGrid>& grids)
    : space_(std::move(space)), first_points_{0} {
    for (const SampleGrid& grid : grids) {
        kernels_.emplace_back(*space_, grid);
        first_points_.push_back(first_points_.back() + grid.n_points());
    }
}

GradientSampler::~GradientSampler() = default;
GradientSampler::GradientSampler(GradientSampler&&) noexcept = default;
GradientSampler& GradientSampler::operator=(GradientSampler&&) noexcept = default;

SampleGradients GradientSampler::sample(const Evaluation& evaluation,
                                        const EvaluationGradient& gradient,
                                        const iga::Problem& problem,
                                        const std::vector<std::optional<ProblemChange>>& changes,
                                        const std::vector<int>& columns) const {
    const Eigen::Index n_parameters = evaluation.point.size();
    if (static_cast<Eigen::Index>(changes.size()) != n_parameters) {
        throw InputError("GradientSampler: {} changes of the problem for {} parameters",
                         changes.size(), n_parameters);
    }
    if (problem.physics != iga::Physics::elasticity ||
        problem.kinematics != iga::Kinematics::solid) {
        throw InputError("GradientSampler: the problem is no elastic solid");
    }
    const std::vector<int> materials = iga::materials_of_patches(problem, space_->n_patches());
    SampleGradients result{VectorX(n_points()), MatrixX::Zero(n_points(), n_parameters),
                           VectorX(n_points()), MatrixX::Zero(n_points(), n_parameters)};
    const double* X = evaluation.control_points.data();
    parallel_for(static_cast<int>(kernels_.size()), [&](int g) {
        const GridKernel& kernel = kernels_[g];
        const int patch = kernel.patch();
        const int first = first_points_[g];
        const int n = first_points_[g + 1] - first;
        const PointFields fields = fields_at(kernel, n, X, evaluation.displacement.data());
        const PatchStress stress(problem, patch, materials[patch]);
        std::vector<StressLaw> laws;
        laws.reserve(n);
        MatrixX slopes(6, n);
        for (int i = 0; i < n; ++i) {
            laws.push_back(stress.at(fields.x.col(i), fields.gradient(i)));
            slopes.col(i) = von_mises_slopes(laws[i].stress());
            result.von_mises[first + i] = iga::von_mises(laws[i].stress());
            result.displacement[first + i] = fields.u.col(i).norm();
        }
        for (const int p : columns) {
            const PointFields dx = fields_at(kernel, n, X, gradient.control_points.col(p).data());
            const PointFields du = fields_at(kernel, n, X, gradient.displacement.col(p).data());
            for (int i = 0; i < n; ++i) {
                const Matrix<3> H = fields.gradient(i);
                const Matrix<3> dH = du.gradient(i) - H * dx.gradient(i);
                Vector<6> change = laws[i].change(dH);
                if (changes[p]) {
                    const double h = changes[p]->step;
                    const Vector3 x = fields.x.col(i);
                    const Vector3 shift = h * dx.u.col(i);
                    const PatchStress above(changes[p]->above, patch, materials[patch]);
                    const PatchStress below(changes[p]->below, patch, materials[patch]);
                    change += (above.at(x + shift, H).stress() - below.at(x - shift, H).stress()) /
                              (2.0 * h);
                }
                result.von_mises_gradient(first + i, p) = slopes.col(i).dot(change);
                const double length = result.displacement[first + i];
                if (length > 0.0) {
                    result.displacement_gradient(first + i, p) =
                        fields.u.col(i).dot(du.u.col(i)) / length;
                }
            }
        }
    });
    return result;
}

}  // namespace couture::rom
