#include "meshing/volume/mean_ratio.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace couture::meshing {

namespace {

/// 3 sqrt(3): |J|^3 over det J of the identity.
const double cube_ratio = 3.0 * std::sqrt(3.0);

}  // namespace

double integer_power(double x, int power) {
    double result = 1.0;
    for (; power > 0; power >>= 1) {
        result *= (power & 1) != 0 ? x : 1.0;
        x *= x;
    }
    return result;
}

double element_size_cubed(const Matrix<3>& J) {
    const double squared = J.squaredNorm() / 3.0;
    return squared * std::sqrt(squared);
}

double inverse_mean_ratio(const Matrix<3>& J, int orientation) {
    const double cubed = element_size_cubed(J);
    return cubed > 0.0 ? orientation * J.determinant() / cubed : 0.0;
}

SampleEnergy sample_energy(const Matrix<3>& J, int orientation, const ShapeMeasure& measure,
                           double size_cubed) {
    const double delta = measure.regularization * size_cubed;
    SampleEnergy result;
    Matrix<3> cofactor;
    cofactor.col(0) = J.col(1).cross(J.col(2));
    cofactor.col(1) = J.col(2).cross(J.col(0));
    cofactor.col(2) = J.col(0).cross(J.col(1));
    const double det = orientation * J.col(0).dot(cofactor.col(0));
    const double root = std::sqrt(det * det + 4.0 * delta * delta);
    // The second form loses no digits for det < 0.
    const double h = delta == 0.0 ? det
                     : det > 0.0  ? 0.5 * (det + root)
                                  : 2.0 * delta * delta / (root - det);
    const double squared = J.squaredNorm();
    if (!(h > 0.0) || !(squared > 0.0)) {
        return result;
    }
    const double mu = squared * std::sqrt(squared) / (cube_ratio * h);
    result.value = integer_power(mu, measure.power);
    // d ln h / d det = 1 / root, with root = det for delta = 0.
    result.by_J =
        measure.power * result.value * (3.0 / squared * J - orientation / root * cofactor);
    if (measure.size_weight > 0.0) {
        const double size_part =
            measure.size_weight * (det * det / size_cubed + size_cubed) / (2.0 * h);
        const double by_det = measure.size_weight * det / (size_cubed * h) - size_part / root;
        result.value += size_part;
        result.by_J += orientation * by_det * cofactor;
    }
    return result;
}

}  // namespace couture::meshing
