#include "rom/member_volume.h"

#include "iga/core/error.h"
#include "iga/spline/gauss.h"
#include "rom/grid_kernel.h"

namespace couture::rom {

namespace {

struct GaussLine {
    std::vector<double> parameters;
    std::vector<double> weights;
};

GaussLine gauss_line(const iga::KnotVector& knots, bool is_rational) {
    // det J of polynomials has the degree 3 p - 1 in each direction.
    constexpr int n_more = 2;
    const iga::GaussRule& rule =
        iga::gauss_rule((3 * knots.degree() + 1) / 2 + (is_rational ? n_more : 0));
    const std::vector<double>& breakpoints = knots.breakpoints();
    GaussLine line;
    for (std::size_t e = 0; e + 1 < breakpoints.size(); ++e) {
        const double length = breakpoints[e + 1] - breakpoints[e];
        for (std::size_t i = 0; i < rule.points.size(); ++i) {
            line.parameters.push_back(breakpoints[e] + length * rule.points[i]);
            line.weights.push_back(length * rule.weights[i]);
        }
    }
    return line;
}

}  // namespace

MemberVolume::MemberVolume(iga::SpacePtr<3> space) : space_(std::move(space)) {
    for (int p = 0; p < space_->n_patches(); ++p) {
        SampleGrid grid{p, {}};
        std::array<std::vector<double>, 3> weights;
        for (int k = 0; k < 3; ++k) {
            GaussLine line = gauss_line(space_->tensor(p).knots[k], space_->weights(p).size() > 0);
            grid.parameters[k] = std::move(line.parameters);
            weights[k] = std::move(line.weights);
        }
        VectorX products(grid.n_points());
        Eigen::Index i = 0;
        for (const double c : weights[2]) {
            for (const double b : weights[1]) {
                for (const double a : weights[0]) {
                    products[i++] = a * b * c;
                }
            }
        }
        kernels_.emplace_back(*space_, grid);
        weights_.push_back(std::move(products));
    }
}

MemberVolume::~MemberVolume() = default;
MemberVolume::MemberVolume(MemberVolume&&) noexcept = default;
MemberVolume& MemberVolume::operator=(MemberVolume&&) noexcept = default;

void MemberVolume::require_size(const VectorX& control_points) const {
    if (control_points.size() != 3 * static_cast<Eigen::Index>(space_->n_dofs())) {
        throw InputError("MemberVolume: {} numbers for control points; expected 3 for each of {}",
                         control_points.size(), space_->n_dofs());
    }
}

template <typename Integrand>
double MemberVolume::integral(int patch, const double* control_points, const double* field,
                              const Integrand& integrand) const {
    double sum = 0.0;
    kernels_[patch].visit(control_points, field,
                          [&](int first, int stride, int count, const PointLanes& point) {
                              const Lanes values = integrand(point);
                              for (int lane = 0; lane < count; ++lane) {
                                  sum += weights_[patch][first + lane * stride] * values[lane];
                              }
                          });
    return sum;
}

VectorX MemberVolume::values(const VectorX& control_points) const {
    require_size(control_points);
    VectorX volumes(space_->n_patches());
    for (int p = 0; p < volumes.size(); ++p) {
        volumes[p] = integral(p, control_points.data(), control_points.data(),
                              [](const PointLanes& point) { return point.det_J; });
    }
    return volumes;
}

MatrixX MemberVolume::changes(const VectorX& control_points, const MatrixX& changes) const {
    require_size(control_points);
    MatrixX result(space_->n_patches(), changes.cols());
    for (Eigen::Index j = 0; j < changes.cols(); ++j) {
        for (int p = 0; p < result.rows(); ++p) {
            result(p, j) = integral(p, control_points.data(), changes.col(j).data(),
                                    [](const PointLanes& point) {
                                        return point.det_J * (point.H[0] + point.H[4] + point.H[8]);
                                    });
        }
    }
    return result;
}

}  // namespace couture::rom
