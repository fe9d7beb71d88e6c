#include "meshing/surface/features.h"

#include <algorithm>
#include <cmath>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check(const FeatureOptions& options) {
    const auto check_angle = [](const char* name, double angle) {
        if (!(angle > 0.0 && angle < std::numbers::pi)) {
            throw InputError("FeatureOptions: {} is {}; it must be in (0, pi) radians", name,
                             angle);
        }
    };
    check_angle("angle", options.angle);
    check_angle("corner_angle", options.corner_angle);
    if (!(options.min_length >= 0.0)) {
        throw InputError("FeatureOptions: min_length is {}; it must not be negative",
                         options.min_length);
    }
    if (!(options.planar_tolerance >= 0.0)) {
        throw InputError("FeatureOptions: planar_tolerance is {}; it must not be negative",
                         options.planar_tolerance);
    }
}

bool is_tagged(const SurfaceMesh& mesh, EdgeHandle edge) { return mesh.data(edge).feature >= 0; }

// Halfedges from each vertex along edges that still need a curve, by the vertex they lead to.
class FeatureGraph {
  public:
    FeatureGraph(const SurfaceMesh& mesh, const std::vector<bool>& is_feature)
        : mesh_(mesh), outgoing_(mesh.n_vertices()) {
        for (const auto edge : mesh.edges()) {
            if (!is_feature[edge.idx()]) continue;
            for (const int side : {0, 1}) {
                const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, side);
                outgoing_[mesh.from_vertex_handle(halfedge).idx()].push_back(halfedge);
            }
        }
        for (auto& halfedges : outgoing_) {
            std::sort(halfedges.begin(), halfedges.end(), [&](HalfedgeHandle a, HalfedgeHandle b) {
                return mesh.to_vertex_handle(a) < mesh.to_vertex_handle(b);
            });
        }
    }

    [[nodiscard]] const std::vector<HalfedgeHandle>& outgoing(VertexHandle vertex) const {
        return outgoing_[vertex.idx()];
    }

    // Turn of the curve through a vertex with two edges.
    [[nodiscard]] double turn(VertexHandle vertex) const {
        const auto& both = outgoing(vertex);
        const Vector3 in = mesh_.point(vertex) - mesh_.point(mesh_.to_vertex_handle(both[0]));
        const Vector3 out = mesh_.point(mesh_.to_vertex_handle(both[1])) - mesh_.point(vertex);
        return std::atan2(in.cross(out).norm(), in.dot(out));
    }

  private:
    const SurfaceMesh& mesh_;
    std::vector<std::vector<HalfedgeHandle>> outgoing_;
};

// Adds curves along all edges of the graph, cut at corners, and tags their edges.
void trace_curves(SurfaceMesh& mesh, const FeatureGraph& graph, const std::vector<bool>& is_corner,
                  std::vector<FeatureCurve>& curves) {
    const auto trace = [&](HalfedgeHandle start) {
        const int number = static_cast<int>(curves.size());
        FeatureCurve& curve = curves.emplace_back();
        curve.is_boundary = mesh.is_boundary(mesh.edge_handle(start));
        const VertexHandle first = mesh.from_vertex_handle(start);
        curve.vertices.push_back(first);
        HalfedgeHandle halfedge = start;
        while (true) {
            const EdgeHandle edge = mesh.edge_handle(halfedge);
            mesh.data(edge).feature = number;
            curve.length += edge_length(mesh, edge);
            const VertexHandle vertex = mesh.to_vertex_handle(halfedge);
            if (vertex == first) {
                curve.is_closed = true;
                return;
            }
            curve.vertices.push_back(vertex);
            if (is_corner[vertex.idx()]) return;
            const auto& both = graph.outgoing(vertex);
            halfedge = mesh.edge_handle(both[0]) == edge ? both[1] : both[0];
        }
    };
    for (const bool from_corners : {true, false}) {
        for (const auto vertex : mesh.vertices()) {
            if (is_corner[vertex.idx()] != from_corners) continue;
            for (const HalfedgeHandle halfedge : graph.outgoing(vertex)) {
                if (!is_tagged(mesh, mesh.edge_handle(halfedge))) trace(halfedge);
            }
        }
    }
}

double tolerance_of(const SurfaceMesh& mesh, const FeatureOptions& options) {
    return options.planar_tolerance * bounding_box_diagonal(mesh);
}

Vector3 area_vector(const SurfaceMesh& mesh, FaceHandle face) {
    const auto [a, b, c] = face_vertices(mesh, face);
    return 0.5 * (mesh.point(b) - mesh.point(a)).cross(mesh.point(c) - mesh.point(a));
}

Vector3 face_centroid(const SurfaceMesh& mesh, FaceHandle face) {
    const auto [a, b, c] = face_vertices(mesh, face);
    return (mesh.point(a) + mesh.point(b) + mesh.point(c)) / 3.0;
}

// Loops of the regions and their Euler characteristics.
void count_loops(const SurfaceMesh& mesh, std::vector<FeatureRegion>& regions) {
    const auto region_of = [&](HalfedgeHandle halfedge) -> FeatureRegion& {
        return regions[mesh.data(mesh.face_handle(halfedge)).region];
    };
    // Twice V - E + F: vertices inside, a corner of the loops for each halfedge along them.
    std::vector<int> twice_chi(regions.size(), 0);
    std::vector<bool> is_on_curve(mesh.n_vertices(), false);
    std::vector<bool> is_seen(mesh.n_halfedges(), false);
    for (const auto start : mesh.halfedges()) {
        if (mesh.is_boundary(start) || !is_tagged(mesh, mesh.edge_handle(start)) ||
            is_seen[start.idx()]) {
            continue;
        }
        FeatureRegion& region = region_of(start);
        ++region.n_loops;
        HalfedgeHandle halfedge = start;
        while (!is_seen[halfedge.idx()]) {
            is_seen[halfedge.idx()] = true;
            is_on_curve[mesh.from_vertex_handle(halfedge).idx()] = true;
            is_on_curve[mesh.to_vertex_handle(halfedge).idx()] = true;
            // 2 (one vertex) - 2 (half an edge, beside those counted by faces).
            twice_chi[mesh.data(mesh.face_handle(halfedge)).region] += 1;
            halfedge = mesh.next_halfedge_handle(halfedge);
            while (!is_tagged(mesh, mesh.edge_handle(halfedge))) {
                halfedge = mesh.next_halfedge_handle(mesh.opposite_halfedge_handle(halfedge));
            }
        }
    }
    for (const auto vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex) || is_on_curve[vertex.idx()]) continue;
        twice_chi[mesh.data(*mesh.cvf_begin(vertex)).region] += 2;
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
        // Edges: (3 F + B) / 2, of which the B / 2 are counted above.
        twice_chi[i] -= static_cast<int>(regions[i].faces.size());
        regions[i].euler_characteristic = twice_chi[i] / 2;
    }
}

std::vector<FeatureRegion> tag_regions(SurfaceMesh& mesh, const FeatureOptions& options) {
    std::vector<FeatureRegion> regions;
    for (const auto face : mesh.faces()) mesh.data(face).region = -1;
    std::vector<FaceHandle> stack;
    for (const auto start : mesh.faces()) {
        if (mesh.data(start).region >= 0) continue;
        const int number = static_cast<int>(regions.size());
        FeatureRegion& region = regions.emplace_back();
        mesh.data(start).region = number;
        stack.push_back(start);
        while (!stack.empty()) {
            const FaceHandle face = stack.back();
            stack.pop_back();
            region.faces.push_back(face);
            HalfedgeHandle halfedge = mesh.halfedge_handle(face);
            for (int i = 0; i < 3; ++i, halfedge = mesh.next_halfedge_handle(halfedge)) {
                const EdgeHandle edge = mesh.edge_handle(halfedge);
                if (is_tagged(mesh, edge)) {
                    region.curves.push_back(mesh.data(edge).feature);
                    continue;
                }
                const FaceHandle neighbour = mesh.opposite_face_handle(halfedge);
                if (mesh.data(neighbour).region >= 0) continue;
                mesh.data(neighbour).region = number;
                stack.push_back(neighbour);
            }
        }
        std::sort(region.faces.begin(), region.faces.end());
        std::sort(region.curves.begin(), region.curves.end());
        region.curves.erase(std::unique(region.curves.begin(), region.curves.end()),
                            region.curves.end());
        for (const FaceHandle face : region.faces) {
            const Vector3 area = area_vector(mesh, face);
            region.area += area.norm();
            region.normal += area;
            region.centroid += area.norm() * face_centroid(mesh, face);
        }
        if (region.area > 0.0) region.centroid /= region.area;
        // Of a closed surface only rounding is left.
        region.normal = region.normal.norm() > 1e-12 * region.area
                            ? Vector3(region.normal.normalized())
                            : Vector3::Zero();
        region.is_planar = is_planar(mesh, region.faces, tolerance_of(mesh, options));
    }
    count_loops(mesh, regions);
    return regions;
}

std::vector<VertexHandle> to_list(const std::vector<bool>& is_corner) {
    std::vector<VertexHandle> corners;
    for (std::size_t i = 0; i < is_corner.size(); ++i) {
        if (is_corner[i]) corners.emplace_back(static_cast<int>(i));
    }
    return corners;
}

// Drops connected sets of sharp edges that are too short.
void drop_short(const SurfaceMesh& mesh, double min_length, std::vector<bool>& is_feature) {
    DisjointSets sets(mesh.n_vertices());
    const auto ends = [&](EdgeHandle edge) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
        return std::pair(mesh.from_vertex_handle(halfedge).idx(),
                         mesh.to_vertex_handle(halfedge).idx());
    };
    for (const auto edge : mesh.edges()) {
        if (!is_feature[edge.idx()]) continue;
        const auto [from, to] = ends(edge);
        sets.join(from, to);
    }
    std::vector<double> length(mesh.n_vertices(), 0.0);
    for (const auto edge : mesh.edges()) {
        if (!is_feature[edge.idx()]) continue;
        length[sets.find(ends(edge).first)] +=
            mesh.is_boundary(edge) ? min_length : edge_length(mesh, edge);
    }
    for (const auto edge : mesh.edges()) {
        if (is_feature[edge.idx()] && length[sets.find(ends(edge).first)] < min_length) {
            is_feature[edge.idx()] = false;
        }
    }
}

}  // namespace

double dihedral_angle(const SurfaceMesh& mesh, EdgeHandle edge) {
    if (mesh.is_boundary(edge)) return 0.0;
    const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    const Vector3 a = face_normal(mesh, mesh.face_handle(halfedge));
    const Vector3 b = face_normal(mesh, mesh.opposite_face_handle(halfedge));
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

bool is_planar(const SurfaceMesh& mesh, std::span<const FaceHandle> faces, double tolerance) {
    Vector3 normal = Vector3::Zero();
    Vector3 centroid = Vector3::Zero();
    double area = 0.0;
    for (const FaceHandle face : faces) {
        const Vector3 part = area_vector(mesh, face);
        normal += part;
        centroid += part.norm() * face_centroid(mesh, face);
        area += part.norm();
    }
    if (!(normal.norm() > 0.5 * area)) return false;
    normal.normalize();
    centroid /= area;
    for (const FaceHandle face : faces) {
        // Slivers may lean any way within the tolerance.
        const double extent = area_vector(mesh, face).dot(normal);
        if (extent < -tolerance * std::sqrt(area)) return false;
        for (const VertexHandle vertex : face_vertices(mesh, face)) {
            if (!(std::abs(normal.dot(mesh.point(vertex) - centroid)) <= tolerance)) return false;
        }
    }
    return true;
}

Features detect_features(SurfaceMesh& mesh, const FeatureOptions& options) {
    check(options);
    std::vector<bool> is_feature(mesh.n_edges());
    for (const auto edge : mesh.edges()) {
        mesh.data(edge).feature = -1;
        is_feature[edge.idx()] =
            mesh.is_boundary(edge) || dihedral_angle(mesh, edge) > options.angle;
    }
    if (options.min_length > 0.0) drop_short(mesh, options.min_length, is_feature);

    const FeatureGraph graph(mesh, is_feature);
    std::vector<bool> is_corner(mesh.n_vertices(), false);
    for (const auto vertex : mesh.vertices()) {
        const std::size_t valence = graph.outgoing(vertex).size();
        is_corner[vertex.idx()] = valence == 1 || valence > 2 ||
                                  (valence == 2 && graph.turn(vertex) > options.corner_angle);
    }
    Features features;
    trace_curves(mesh, graph, is_corner, features.curves);
    features.corners = to_list(is_corner);
    features.regions = tag_regions(mesh, options);
    return features;
}

namespace {

// Tags the edges of a declared curve.
FeatureCurve declare_curve(SurfaceMesh& mesh, const std::vector<VertexHandle>& vertices,
                           int number) {
    FeatureCurve curve{.vertices = vertices};
    curve.is_closed = vertices.size() > 1 && vertices.front() == vertices.back();
    if (curve.is_closed) curve.vertices.pop_back();
    if (vertices.size() < 2 || (curve.is_closed && vertices.size() < 4)) {
        throw InputError(
            "tag_features: curve {} has {} vertices; an open curve needs two, a closed one four, "
            "the last equal to the first",
            number, vertices.size());
    }
    const auto n_vertices = static_cast<int>(mesh.n_vertices());
    for (const VertexHandle vertex : vertices) {
        if (vertex.idx() < 0 || vertex.idx() >= n_vertices) {
            throw InputError("tag_features: curve {} has vertex {}; the mesh has {}", number,
                             vertex.idx(), n_vertices);
        }
    }
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
        const HalfedgeHandle halfedge = mesh.find_halfedge(vertices[i], vertices[i + 1]);
        if (!halfedge.is_valid()) {
            throw TopologyError(
                "tag_features: curve {} goes from vertex {} to {}, which no edge joins; name every "
                "vertex on the way",
                number, vertices[i].idx(), vertices[i + 1].idx());
        }
        const EdgeHandle edge = mesh.edge_handle(halfedge);
        if (is_tagged(mesh, edge)) {
            throw TopologyError(
                "tag_features: the edge of vertices {} and {} stands in curves {} and {}; an edge "
                "belongs to one curve, once",
                vertices[i].idx(), vertices[i + 1].idx(), mesh.data(edge).feature, number);
        }
        if (i == 0) curve.is_boundary = mesh.is_boundary(edge);
        if (mesh.is_boundary(edge) != curve.is_boundary) {
            throw TopologyError(
                "tag_features: curve {} {} the boundary at vertex {}; split it there", number,
                curve.is_boundary ? "leaves" : "enters", vertices[i].idx());
        }
        mesh.data(edge).feature = number;
        curve.length += edge_length(mesh, edge);
    }
    return curve;
}

}  // namespace

Features tag_features(SurfaceMesh& mesh, std::span<const std::vector<VertexHandle>> curves,
                      const FeatureOptions& options) {
    check(options);
    for (const auto edge : mesh.edges()) mesh.data(edge).feature = -1;
    Features features;
    std::vector<bool> is_corner(mesh.n_vertices(), false);
    for (const auto& vertices : curves) {
        features.curves.push_back(
            declare_curve(mesh, vertices, static_cast<int>(features.curves.size())));
        if (features.curves.back().is_closed) continue;
        is_corner[vertices.front().idx()] = true;
        is_corner[vertices.back().idx()] = true;
    }
    std::vector<bool> is_feature(mesh.n_edges());
    std::vector<bool> is_rest(mesh.n_edges());
    for (const auto edge : mesh.edges()) {
        is_rest[edge.idx()] = mesh.is_boundary(edge) && !is_tagged(mesh, edge);
        is_feature[edge.idx()] = mesh.is_boundary(edge) || is_tagged(mesh, edge);
    }
    const FeatureGraph all(mesh, is_feature);
    const FeatureGraph rest(mesh, is_rest);
    for (const auto vertex : mesh.vertices()) {
        const auto& own = rest.outgoing(vertex);
        if (own.empty()) continue;
        // Where others meet a boundary curve, or where it turns.
        if (all.outgoing(vertex).size() != 2 || own.size() != 2 ||
            rest.turn(vertex) > options.corner_angle) {
            is_corner[vertex.idx()] = true;
        }
    }
    const int n_declared = static_cast<int>(features.curves.size());
    for (int i = 0; i < n_declared; ++i) {
        const auto& curve = features.curves[i];
        const std::size_t skip = curve.is_closed ? 0 : 1;
        for (std::size_t k = skip; k + skip < curve.vertices.size(); ++k) {
            const auto& meeting = all.outgoing(curve.vertices[k]);
            if (meeting.size() == 2 && !is_corner[curve.vertices[k].idx()]) continue;
            throw TopologyError(
                "tag_features: curve {} meets other curves, or itself, at vertex {} in its middle "
                "({} edges); split it there",
                i, curve.vertices[k].idx(), meeting.size());
        }
    }
    trace_curves(mesh, rest, is_corner, features.curves);
    features.corners = to_list(is_corner);
    features.regions = tag_regions(mesh, options);
    return features;
}

}  // namespace couture::meshing
