#include "tests/rom/shape_samples.h"

#include <Eigen/Geometry>

#include "rom/designs.h"

namespace couture::tests {

MatrixX sphere_points() {
    const std::vector<Vector3> corners{{1.0, 2.0, 3.0}, {3.0, 1.0, 1.5}, {1.0, 3.0, 0.5}};
    MatrixX points(8 * corners.size(), 3);
    Eigen::Index row = 0;
    for (const Vector3& corner : corners) {
        for (int signs = 0; signs < 8; ++signs) {
            const Vector3 mirror((signs & 1) != 0 ? -1.0 : 1.0, (signs & 2) != 0 ? -1.0 : 1.0,
                                 (signs & 4) != 0 ? -1.0 : 1.0);
            points.row(row++) = corner.cwiseProduct(mirror).normalized().transpose();
        }
    }
    return points;
}

MatrixX ellipsoid(double x, double y, double z) {
    return sphere_points() * Vector3(x, y, z).asDiagonal();
}

std::vector<MatrixX> ellipsoids(double a) {
    std::vector<MatrixX> shapes;
    for (const int i : {-1, 0, 1}) {
        for (const int j : {-1, 0, 1}) {
            shapes.push_back(ellipsoid(1.0 + 2.0 * a * i, 1.0 + a * j, 1.0));
        }
    }
    return shapes;
}

rom::Similarity rigid_motion(int number) {
    const MatrixX values = rom::normal_design(7, 1, 100 + number);
    const Eigen::Quaterniond turn(values(0, 0), values(0, 1), values(0, 2), values(0, 3));
    return {turn.normalized().toRotationMatrix(), 1.0, 10.0 * values.rightCols(3).transpose()};
}

std::vector<MatrixX> moved(const std::vector<MatrixX>& shapes) {
    std::vector<MatrixX> result;
    for (std::size_t j = 0; j < shapes.size(); ++j) {
        result.push_back(rigid_motion(static_cast<int>(j)).apply(shapes[j]));
    }
    return result;
}

std::vector<MatrixX> random_shapes(int n_members, int n_points, double spread) {
    std::vector<MatrixX> shapes;
    const MatrixX common = rom::normal_design(3, n_points, 1);
    for (int j = 0; j < n_members; ++j) {
        shapes.push_back(common + spread * rom::normal_design(3, n_points, 2 + j));
    }
    return shapes;
}

}  // namespace couture::tests
