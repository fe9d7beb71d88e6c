#include "meshing/parameterization/surface_slide.h"

#include <algorithm>
#include <limits>

#include "meshing/parameterization/chart_vertices.h"

namespace couture::meshing {

SurfaceSlide::SurfaceSlide(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                           const SampleGrid& grid)
    : mesh_(mesh),
      grid_(grid),
      is_curve_edge_(mesh.n_edges(), false),
      curve_of_point_(grid.n_points, -1),
      vertex_of_point_(grid.n_points),
      region_of_point_(grid.n_points, -1) {
    find_curves(embedding, grid);
    find_regions(embedding);
    find_normals();
}

int SurfaceSlide::n_directions(int point) const {
    if (vertex_of_point_[point].is_valid()) return 0;
    return curve_of_point_[point] >= 0 ? 1 : 2;
}

void SurfaceSlide::find_curves(const EmbeddedLayout& embedding, const SampleGrid& grid) {
    const QuadLayout& layout = embedding.layout;
    std::vector<std::vector<int>> arcs_at(layout.n_nodes());
    std::vector<bool> is_open(layout.n_arcs(), false);
    for (int a = 0; a < layout.n_arcs(); ++a) {
        is_open[a] = embedding.is_feature_arc[a] || layout.is_boundary_arc(a);
        if (!is_open[a]) continue;
        arcs_at[layout.arcs()[a].from].push_back(a);
        arcs_at[layout.arcs()[a].to].push_back(a);
    }
    std::vector<bool> stays(layout.n_nodes(), false);
    for (int n = 0; n < layout.n_nodes(); ++n) {
        const bool is_on_curve = !arcs_at[n].empty();
        stays[n] = embedding.is_corner_node[n] || (is_on_curve && arcs_at[n].size() != 2);
        if (stays[n]) vertex_of_point_[n] = embedding.nodes[n];
    }
    // First from nodes that stay, then what is closed.
    const auto follow = [&](int start, int arc) {
        Curve curve;
        const int number = static_cast<int>(curves_.size());
        curve.vertices.push_back(embedding.nodes[start]);
        for (int node = start; arc >= 0;) {
            is_open[arc] = false;
            auto path = embedding.arcs[arc];
            if (layout.arcs()[arc].from != node) std::reverse(path.begin(), path.end());
            for (std::size_t i = 1; i < path.size(); ++i) {
                const HalfedgeHandle h = mesh_.find_halfedge(path[i - 1], path[i]);
                is_curve_edge_[mesh_.edge_handle(h).idx()] = true;
            }
            curve.vertices.insert(curve.vertices.end(), path.begin() + 1, path.end());
            for (const int point : grid.arcs[arc]) curve_of_point_[point] = number;
            node =
                layout.arcs()[arc].from == node ? layout.arcs()[arc].to : layout.arcs()[arc].from;
            arc = -1;
            if (stays[node]) break;
            for (const int next : arcs_at[node]) {
                if (is_open[next]) arc = next;
            }
        }
        curves_.push_back(std::move(curve));
    };
    for (const bool takes_closed : {false, true}) {
        for (int n = 0; n < layout.n_nodes(); ++n) {
            for (const int arc : arcs_at[n]) {
                if (is_open[arc] && (stays[n] || takes_closed)) follow(n, arc);
            }
        }
    }
}

void SurfaceSlide::find_regions(const EmbeddedLayout& embedding) {
    region_of_face_.assign(mesh_.n_faces(), -1);
    for (const FaceHandle start : mesh_.faces()) {
        if (region_of_face_[start.idx()] >= 0) continue;
        const int region = static_cast<int>(faces_of_region_.size());
        std::vector<FaceHandle> faces{start};
        region_of_face_[start.idx()] = region;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (const HalfedgeHandle h : mesh_.fh_range(faces[i])) {
                const FaceHandle next = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
                if (!next.is_valid() || is_curve_edge_[mesh_.edge_handle(h).idx()] ||
                    region_of_face_[next.idx()] >= 0) {
                    continue;
                }
                region_of_face_[next.idx()] = region;
                faces.push_back(next);
            }
        }
        std::sort(faces.begin(), faces.end());
        std::vector<std::array<Vector3, 3>> triangles;
        for (const FaceHandle face : faces) {
            const auto [a, b, c] = face_vertices(mesh_, face);
            triangles.push_back({mesh_.point(a), mesh_.point(b), mesh_.point(c)});
        }
        trees_.emplace_back(std::move(triangles));
        faces_of_region_.push_back(std::move(faces));
    }
    region_of_quad_.assign(embedding.layout.n_quads(), -1);
    for (const FaceHandle face : mesh_.faces()) {
        region_of_quad_[embedding.quad_of_face[face.idx()]] = region_of_face_[face.idx()];
    }
    for (std::size_t q = 0; q < grid_.quads.size(); ++q) {
        for (const int point : grid_.quads[q]) region_of_point_[point] = region_of_quad_[q];
    }
}

void SurfaceSlide::find_normals() {
    for (const FaceHandle face : mesh_.faces()) {
        const Vector3 normal = face_area(mesh_, face) * face_normal(mesh_, face);
        for (const VertexHandle vertex : face_vertices(mesh_, face)) {
            const auto key = std::pair(vertex.idx(), region_of_face_[face.idx()]);
            normals_.try_emplace(key, Vector3::Zero()).first->second += normal;
        }
    }
    for (auto& [key, normal] : normals_) normal.normalize();
}

Vector3 SurfaceSlide::normal_at(VertexHandle vertex, int region) const {
    const auto at = normals_.find({vertex.idx(), region});
    return at == normals_.end() ? Vector3(Vector3::Zero()) : at->second;
}

SurfaceSlide::CurvePlace SurfaceSlide::nearest_on(const Curve& curve, const Vector3& point) const {
    CurvePlace best;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
        const Vector3& a = mesh_.point(curve.vertices[i - 1]);
        const Vector3& b = mesh_.point(curve.vertices[i]);
        const double t = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        const Vector3 place = (1.0 - t) * a + t * b;
        const double distance = (place - point).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        best = {static_cast<int>(i) - 1, t, place};
    }
    return best;
}

SurfaceSlide::State SurfaceSlide::placed(const MatrixX& points) const {
    State state;
    state.points = points;
    state.directions.assign(grid_.n_points, Matrix<3, 2>::Zero());
    std::vector<CurvePlace> on_curves(grid_.n_points);
    MatrixX inside(3, grid_.n_points);
    for (int i = 0; i < grid_.n_points; ++i) {
        if (region_of_point_[i] < 0) continue;
        const int n = n_directions(i);
        if (n == 0) {
            state.points.col(i) = mesh_.point(vertex_of_point_[i]);
        } else if (n == 1) {
            const Curve& curve = curves_[curve_of_point_[i]];
            on_curves[i] = nearest_on(curve, points.col(i));
            state.points.col(i) = on_curves[i].point;
            const int s = on_curves[i].segment;
            state.directions[i].col(0) =
                (mesh_.point(curve.vertices[s + 1]) - mesh_.point(curve.vertices[s])).normalized();
        } else {
            const int region = region_of_point_[i];
            const NearestPlace place = trees_[region].nearest(points.col(i));
            const auto vertices = face_vertices(mesh_, faces_of_region_[region][place.triangle]);
            Vector3 normal = Vector3::Zero();
            for (int k = 0; k < 3; ++k) {
                normal += place.weights[k] * normal_at(vertices[k], region);
            }
            inside.col(i) = normal.normalized();
            state.points.col(i) = place.point;
            state.directions[i].col(0) = inside.col(i).unitOrthogonal();
            state.directions[i].col(1) =
                Vector3(inside.col(i)).cross(Vector3(state.directions[i].col(0)));
        }
    }
    for (std::size_t q = 0; q < grid_.quads.size(); ++q) {
        MatrixX& normals = state.normals.emplace_back(3, grid_.quads[q].size());
        const int region = region_of_quad_[q];
        for (std::size_t i = 0; i < grid_.quads[q].size(); ++i) {
            const int point = grid_.quads[q][i];
            auto normal = normals.col(static_cast<int>(i));
            const int n = n_directions(point);
            if (n == 0) {
                normal = normal_at(vertex_of_point_[point], region);
            } else if (n == 1) {
                const auto& vertices = curves_[curve_of_point_[point]].vertices;
                const CurvePlace& place = on_curves[point];
                normal = (1.0 - place.fraction) * normal_at(vertices[place.segment], region) +
                         place.fraction * normal_at(vertices[place.segment + 1], region);
            } else {
                normal = inside.col(point);
            }
        }
    }
    return state;
}

}  // namespace couture::meshing
