#include "meshing/surface/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/core/parallel.h"

namespace couture::meshing {

namespace {

constexpr double pi = std::numbers::pi;

// Sum of the angles of the faces around each vertex.
std::vector<double> angle_sums(const SurfaceMesh& mesh) {
    std::vector<double> sums(mesh.n_vertices(), 0.0);
    for (const auto face : mesh.faces()) {
        HalfedgeHandle halfedge = mesh.halfedge_handle(face);
        for (int i = 0; i < 3; ++i, halfedge = mesh.next_halfedge_handle(halfedge)) {
            sums[mesh.from_vertex_handle(halfedge).idx()] += corner_angle(mesh, halfedge);
        }
    }
    return sums;
}

}  // namespace

std::vector<double> gaussian_curvature(const SurfaceMesh& mesh) {
    std::vector<double> curvature = angle_sums(mesh);
    for (const auto vertex : mesh.vertices()) {
        double& value = curvature[vertex.idx()];
        value = mesh.is_isolated(vertex) || mesh.is_boundary(vertex) ? 0.0 : 2.0 * pi - value;
    }
    return curvature;
}

std::vector<double> geodesic_curvature(const SurfaceMesh& mesh) {
    std::vector<double> curvature = angle_sums(mesh);
    for (const auto vertex : mesh.vertices()) {
        double& value = curvature[vertex.idx()];
        value = !mesh.is_isolated(vertex) && mesh.is_boundary(vertex) ? pi - value : 0.0;
    }
    return curvature;
}

namespace {

// Signed area between the origin and the part inside the circle of the segment from a to b.
double circle_segment_area(const Vector2& a, const Vector2& b, double radius) {
    const auto cross = [](const Vector2& u, const Vector2& v) {
        return u.x() * v.y() - u.y() * v.x();
    };
    const auto sector = [&](const Vector2& u, const Vector2& v) {
        return 0.5 * radius * radius * std::atan2(cross(u, v), u.dot(v));
    };
    const Vector2 d = b - a;
    const double dd = d.squaredNorm();
    const double ad = a.dot(d);
    const double discriminant = ad * ad - dd * (a.squaredNorm() - radius * radius);
    if (discriminant <= 0.0 || dd == 0.0) return sector(a, b);
    const double root = std::sqrt(discriminant);
    const double enter = (-ad - root) / dd;
    const double leave = (-ad + root) / dd;
    if (leave <= 0.0 || enter >= 1.0) return sector(a, b);
    const Vector2 from = enter > 0.0 ? Vector2(a + enter * d) : a;
    const Vector2 to = leave < 1.0 ? Vector2(a + leave * d) : b;
    double area = 0.5 * cross(from, to);
    if (enter > 0.0) area += sector(a, from);
    if (leave < 1.0) area += sector(to, b);
    return area;
}

// Area of the part of a triangle inside a ball.
double area_in_ball(const std::array<Vector3, 3>& corners, const Vector3& normal,
                    const Vector3& center, double radius) {
    const double height = normal.dot(corners[0] - center);
    const double disc = radius * radius - height * height;
    if (disc <= 0.0) return 0.0;
    const Vector3 x = (corners[1] - corners[0]).normalized();
    const Vector3 y = normal.cross(x);
    std::array<Vector2, 3> flat;
    for (int i = 0; i < 3; ++i) {
        const Vector3 offset = corners[i] - center;
        flat[i] = Vector2(offset.dot(x), offset.dot(y));
    }
    double area = 0.0;
    for (int i = 0; i < 3; ++i) {
        area += circle_segment_area(flat[i], flat[(i + 1) % 3], std::sqrt(disc));
    }
    return std::max(area, 0.0);
}

// Length of the part of a segment inside a ball.
double length_in_ball(const Vector3& a, const Vector3& b, const Vector3& center, double radius) {
    const Vector3 d = b - a;
    const double dd = d.squaredNorm();
    const double ad = (a - center).dot(d);
    const double discriminant = ad * ad - dd * ((a - center).squaredNorm() - radius * radius);
    if (discriminant <= 0.0 || dd == 0.0) return 0.0;
    const double root = std::sqrt(discriminant);
    const double enter = std::clamp((-ad - root) / dd, 0.0, 1.0);
    const double leave = std::clamp((-ad + root) / dd, 0.0, 1.0);
    return (leave - enter) * std::sqrt(dd);
}

// What the discs of all vertices share.
struct DiscData {
    std::vector<Vector3> face_normals;
    // Signed angle across an edge; 0 on the boundary.
    std::vector<double> edge_angles;
};

DiscData make_disc_data(const SurfaceMesh& mesh) {
    DiscData data;
    for (const auto face : mesh.faces()) data.face_normals.push_back(face_normal(mesh, face));
    for (const auto edge : mesh.edges()) {
        double angle = 0.0;
        if (!mesh.is_boundary(edge)) {
            const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
            const Vector3& left = data.face_normals[mesh.face_handle(halfedge).idx()];
            const Vector3& right = data.face_normals[mesh.opposite_face_handle(halfedge).idx()];
            const Vector3 along = mesh.point(mesh.to_vertex_handle(halfedge)) -
                                  mesh.point(mesh.from_vertex_handle(halfedge));
            const double sine = left.cross(right).norm();
            angle = std::copysign(std::atan2(sine, left.dot(right)), left.cross(right).dot(along));
        }
        data.edge_angles.push_back(angle);
    }
    return data;
}

// Principal curvatures of a tensor that acts on the edges: its eigenvector along a bent edge is the
// direction in which the surface does not bend.
PrincipalCurvatures to_principal(const Matrix<3>& tensor, const Vector3& normal) {
    int smallest = 0;
    normal.cwiseAbs().minCoeff(&smallest);
    const Vector3 x = normal.cross(Vector3::Unit(smallest)).normalized();
    const Vector3 y = normal.cross(x);
    // Turned by a quarter.
    const double xx = y.dot(tensor * y);
    const double yy = x.dot(tensor * x);
    const double xy = -x.dot(tensor * y);
    const double mean = 0.5 * (xx + yy);
    const double half = 0.5 * (xx - yy);
    const double spread = std::hypot(half, xy);
    // The direction of the maximum, at half the angle of (half, xy).
    const double angle = 0.5 * std::atan2(xy, half);
    PrincipalCurvatures result;
    result.minimum = mean - spread;
    result.maximum = mean + spread;
    result.normal = normal;
    result.maximum_direction = std::cos(angle) * x + std::sin(angle) * y;
    result.minimum_direction = result.maximum_direction.cross(normal);
    return result;
}

// Sums over a part of a disc.
struct DiscPart {
    Matrix<3> tensor = Matrix<3>::Zero();
    Vector3 normal = Vector3::Zero();
    double area = 0.0;
};

// Faces and edges that hang together with a vertex inside a ball.
class Disc {
  public:
    Disc(const SurfaceMesh& mesh, bool crosses_features)
        : mesh_(mesh),
          crosses_features_(crosses_features),
          face_mark_(mesh.n_faces(), -1),
          edge_mark_(mesh.n_edges(), -1) {}

    // Of the part between features with the largest area.
    PrincipalCurvatures average(const DiscData& data, VertexHandle vertex, double radius) {
        DiscPart largest;
        for (const auto face : mesh_.vf_range(vertex)) {
            if (face_mark_[face.idx()] == vertex.idx()) continue;
            const DiscPart part = gather(data, face, vertex, radius);
            // Parts of equal size: the one found first, whatever rounding says.
            constexpr double equal = 1e-9;
            if (part.area > (1.0 + equal) * largest.area) largest = part;
        }
        if (!(largest.area > 0.0) || !(largest.normal.norm() > 0.0)) return {};
        return to_principal(largest.tensor / largest.area, largest.normal.normalized());
    }

  private:
    DiscPart gather(const DiscData& data, FaceHandle start, VertexHandle vertex, double radius) {
        const Vector3& center = mesh_.point(vertex);
        const int mark = vertex.idx();
        DiscPart sum;
        stack_.clear();
        push(start, mark);
        while (!stack_.empty()) {
            const FaceHandle face = stack_.back();
            stack_.pop_back();
            const auto [a, b, c] = face_vertices(mesh_, face);
            const Vector3& face_normal = data.face_normals[face.idx()];
            const double area = area_in_ball({mesh_.point(a), mesh_.point(b), mesh_.point(c)},
                                             face_normal, center, radius);
            sum.area += area;
            sum.normal += area * face_normal;
            HalfedgeHandle halfedge = mesh_.halfedge_handle(face);
            for (int i = 0; i < 3; ++i, halfedge = mesh_.next_halfedge_handle(halfedge)) {
                const EdgeHandle edge = mesh_.edge_handle(halfedge);
                if (edge_mark_[edge.idx()] == mark || is_end(edge)) continue;
                edge_mark_[edge.idx()] = mark;
                const Vector3& from = mesh_.point(mesh_.from_vertex_handle(halfedge));
                const Vector3& to = mesh_.point(mesh_.to_vertex_handle(halfedge));
                const double length = length_in_ball(from, to, center, radius);
                if (length == 0.0) continue;
                const Vector3 along = (to - from).normalized();
                sum.tensor += data.edge_angles[edge.idx()] * length * along * along.transpose();
                const FaceHandle neighbour = mesh_.opposite_face_handle(halfedge);
                if (neighbour.is_valid()) push(neighbour, mark);
            }
        }
        return sum;
    }

    [[nodiscard]] bool is_end(EdgeHandle edge) const {
        return !crosses_features_ && mesh_.data(edge).feature >= 0;
    }

    void push(FaceHandle face, int mark) {
        if (face_mark_[face.idx()] == mark) return;
        face_mark_[face.idx()] = mark;
        stack_.push_back(face);
    }

    const SurfaceMesh& mesh_;
    bool crosses_features_;
    std::vector<int> face_mark_;
    std::vector<int> edge_mark_;
    std::vector<FaceHandle> stack_;
};

double mean_edge_length(const SurfaceMesh& mesh, VertexHandle vertex) {
    double sum = 0.0;
    int n_edges = 0;
    for (const auto edge : mesh.ve_range(vertex)) {
        sum += edge_length(mesh, edge);
        ++n_edges;
    }
    return sum / n_edges;
}

}  // namespace

std::vector<PrincipalCurvatures> principal_curvatures(const SurfaceMesh& mesh,
                                                      const CurvatureOptions& options) {
    if (options.radius && !(*options.radius > 0.0)) {
        throw InputError("principal_curvatures: the radius of the disc is {}; it must be positive",
                         *options.radius);
    }
    if (!(options.edges_per_radius > 0.0)) {
        throw InputError(
            "principal_curvatures: {} edge lengths per radius; the number must be positive",
            options.edges_per_radius);
    }
    const DiscData data = make_disc_data(mesh);
    const int n_vertices = static_cast<int>(mesh.n_vertices());
    std::vector<PrincipalCurvatures> result(n_vertices);
    // Blocks of vertices, each with marks of its own.
    const int n_blocks = std::clamp(n_vertices / 2048, 1, 8);
    parallel_for(n_blocks, [&](int i_block) {
        Disc disc(mesh, options.crosses_features);
        const auto bound = [&](int i) {
            return static_cast<int>(static_cast<long long>(n_vertices) * i / n_blocks);
        };
        for (int v = bound(i_block); v < bound(i_block + 1); ++v) {
            const VertexHandle vertex(v);
            if (mesh.is_isolated(vertex)) continue;
            const double radius = options.radius
                                      ? *options.radius
                                      : options.edges_per_radius * mean_edge_length(mesh, vertex);
            result[v] = disc.average(data, vertex, radius);
        }
    });
    return result;
}

namespace {

struct ClassRow {
    CurvatureClass curvature_class;
    std::string_view name;
    double curvature;
    std::optional<int> index;
};

constexpr std::array<ClassRow, 6> class_rows{{
    {CurvatureClass::sharp, "sharp", 2.0 * pi, std::nullopt},
    {CurvatureClass::spherical, "spherical", 0.5 * pi, 1},
    {CurvatureClass::euclidean, "euclidean", 0.0, 0},
    {CurvatureClass::hyperbolic, "hyperbolic", -0.5 * pi, -1},
    {CurvatureClass::ultrahyperbolic, "ultrahyperbolic", -pi, -2},
    {CurvatureClass::solid_angle, "solid_angle", -2.0 * pi, std::nullopt},
}};

const ClassRow& row_of(CurvatureClass curvature_class) {
    return class_rows.at(static_cast<std::size_t>(curvature_class));
}

}  // namespace

std::string_view to_string(CurvatureClass curvature_class) { return row_of(curvature_class).name; }

CurvatureClass classify_curvature(double curvature) {
    return std::min_element(class_rows.begin(), class_rows.end(),
                            [&](const ClassRow& a, const ClassRow& b) {
                                const double to_a = std::abs(a.curvature - curvature);
                                const double to_b = std::abs(b.curvature - curvature);
                                if (to_a != to_b) return to_a < to_b;
                                return std::abs(a.curvature) < std::abs(b.curvature);
                            })
        ->curvature_class;
}

std::optional<int> expected_index(CurvatureClass curvature_class) {
    return row_of(curvature_class).index;
}

}  // namespace couture::meshing
