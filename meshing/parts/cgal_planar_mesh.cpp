#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/parts/planar_mesh.h"

namespace couture::meshing {

namespace {

/// Circumradius from which a triangle is too large, relative to the wanted edge length; that of an
/// equilateral triangle of this edge length is 0.577.
constexpr double largest_circumradius = 0.70;
/// Distances below which a new point is too near to another point and to an edge of the boundary.
constexpr double nearest_point = 0.65;
constexpr double nearest_edge = 0.45;
constexpr int max_rounds = 100;
constexpr int n_smoothings = 12;

struct FaceState {
    bool is_known = false;
    bool is_inside = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<FaceState, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_tag>;
using Face = Triangulation::Face_handle;

Vector2 to_vector(const Point& p) { return {p.x(), p.y()}; }

double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

double distance_to_segment(const Vector2& p, const Vector2& a, const Vector2& b) {
    const Vector2 edge = b - a;
    const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    return (a + t * edge - p).norm();
}

class RegionMesher {
  public:
    RegionMesher(const std::vector<std::vector<Vector2>>& loops, const PlanarSize& size)
        : loops_(loops), size_(size) {
        for (const std::vector<Vector2>& loop : loops) {
            points_.insert(points_.end(), loop.begin(), loop.end());
        }
        n_boundary_ = static_cast<int>(points_.size());
    }

    PlanarMesh run() {
        rebuild();
        for (int round = 0; round < max_rounds && insert_round(); ++round) {
        }
        for (int i = 0; i < n_smoothings; ++i) {
            smooth();
            rebuild();
        }
        PlanarMesh mesh;
        mesh.points = points_;
        for (const Face face : triangulation_.finite_face_handles()) {
            if (face->info().is_inside) {
                mesh.triangles.push_back(numbers(face));
            }
        }
        // The order of the faces is an accident of the insertion.
        for (std::array<int, 3>& triangle : mesh.triangles) {
            std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                        triangle.end());
        }
        std::sort(mesh.triangles.begin(), mesh.triangles.end());
        return mesh;
    }

  private:
    static std::array<int, 3> numbers(Face face) {
        return {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    }

    /// For each point one before it that is a neighbour now; -1: there is none.
    [[nodiscard]] std::vector<int> earlier_neighbours() const {
        std::vector<int> neighbours(points_.size(), -1);
        for (const Face face : triangulation_.finite_face_handles()) {
            const std::array<int, 3> triangle = numbers(face);
            const int first = *std::min_element(triangle.begin(), triangle.end());
            for (const int i : triangle) {
                if (i != first) {
                    neighbours[i] = std::max(neighbours[i], first);
                }
            }
        }
        return neighbours;
    }

    void rebuild() {
        const std::vector<int> neighbours = earlier_neighbours();
        triangulation_.clear();
        std::vector<Triangulation::Vertex_handle> vertices;
        Face hint;
        for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
            const std::size_t n_before = triangulation_.number_of_vertices();
            // Points move little: the search for a place starts beside it.
            if (neighbours[i] >= 0) {
                hint = vertices[neighbours[i]]->face();
            }
            const auto vertex = triangulation_.insert(Point(points_[i].x(), points_[i].y()), hint);
            if (triangulation_.number_of_vertices() == n_before) {
                throw GeometryError(
                    "mesh_planar_region: point {} at ({}, {}) stands twice; loops must be simple "
                    "and must not touch each other",
                    i, points_[i].x(), points_[i].y());
            }
            vertex->info() = i;
            hint = vertex->face();
            vertices.push_back(vertex);
        }
        insert_loops(vertices);
        mark_inside();
    }

    void insert_loops(const std::vector<Triangulation::Vertex_handle>& vertices) {
        int first = 0;
        for (const std::vector<Vector2>& loop : loops_) {
            const int n = static_cast<int>(loop.size());
            for (int i = 0; i < n; ++i) {
                const int from = first + i;
                const int to = first + (i + 1) % n;
                try {
                    triangulation_.insert_constraint(vertices[from], vertices[to]);
                } catch (const Triangulation::Intersection_of_constraints_exception&) {
                    throw GeometryError(
                        "mesh_planar_region: the edge from ({}, {}) to ({}, {}) crosses another "
                        "one; loops must be simple and must not touch each other",
                        points_[from].x(), points_[from].y(), points_[to].x(), points_[to].y());
                }
            }
            first += n;
        }
    }

    // From outside: each edge of a loop that is crossed changes sides.
    void mark_inside() {
        std::vector<Face> stack;
        for (const Face face : triangulation_.all_face_handles()) {
            face->info() = FaceState{};
        }
        // Points on one line have no triangles, not even outside.
        if (triangulation_.dimension() == 2) {
            triangulation_.infinite_face()->info() = {true, false};
            stack.push_back(triangulation_.infinite_face());
        }
        bool is_any_inside = false;
        while (!stack.empty()) {
            const Face face = stack.back();
            stack.pop_back();
            is_any_inside = is_any_inside || face->info().is_inside;
            for (int i = 0; i < 3; ++i) {
                const Face next = face->neighbor(i);
                if (!next->info().is_known) {
                    next->info() = {true, face->info().is_inside != face->is_constrained(i)};
                    stack.push_back(next);
                }
            }
        }
        if (!is_any_inside) {
            throw GeometryError(
                "mesh_planar_region: nothing lies inside {} loops with {} points; the loops must "
                "enclose an area",
                loops_.size(), n_boundary_);
        }
    }

    bool insert_round() {
        struct Candidate {
            double ratio;
            std::array<int, 3> vertices;
            Point centre;
        };
        std::vector<Candidate> candidates;
        for (const Face face : triangulation_.finite_face_handles()) {
            if (!face->info().is_inside) {
                continue;
            }
            const Point centre = triangulation_.circumcenter(face);
            const Vector2 at = to_vector(centre);
            const double radius = (at - to_vector(face->vertex(0)->point())).norm();
            const double ratio = radius / size_(at);
            if (ratio > largest_circumradius) {
                std::array<int, 3> vertices = numbers(face);
                std::sort(vertices.begin(), vertices.end());
                candidates.push_back({ratio, vertices, centre});
            }
        }
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return std::tie(b.ratio, a.vertices) < std::tie(a.ratio, b.vertices);
        });
        bool is_any_new = false;
        for (const Candidate& candidate : candidates) {
            is_any_new = try_insert(candidate.centre) || is_any_new;
        }
        return is_any_new;
    }

    bool try_insert(const Point& point) {
        Triangulation::Locate_type type{};
        int index = 0;
        const Face face = triangulation_.locate(point, type, index, hint_);
        if ((type != Triangulation::FACE && type != Triangulation::EDGE) ||
            !face->info().is_inside ||
            (type == Triangulation::EDGE && face->is_constrained(index))) {
            return false;
        }
        hint_ = face;
        if (is_near_other(point, face)) {
            return false;
        }
        const auto vertex = triangulation_.insert(point, type, face, index);
        vertex->info() = static_cast<int>(points_.size());
        points_.push_back(to_vector(point));
        auto around = triangulation_.incident_faces(vertex);
        const auto first = around;
        do {
            around->info() = {true, true};
        } while (++around != first);
        hint_ = vertex->face();
        return true;
    }

    [[nodiscard]] bool is_near_other(const Point& point, Face face) const {
        const Vector2 at = to_vector(point);
        const double size = size_(at);
        std::vector<Triangulation::Edge> hole;
        triangulation_.get_boundary_of_conflicts(point, std::back_inserter(hole), face);
        return std::any_of(hole.begin(), hole.end(), [&](const Triangulation::Edge& edge) {
            const Vector2 a =
                to_vector(edge.first->vertex(Triangulation::cw(edge.second))->point());
            const Vector2 b =
                to_vector(edge.first->vertex(Triangulation::ccw(edge.second))->point());
            return (a - at).norm() < nearest_point * size ||
                   (edge.first->is_constrained(edge.second) &&
                    distance_to_segment(at, a, b) < nearest_edge * size);
        });
    }

    // A point that would leave the triangles around it stays.
    void smooth() {
        const int n = static_cast<int>(points_.size());
        std::vector<Vector2> sum(n, Vector2::Zero());
        std::vector<double> weight(n, 0.0);
        std::vector<std::array<int, 3>> triangles;
        for (const Face face : triangulation_.finite_face_handles()) {
            if (face->info().is_inside) {
                triangles.push_back(numbers(face));
                const auto& [a, b, c] = triangles.back();
                const Vector2 centroid = (points_[a] + points_[b] + points_[c]) / 3.0;
                const double size = size_(centroid);
                const double share =
                    cross(points_[b] - points_[a], points_[c] - points_[a]) / (size * size * size);
                for (const int i : triangles.back()) {
                    sum[i] += share * centroid;
                    weight[i] += share;
                }
            }
        }
        std::vector<bool> is_free(n, true);
        for (const auto& triangle : triangles) {
            for (int k = 0; k < 3; ++k) {
                const int i = triangle[k];
                const Vector2 target = sum[i] / weight[i];
                const Vector2& b = points_[triangle[(k + 1) % 3]];
                const Vector2& c = points_[triangle[(k + 2) % 3]];
                if (!(cross(b - target, c - target) > 0.0)) {
                    is_free[i] = false;
                }
            }
        }
        for (int i = n_boundary_; i < n; ++i) {
            if (is_free[i]) {
                points_[i] = sum[i] / weight[i];
            }
        }
    }

    const std::vector<std::vector<Vector2>>& loops_;
    const PlanarSize& size_;
    std::vector<Vector2> points_;
    int n_boundary_ = 0;
    Triangulation triangulation_;
    Face hint_;
};

}  // namespace

PlanarMesh mesh_planar_region(const std::vector<std::vector<Vector2>>& loops,
                              const PlanarSize& size) {
    return RegionMesher(loops, size).run();
}

}  // namespace couture::meshing
