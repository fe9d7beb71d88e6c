#include "meshing/topology/traced_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/cylinder_cycle.h"
#include "meshing/topology/tight_loop.h"

namespace couture::meshing {

namespace {

class Tracer {
  public:
    Tracer(SurfaceMesh& mesh, const GuideLoop& guide, double width)
        : mesh_(mesh), guide_(guide), width_(width) {}

    SurfaceCurve run() {
        check();
        choose_region();
        const SurfaceCurve curve{follow(), true};
        return tighten_loop(mesh_, curve, 2.0 * width_,
                            [&](VertexHandle vertex) { return factor(mesh_.point(vertex)); });
    }

  private:
    void check() const {
        const std::size_t n = guide_.points.size();
        if (n < 3) throw InputError("loop: {} points; a closed curve needs at least 3", n);
        if (!guide_.normals.empty() && guide_.normals.size() != n) {
            throw InputError("loop: {} normals for {} points; give one each or none",
                             guide_.normals.size(), n);
        }
        if (!(width_ > 0.0) || !std::isfinite(width_)) {
            throw InputError("loop: width {}; it must be positive", width_);
        }
        for (std::size_t k = 0; k < n; ++k) {
            if (!guide_.points[k].allFinite()) {
                throw InputError("loop: point {} is not finite", k);
            }
        }
    }

    [[nodiscard]] bool is_free(VertexHandle vertex) const {
        if (mesh_.is_isolated(vertex) || mesh_.is_boundary(vertex)) return false;
        const auto edges = mesh_.ve_range(vertex);
        return std::none_of(edges.begin(), edges.end(),
                            [&](EdgeHandle edge) { return mesh_.data(edge).curve >= 0; });
    }

    // The free vertex nearest to each point; on the right side of the wall, if normals are given.
    // An invalid handle where there is none.
    [[nodiscard]] std::vector<VertexHandle> nearest(int region) const {
        const std::size_t n = guide_.points.size();
        std::vector<VertexHandle> best(n);
        std::vector<double> least(n, std::numeric_limits<double>::infinity());
        for (const auto vertex : mesh_.vertices()) {
            if (!is_free(vertex)) continue;
            if (region >= 0 && region_of_face_[(*mesh_.cvf_begin(vertex)).idx()] != region) {
                continue;
            }
            const Vector3& x = mesh_.point(vertex);
            for (std::size_t k = 0; k < n; ++k) {
                double distance = (x - guide_.points[k]).norm();
                if (distance >= least[k]) continue;
                if (!guide_.normals.empty() &&
                    vertex_normal(mesh_, vertex).dot(guide_.normals[k]) < 0.0) {
                    distance += mesh_size_;
                    if (distance >= least[k]) continue;
                }
                least[k] = distance;
                best[k] = vertex;
            }
        }
        return best;
    }

    // Curves divide the surface: the guide runs where most of its points do.
    void choose_region() {
        mesh_size_ = bounding_box_diagonal(mesh_);
        // On coarse meshes points of the surface may be far from all vertices.
        double longest_edge = 0.0;
        for (const auto edge : mesh_.edges()) {
            longest_edge = std::max(longest_edge, edge_length(mesh_, edge));
        }
        region_of_face_ = regions_between_curves(mesh_);
        std::map<int, int> votes;
        const auto anywhere = nearest(-1);
        const double limit = std::max(0.1 * mesh_size_, longest_edge);
        for (std::size_t k = 0; k < anywhere.size(); ++k) {
            if (!anywhere[k].is_valid()) {
                throw TopologyError("loop: the surface has no vertex that is free of curves");
            }
            const double distance = (mesh_.point(anywhere[k]) - guide_.points[k]).norm();
            if (distance > limit) {
                throw InputError(
                    "loop: point {} at ({:.6g}, {:.6g}, {:.6g}) lies {:.3g} away from the nearest "
                    "vertex of the surface; it must be within {:.3g}",
                    k, guide_.points[k].x(), guide_.points[k].y(), guide_.points[k].z(), distance,
                    limit);
            }
            ++votes[region_of_face_[(*mesh_.cvf_begin(anywhere[k])).idx()]];
        }
        const int region =
            std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                return a.second < b.second;
            })->first;
        anchors_ = nearest(region);
        check_side(region, limit);
        for (const auto face : mesh_.faces()) {
            if (region_of_face_[face.idx()] == region) faces_.push_back(face);
        }
    }

    // Points may lie behind a curve by so much as they may lie off the surface.
    void check_side(int region, double limit) const {
        for (std::size_t k = 0; k < anchors_.size(); ++k) {
            const Vector3& point = guide_.points[k];
            if ((mesh_.point(anchors_[k]) - point).norm() <= limit) continue;
            throw TopologyError(
                "loop: point {} at ({:.6g}, {:.6g}, {:.6g}) lies on the other side of curve {} "
                "than most of its points; given loops must not cross: move the points of one of "
                "the two or leave it out",
                k, point.x(), point.y(), point.z(), curve_beside(region, point));
        }
    }

    // Of the curves that bound a region, the one nearest to a point.
    [[nodiscard]] int curve_beside(int region, const Vector3& point) const {
        int nearest_curve = -1;
        double least = std::numeric_limits<double>::infinity();
        for (const auto edge : mesh_.edges()) {
            if (mesh_.data(edge).curve < 0) continue;
            const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
            const HalfedgeHandle twin = mesh_.opposite_halfedge_handle(h);
            if (region_of_face_[mesh_.face_handle(h).idx()] != region &&
                region_of_face_[mesh_.face_handle(twin).idx()] != region) {
                continue;
            }
            const double distance = (mesh_.point(mesh_.from_vertex_handle(h)) - point).norm();
            if (distance >= least) continue;
            least = distance;
            nearest_curve = mesh_.data(edge).curve;
        }
        return nearest_curve;
    }

    [[nodiscard]] double factor(const Vector3& x) const {
        const double d = distance_to_loop(x, guide_.points) / width_;
        return 1.0 + d * d;
    }

    [[nodiscard]] std::vector<double> factors(const CutSurface& piece) const {
        std::vector<double> of_vertex(piece.n_vertices());
        for (int v = 0; v < piece.n_vertices(); ++v) of_vertex[v] = factor(piece.point(v));
        return of_vertex;
    }

    // Shortest paths from anchor to anchor; what a path runs twice is left out.
    std::vector<VertexHandle> follow() {
        CutSurface piece(mesh_, faces_, curve_seams(mesh_));
        piece.split_chords();
        const std::vector<double> of_vertex = factors(piece);
        const std::vector<char> is_blocked = boundary_vertices(piece);
        std::map<int, int> number;
        for (int v = 0; v < piece.n_vertices(); ++v) {
            if (piece.parent(v) >= 0) number[piece.parent(v)] = v;
        }
        std::vector<int> stops;
        for (const VertexHandle anchor : anchors_) {
            const int v = number.at(anchor.idx());
            if (stops.empty() || stops.back() != v) stops.push_back(v);
        }
        while (stops.size() > 1 && stops.back() == stops.front()) stops.pop_back();
        ShortestPaths search(piece, &of_vertex);
        std::vector<int> walk;
        for (std::size_t k = 0; k < stops.size(); ++k) {
            const int source = stops[k];
            const int target = stops[(k + 1) % stops.size()];
            std::vector<char> is_target(piece.n_vertices(), 0);
            is_target[target] = 1;
            const int reached = search.run(
                {.sources = {&source, 1}, .is_blocked = &is_blocked, .is_target = &is_target});
            if (reached < 0) {
                throw TopologyError(
                    "loop: no way from ({:.6g}, {:.6g}, {:.6g}) to the next point that crosses no "
                    "other curve and no boundary; given loops must not cross: move the points of "
                    "this one or leave one out",
                    piece.point(source).x(), piece.point(source).y(), piece.point(source).z());
            }
            auto vertices = search.vertices_to(reached);
            vertices.pop_back();
            walk.insert(walk.end(), vertices.begin(), vertices.end());
        }
        const std::vector<int> simple = without_detours(piece, walk);
        if (simple.size() < 3) {
            throw TopologyError(
                "loop: on this mesh it shrinks to {} vertices near ({:.6g}, {:.6g}, {:.6g}); its "
                "points must run around something larger than a triangle",
                simple.size(), guide_.points.front().x(), guide_.points.front().y(),
                guide_.points.front().z());
        }
        const auto handles = embed_splits(mesh_, piece);
        std::vector<VertexHandle> vertices;
        for (const int v : simple) vertices.push_back(handles[v]);
        return vertices;
    }

    // Wherever a closed walk meets itself, the shorter of its two parts is left out.
    static std::vector<int> without_detours(const CutSurface& piece, const std::vector<int>& walk) {
        const auto length = [&](const std::vector<int>& vertices, std::size_t first,
                                std::size_t end) {
            double sum = 0.0;
            for (std::size_t k = first; k < end; ++k) {
                sum += (piece.point(vertices[(k + 1) % vertices.size()]) - piece.point(vertices[k]))
                           .norm();
            }
            return sum;
        };
        const double whole = length(walk, 0, walk.size());
        std::vector<int> simple;
        std::map<int, std::size_t> place;
        for (const int v : walk) {
            if (const auto met = place.find(v); met != place.end()) {
                const std::size_t first = met->second;
                simple.push_back(v);
                const double loop = length(simple, first, simple.size() - 1);
                if (loop > 0.5 * whole) {
                    // The way until here was the detour.
                    simple.erase(simple.begin(),
                                 simple.begin() + static_cast<std::ptrdiff_t>(first));
                    simple.pop_back();
                    return simple;
                }
                simple.pop_back();
                for (std::size_t k = first + 1; k < simple.size(); ++k) place.erase(simple[k]);
                simple.resize(first + 1);
                continue;
            }
            place[v] = simple.size();
            simple.push_back(v);
        }
        return simple;
    }

    SurfaceMesh& mesh_;
    const GuideLoop& guide_;
    double width_;
    double mesh_size_ = 0.0;
    std::vector<int> region_of_face_;
    std::vector<FaceHandle> faces_;
    std::vector<VertexHandle> anchors_;
};

}  // namespace

double distance_to_loop(const Vector3& x, const std::vector<Vector3>& loop) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vector3& a = loop[k];
        const Vector3 along = loop[(k + 1) % loop.size()] - a;
        const double squared = along.squaredNorm();
        const double t = squared > 0.0 ? std::clamp((x - a).dot(along) / squared, 0.0, 1.0) : 0.0;
        least = std::min(least, (x - a - t * along).squaredNorm());
    }
    return std::sqrt(least);
}

SurfaceCurve trace_loop(SurfaceMesh& mesh, const GuideLoop& guide, double width) {
    return Tracer(mesh, guide, width).run();
}

}  // namespace couture::meshing
