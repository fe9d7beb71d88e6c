#include "meshing/topology/pants_criteria.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/surface/curvature.h"
#include "meshing/surface/point_grid.h"

namespace couture::meshing {

namespace {

// Directions that can be normals of mirror planes.
std::vector<Vector3> candidate_normals(const Matrix<3>& inertia) {
    std::vector<Vector3> normals;
    const auto add = [&](const Vector3& normal) {
        const bool is_known = std::any_of(normals.begin(), normals.end(), [&](const Vector3& n) {
            return std::abs(n.dot(normal)) > 1.0 - 1e-6;
        });
        if (!is_known) normals.push_back(normal);
    };
    for (int i = 0; i < 3; ++i) add(Vector3::Unit(i));
    const Eigen::SelfAdjointEigenSolver<Matrix<3>> eigen(inertia);
    const Vector3 values = eigen.eigenvalues();
    for (int i = 0; i < 3; ++i) add(eigen.eigenvectors().col(i));
    // Two equal moments: any direction of their plane can be one; three: the axes must do.
    constexpr double same = 1e-3;
    const bool low = values[1] - values[0] < same * values[2];
    const bool high = values[2] - values[1] < same * values[2];
    if (low == high) return normals;
    const Vector3 axis = eigen.eigenvectors().col(low ? 2 : 0);
    Vector3 start = axis.unitOrthogonal();
    // From a coordinate axis on, where there is one across.
    for (int i = 0; i < 3; ++i) {
        if (std::abs(axis[i]) < 1e-3) start = (Vector3::Unit(i) - axis[i] * axis).normalized();
    }
    const Vector3 across = axis.cross(start);
    constexpr int n_directions = 48;
    for (int k = 0; k < n_directions; ++k) {
        const double angle = std::numbers::pi * k / n_directions;
        add(std::cos(angle) * start + std::sin(angle) * across);
    }
    return normals;
}

}  // namespace

std::vector<SymmetryPlane> find_symmetry_planes(const SurfaceMesh& mesh) {
    std::vector<Vector3> points;
    std::vector<Vector3> centres;
    Vector3 centre = Vector3::Zero();
    double area = 0.0;
    double edge = 0.0;
    for (const auto e : mesh.edges()) edge += edge_length(mesh, e);
    edge /= std::max<double>(1.0, static_cast<double>(mesh.n_edges()));
    for (const auto vertex : mesh.vertices()) {
        if (!mesh.is_isolated(vertex)) points.push_back(mesh.point(vertex));
    }
    Matrix<3> second = Matrix<3>::Zero();
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        const double share = face_area(mesh, face);
        const Vector3 middle = (mesh.point(a) + mesh.point(b) + mesh.point(c)) / 3.0;
        centres.push_back(middle);
        centre += share * middle;
        area += share;
        // Exact for quadratic functions: the midpoints of the edges.
        for (const Vector3& x : {Vector3(0.5 * (mesh.point(a) + mesh.point(b))),
                                 Vector3(0.5 * (mesh.point(b) + mesh.point(c))),
                                 Vector3(0.5 * (mesh.point(c) + mesh.point(a)))}) {
            second += share / 3.0 * x * x.transpose();
        }
    }
    if (area <= 0.0) return {};
    centre /= area;
    const Matrix<3> inertia = second / area - centre * centre.transpose();

    // Long triangles are filled up, so that no point of the surface is far from a sample.
    for (std::size_t f = 0; f < centres.size(); ++f) {
        const auto [a, b, c] = face_vertices(mesh, FaceHandle(static_cast<int>(f)));
        const Vector3 corners[3] = {mesh.point(a), mesh.point(b), mesh.point(c)};
        double longest = 0.0;
        for (int k = 0; k < 3; ++k) {
            longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).norm());
        }
        const int n = std::clamp(static_cast<int>(std::ceil(longest / edge)), 1, 20);
        for (int i = 0; i <= n && n > 1; ++i) {
            for (int j = 0; i + j <= n; ++j) {
                points.emplace_back((i * corners[0] + j * corners[1] + (n - i - j) * corners[2]) /
                                    n);
            }
        }
    }
    points.insert(points.end(), centres.begin(), centres.end());

    const double diagonal = bounding_box_diagonal(mesh);
    PointGrid grid(2.0 * edge);
    for (const Vector3& point : points) grid.add(point);
    const std::size_t stride = std::max<std::size_t>(1, points.size() / 2000);
    std::vector<SymmetryPlane> planes;
    for (const Vector3& normal : candidate_normals(inertia)) {
        double sum = 0.0;
        int n = 0;
        for (std::size_t i = 0; i < points.size(); i += stride, ++n) {
            const Vector3 image = points[i] - 2.0 * normal.dot(points[i] - centre) * normal;
            const double distance = grid.distance(image);
            sum += distance * distance;
        }
        const double deviation = std::sqrt(sum / n);
        if (deviation > 0.5 * edge) continue;
        planes.push_back({normal, normal.dot(centre), deviation / diagonal});
    }
    return planes;
}

CutCriterion::CutCriterion(const SurfaceMesh& mesh, const CriterionWeights& weights,
                           const std::vector<SymmetryPlane>& planes, const char* name) {
    const std::array<double, 3> all{weights.length, weights.symmetry, weights.curvature};
    for (const double w : all) {
        if (!std::isfinite(w) || w < 0.0) {
            throw InputError("{}: weight {}; weights must be finite and not negative", name, w);
        }
    }
    if (!std::isfinite(weights.sharp) || weights.sharp <= -1.0) {
        throw InputError("{}: weight {} of sharp edges; it must be finite and above -1", name,
                         weights.sharp);
    }
    if (weights.length + weights.symmetry + weights.curvature <= 0.0) {
        throw InputError(
            "{}: the weights of length, symmetry and curvature are all 0; one must be positive",
            name);
    }
    diagonal_ = bounding_box_diagonal(mesh);
    is_plain_length_ = weights.symmetry == 0.0 && weights.curvature == 0.0 && weights.sharp == 0.0;
    factor_.assign(mesh.n_vertices(), weights.length);
    if (is_plain_length_) return;

    if (weights.symmetry > 0.0) {
        for (const auto vertex : mesh.vertices()) {
            double nearest = planes.empty() ? 0.0 : diagonal_;
            for (const SymmetryPlane& plane : planes) {
                nearest = std::min(nearest,
                                   std::abs(plane.normal.dot(mesh.point(vertex)) - plane.offset));
            }
            // A tenth of the diagonal away counts 1.
            factor_[vertex.idx()] += weights.symmetry * nearest / (0.1 * diagonal_);
        }
    }
    if (weights.curvature > 0.0) {
        const auto curvatures = principal_curvatures(mesh, {.crosses_features = true});
        for (const auto vertex : mesh.vertices()) {
            // A valley of radius a tenth of the diagonal counts 1/4, such a ridge 3/4.
            const double scaled = 0.1 * diagonal_ * curvatures[vertex.idx()].minimum;
            factor_[vertex.idx()] +=
                weights.curvature * (0.5 + std::atan(scaled) / std::numbers::pi);
        }
    }
    if (weights.sharp != 0.0) {
        for (const auto vertex : mesh.vertices()) {
            bool is_on_feature = false;
            for (const auto edge : mesh.ve_range(vertex)) {
                is_on_feature = is_on_feature || mesh.data(edge).feature >= 0;
            }
            if (is_on_feature) factor_[vertex.idx()] /= 1.0 + weights.sharp;
        }
    }
    // A way that costs nothing has no shortest length.
    const double largest = *std::max_element(factor_.begin(), factor_.end());
    for (double& factor : factor_) factor = std::max(factor, 1e-3 * largest);
}

double CutCriterion::factor(const SurfacePoint& place) const {
    double value = 0.0;
    for (int k = 0; k < 3 && place.vertices[k] >= 0; ++k) {
        value += place.weights[k] * factor_[place.vertices[k]];
    }
    return value;
}

double CutCriterion::least_score(double length) const {
    return *std::min_element(factor_.begin(), factor_.end()) * length / diagonal_;
}

double CutCriterion::score(const std::vector<double>& factors,
                           const std::vector<Vector3>& points) const {
    if (factors.size() != points.size()) {
        throw InputError("criterion: {} factors for {} points; there must be one each",
                         factors.size(), points.size());
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const std::size_t next = (k + 1) % points.size();
        sum += 0.5 * (factors[k] + factors[next]) * (points[next] - points[k]).norm();
    }
    return sum / diagonal_;
}

}  // namespace couture::meshing
