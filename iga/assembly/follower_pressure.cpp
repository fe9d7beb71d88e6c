#include "iga/assembly/follower_pressure.h"

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "iga/assembly/entity_quadrature.h"
#include "iga/mechanics/kinematics.h"

namespace couture::iga {

namespace {

/// v x w = skew(v) w.
Matrix<3> skew(const Vector3& v) {
    Matrix<3> result;
    result << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
    return result;
}

/// Directed area n da per parameter area of the deformed side, and its derivative by the
/// coefficients of function j.
template <int d>
class DeformedArea {
  public:
    DeformedArea(const EntityPoint<d>& point, const Problem& problem, const MatrixX& u)
        : point_(point), tangents_(point.tangents) {
        Vector3 x = point.x;
        for (std::size_t i = 0; i < point.dofs.size(); ++i) {
            for (int a = 0; a < d; ++a) {
                tangents_.row(a) += u(point.dofs[i], a) * point.gradients.row(i);
                x[a] += u(point.dofs[i], a) * point.values[i];
            }
        }
        measure_ = measure(problem.kinematics, problem.thickness, x);
        d_measure_ = problem.kinematics == Kinematics::axisymmetric ? 2.0 * std::numbers::pi : 0.0;
        if constexpr (d == 3) {
            area_ = point.sign * tangents_.col(0).head<3>().cross(tangents_.col(1).head<3>());
        } else {
            area_ = point.sign * Vector3(tangents_(1, 0), -tangents_(0, 0), 0.0);
        }
    }

    [[nodiscard]] Vector3 value() const { return measure_ * area_; }

    [[nodiscard]] Matrix<3> derivative(std::size_t j) const {
        Matrix<3> result = Matrix<3>::Zero();
        if constexpr (d == 3) {
            result = point_.sign * (point_.gradients(j, 1) * skew(tangents_.col(0)) -
                                    point_.gradients(j, 0) * skew(tangents_.col(1)));
        } else {
            result(0, 1) = point_.sign * point_.gradients(j, 0);
            result(1, 0) = -point_.sign * point_.gradients(j, 0);
        }
        result *= measure_;
        result.col(0) += d_measure_ * point_.values[j] * area_;
        return result;
    }

  private:
    const EntityPoint<d>& point_;
    MatrixX tangents_;
    Vector3 area_ = Vector3::Zero();
    double measure_ = 1.0;
    double d_measure_ = 0.0;
};

}  // namespace

template <int d>
FollowerPressure assemble_follower_pressure(const Space<d>& space, const Problem& problem,
                                            const MatrixX& displacement,
                                            std::optional<int> n_gauss_points) {
    FollowerPressure result;
    result.forces = MatrixX::Zero(space.n_dofs(), d);
    std::vector<Eigen::Triplet<double>> entries;
    for (const Pressure& pressure : problem.pressures) {
        if (!pressure.follows_body) {
            continue;
        }
        for (const PatchEntity<d>& side : space.geometry().boundary_set(pressure.on)) {
            for_entity_points<d>(space, side, n_gauss_points, [&](const EntityPoint<d>& point) {
                const DeformedArea<d> area(point, problem, displacement);
                const double p = pressure.value(point.x, 0.0) * point.parameter_weight;
                const Vector3 force = -p * area.value();
                for (std::size_t i = 0; i < point.dofs.size(); ++i) {
                    for (int a = 0; a < d; ++a) {
                        result.forces(point.dofs[i], a) += point.values[i] * force[a];
                    }
                }
                for (std::size_t j = 0; j < point.dofs.size(); ++j) {
                    const Matrix<3> stiffness = p * area.derivative(j);
                    for (std::size_t i = 0; i < point.dofs.size(); ++i) {
                        for (int a = 0; a < d; ++a) {
                            for (int b = 0; b < d; ++b) {
                                entries.emplace_back(d * point.dofs[i] + a, d * point.dofs[j] + b,
                                                     point.values[i] * stiffness(a, b));
                            }
                        }
                    }
                }
            });
        }
    }
    result.stiffness.resize(static_cast<Eigen::Index>(space.n_dofs()) * d,
                            static_cast<Eigen::Index>(space.n_dofs()) * d);
    result.stiffness.setFromTriplets(entries.begin(), entries.end());
    return result;
}

template FollowerPressure assemble_follower_pressure<2>(const Space<2>&, const Problem&,
                                                        const MatrixX&, std::optional<int>);
template FollowerPressure assemble_follower_pressure<3>(const Space<3>&, const Problem&,
                                                        const MatrixX&, std::optional<int>);

}  // namespace couture::iga
