#include "rom/field_sampler.h"

#include <algorithm>

#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/mechanics/kinematics.h"
#include "rom/grid_kernel.h"
#include "rom/stress_law.h"

namespace couture::rom {

namespace {

void check_grid(const iga::Space<3>& space, const SampleGrid& grid) {
    if (grid.patch < 0 || grid.patch >= space.n_patches()) {
        throw InputError("FieldSampler: a grid of patch {}; there are {}", grid.patch,
                         space.n_patches());
    }
    for (int k = 0; k < 3; ++k) {
        const iga::KnotVector& knots = space.tensor(grid.patch).knots[k];
        const std::vector<double>& line = grid.parameters[k];
        if (line.empty() || !std::is_sorted(line.begin(), line.end()) ||
            !(line.front() >= knots.front() && line.back() <= knots.back())) {
            throw InputError(
                "FieldSampler: patch {} direction {}: {} parameters from {} to {}; expected at "
                "least one, rising, in [{}, {}]",
                grid.patch, k, line.size(), line.empty() ? 0.0 : line.front(),
                line.empty() ? 0.0 : line.back(), knots.front(), knots.back());
        }
    }
}

using StressLanes = std::array<Lanes, 6>;

StressLanes linear_stress(const iga::ElasticStiffness& stiffness, const std::array<Lanes, 9>& H) {
    const StressLanes strain = {H[0], H[4], H[8], H[5] + H[7], H[2] + H[6], H[1] + H[3]};
    StressLanes stress{};
    for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) {
            stress[a] += stiffness(a, b) * strain[b];
        }
    }
    return stress;
}

/// Square of the von Mises stress.
Lanes squared_von_mises(const StressLanes& s) {
    const Lanes a = s[0] - s[1];
    const Lanes b = s[1] - s[2];
    const Lanes c = s[2] - s[0];
    return 0.5 * (a * a + b * b + c * c) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
}

/// Stresses of one patch's points.
class PointStress {
  public:
    PointStress(const iga::Problem& problem, const std::string& load_case, int patch,
                int i_material)
        : problem_(problem),
          load_case_(load_case),
          patch_(patch),
          material_(problem.materials[i_material]),
          is_linear_(!material_.hyperelastic && problem.temperatures.empty()) {}

    [[nodiscard]] StressLanes operator()(const PointLanes& point) const {
        if (is_linear_) {
            return linear_stress(material_.stiffness, point.H);
        }
        StressLanes stress;
        for (int lane = 0; lane < n_lanes; ++lane) {
            Matrix<3> H;
            for (int i = 0; i < 9; ++i) {
                H(i / 3, i % 3) = point.H[i][lane];
            }
            const Vector3 x(point.x[0][lane], point.x[1][lane], point.x[2][lane]);
            const Vector<6> s =
                StressLaw(material_, H,
                          iga::thermal_strain(problem_, material_, patch_, load_case_, x))
                    .stress();
            for (int a = 0; a < 6; ++a) {
                stress[a][lane] = s[a];
            }
        }
        return stress;
    }

  private:
    const iga::Problem& problem_;
    const std::string& load_case_;
    int patch_;
    const iga::Material& material_;
    bool is_linear_;
};

void sample_grid(const GridKernel& kernel, const VectorX& control_points,
                 const VectorX& displacement, const PointStress& stress_at, int first_point,
                 FieldSamples& samples) {
    double* X = samples.points.data() + 3 * static_cast<Eigen::Index>(first_point);
    double* U = samples.displacements.data() + 3 * static_cast<Eigen::Index>(first_point);
    double* S = samples.stresses.data() + 6 * static_cast<Eigen::Index>(first_point);
    double* squares = samples.von_mises.data() + first_point;
    kernel.visit(control_points.data(), displacement.data(),
                 [&](int first, int stride, int count, const PointLanes& point) {
                     const StressLanes stress = stress_at(point);
                     const Lanes square = squared_von_mises(stress);
                     for (int lane = 0; lane < count; ++lane) {
                         const auto i = static_cast<Eigen::Index>(first) + lane * stride;
                         for (int c = 0; c < 3; ++c) {
                             X[3 * i + c] = point.x[c][lane];
                             U[3 * i + c] = point.u[c][lane];
                         }
                         for (int a = 0; a < 6; ++a) {
                             S[6 * i + a] = stress[a][lane];
                         }
                         squares[i] = square[lane];
                     }
                 });
}

}  // namespace

FieldSampler::FieldSampler(iga::SpacePtr<3> space, std::vector<SampleGrid> grids)
    : space_(std::move(space)), grids_(std::move(grids)), first_points_{0} {
    for (const SampleGrid& grid : grids_) {
        check_grid(*space_, grid);
        kernels_.emplace_back(*space_, grid);
        first_points_.push_back(first_points_.back() + grid.n_points());
    }
}

FieldSampler::~FieldSampler() = default;
FieldSampler::FieldSampler(FieldSampler&&) noexcept = default;
FieldSampler& FieldSampler::operator=(FieldSampler&&) noexcept = default;

FieldSamples FieldSampler::sample(const VectorX& control_points, const VectorX& displacement,
                                  const iga::Problem& problem, const std::string& load_case) const {
    const Eigen::Index n_values = 3 * static_cast<Eigen::Index>(space_->n_dofs());
    if (control_points.size() != n_values || displacement.size() != n_values) {
        throw InputError(
            "FieldSampler: {} numbers for control points and {} for the displacement; expected 3 "
            "for each of {} nodes",
            control_points.size(), displacement.size(), space_->n_dofs());
    }
    if (problem.physics != iga::Physics::elasticity ||
        problem.kinematics != iga::Kinematics::solid) {
        throw InputError("FieldSampler: the problem is no elastic solid; only these have stresses");
    }
    const std::vector<int> materials = iga::materials_of_patches(problem, space_->n_patches());
    const int n = n_points();
    FieldSamples samples{MatrixX(3, n), MatrixX(3, n), MatrixX(6, n), VectorX(n)};
    parallel_for(static_cast<int>(grids_.size()), [&](int i) {
        const int patch = kernels_[i].patch();
        sample_grid(kernels_[i], control_points, displacement,
                    PointStress(problem, load_case, patch, materials[patch]), first_points_[i],
                    samples);
    });
    samples.von_mises = samples.von_mises.cwiseSqrt();
    return samples;
}

}  // namespace couture::rom
