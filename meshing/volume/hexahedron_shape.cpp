#include "meshing/volume/hexahedron_shape.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

namespace couture::meshing {

namespace {

/// Corners around each face, so that the normal of the diagonals 0-2 and 1-3 points outwards.
constexpr int face_corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
constexpr double infinity = std::numeric_limits<double>::infinity();

/// x^4, and so on: the power means have exponent 8, a larger one is closer to the extremes, but
/// harder to minimise.
double fourth_power(double x) { return x * x * (x * x); }
double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

struct Face {
    Vector3 to_center;
    Vector3 diagonal_a;
    Vector3 diagonal_b;
    /// Cross product of the diagonals, twice the area vector.
    Vector3 area;
};

Face face_of(const Hexahedron& x, int i, const Vector3& centroid) {
    const int* c = face_corners[i];
    Face face;
    face.to_center = 0.25 * (x.col(c[0]) + x.col(c[1]) + x.col(c[2]) + x.col(c[3])) - centroid;
    face.diagonal_a = x.col(c[2]) - x.col(c[0]);
    face.diagonal_b = x.col(c[3]) - x.col(c[1]);
    face.area = face.diagonal_a.cross(face.diagonal_b);
    return face;
}

}  // namespace

SmoothShapeRatio smooth_shape_ratio(const Hexahedron& corners, int orientation) {
    const Vector3 centroid = corners.rowwise().mean();
    const Hexahedron arms = corners.colwise() - centroid;
    // ln A = ln(mean a^m) / m and ln B = -ln(mean b^-m) / m, scaled by the first arm's length.
    const double scale = arms.colwise().norm().maxCoeff();
    SmoothShapeRatio result;
    result.value = infinity;
    if (!(scale > 0.0)) {
        return result;
    }
    double sum_a = 0.0;
    Hexahedron dA = Hexahedron::Zero();  // by the arms, of sum_a / m
    for (int i = 0; i < 8; ++i) {
        const double squared = arms.col(i).squaredNorm() / (scale * scale);
        const double power = fourth_power(squared);
        sum_a += power;
        if (squared > 0.0) {
            dA.col(i) = power / squared / (scale * scale) * arms.col(i);
        }
    }
    double sum_b = 0.0;
    Hexahedron dB = Hexahedron::Zero();  // of sum_b / m, by corners for a fixed centroid
    Vector3 dB_centroid = Vector3::Zero();
    for (int i = 0; i < 6; ++i) {
        const Face face = face_of(corners, i, centroid);
        const double area = face.area.norm();
        const double b = orientation * face.to_center.dot(face.area) / area / scale;
        if (!(b > 0.0)) {
            return result;
        }
        const double power = 1.0 / fourth_power(b * b);
        sum_b += power;
        const double factor = -power / b / scale;
        const Vector3 normal = orientation * face.area / area;
        const Vector3 by_area =
            (orientation * face.to_center - face.to_center.dot(normal) * orientation * normal) /
            area;
        const Vector3 by_a = factor * face.diagonal_b.cross(by_area);
        const Vector3 by_b = factor * by_area.cross(face.diagonal_a);
        const int* c = face_corners[i];
        for (int k = 0; k < 4; ++k) {
            dB.col(c[k]) += 0.25 * factor * normal;
        }
        dB.col(c[2]) += by_a;
        dB.col(c[0]) -= by_a;
        dB.col(c[3]) += by_b;
        dB.col(c[1]) -= by_b;
        dB_centroid -= factor * normal;
    }
    result.value = eighth_root(sum_a / 8.0 * (sum_b / 6.0)) / std::numbers::sqrt3;
    const Vector3 dA_centroid = -dA.rowwise().sum();
    const Vector3 shared = (dA_centroid / sum_a + dB_centroid / sum_b) / 8.0;
    result.gradient = result.value * ((dA / sum_a + dB / sum_b).colwise() + shared);
    return result;
}

}  // namespace couture::meshing
