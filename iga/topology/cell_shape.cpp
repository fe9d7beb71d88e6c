#include "iga/topology/cell_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace couture::iga {

namespace {

using std::numbers::pi;

/// Shorter or flatter than this part of the whole is nothing but rounding.
constexpr double rounding = 1e-13;

double cross_norm(const Vector2& a, const Vector2& b) {
    return std::abs(a[0] * b[1] - a[1] * b[0]);
}
double cross_norm(const Vector3& a, const Vector3& b) { return a.cross(b).norm(); }

/// Corners of the face where direction k is at `end`, direction 0 of the rest fastest.
template <int d>
std::array<int, 1 << (d - 1)> face_corners(int k, int end) {
    std::array<int, 1 << (d - 1)> result;
    std::size_t n = 0;
    for (int corner = 0; corner < 1 << d; ++corner) {
        if ((corner >> k & 1) == end) {
            result[n++] = corner;
        }
    }
    return result;
}

/// A vector across the face, as long as both diagonals multiplied if they meet at a right angle;
/// zero if the face has no area.
Vector3 face_normal(const CellCorners<3>& x, const std::array<int, 4>& face) {
    const Vector3 first = x.col(face[3]) - x.col(face[0]);
    const Vector3 second = x.col(face[2]) - x.col(face[1]);
    const Vector3 normal = first.cross(second);
    const bool has_area = normal.norm() > rounding * first.squaredNorm() &&
                          normal.norm() > rounding * second.squaredNorm();
    return has_area ? normal : Vector3::Zero();
}
Vector2 face_normal(const CellCorners<2>& x, const std::array<int, 2>& face) {
    const Vector2 edge = x.col(face[1]) - x.col(face[0]);
    return {-edge[1], edge[0]};
}

template <int d>
double ratio_of(const CellCorners<d>& corners) {
    const Vector<d> centroid = corners.rowwise().mean();
    const CellCorners<d> x = corners.colwise() - centroid;
    const double farthest = x.colwise().norm().maxCoeff();
    double nearest = farthest;
    for (int k = 0; k < d; ++k) {
        for (const int end : {0, 1}) {
            const auto face = face_corners<d>(k, end);
            Vector<d> middle = Vector<d>::Zero();
            for (const int corner : face) {
                middle += x.col(corner) / static_cast<double>(face.size());
            }
            const Vector<d> normal = face_normal(x, face);
            const double length = normal.norm();
            nearest = std::min(nearest, length > 0.0 ? std::abs(middle.dot(normal)) / length : 0.0);
        }
    }
    return nearest > rounding * farthest ? farthest / nearest
                                         : std::numeric_limits<double>::infinity();
}

template <int d>
double deviation_of(const CellCorners<d>& x) {
    const double size = (x.colwise() - Vector<d>(x.rowwise().mean())).colwise().norm().maxCoeff();
    double total = 0.0;
    for (int corner = 0; corner < 1 << d; ++corner) {
        double deviation = 0.0;
        for (int k = 0; k < d; ++k) {
            for (int l = 0; l < k; ++l) {
                const Vector<d> a = x.col(corner ^ 1 << k) - x.col(corner);
                const Vector<d> b = x.col(corner ^ 1 << l) - x.col(corner);
                const bool is_angle = std::min(a.norm(), b.norm()) > rounding * size;
                deviation += is_angle ? pi / 2 - std::atan2(cross_norm(a, b), a.dot(b)) : 0.0;
            }
        }
        total += std::abs(deviation);
    }
    return total;
}

}  // namespace

double shape_ratio(const CellCorners<3>& corners) { return ratio_of<3>(corners); }
double shape_ratio(const CellCorners<2>& corners) { return ratio_of<2>(corners); }
double angle_deviation(const CellCorners<3>& corners) { return deviation_of<3>(corners); }
double angle_deviation(const CellCorners<2>& corners) { return deviation_of<2>(corners); }

}  // namespace couture::iga
