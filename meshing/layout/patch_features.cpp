#include "meshing/layout/patch_features.h"

#include <algorithm>
#include <map>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

HalfedgeHandle rotated(const SurfaceMesh& mesh, HalfedgeHandle h) {
    return mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
}

// Whether the solid fills less than half a turn around an edge.
bool is_convex(const SurfaceMesh& mesh, HalfedgeHandle h) {
    const Vector3 left = face_normal(mesh, mesh.face_handle(h));
    const Vector3 right = face_normal(mesh, mesh.face_handle(mesh.opposite_halfedge_handle(h)));
    const Vector3 along =
        mesh.point(mesh.to_vertex_handle(h)) - mesh.point(mesh.from_vertex_handle(h));
    return left.cross(right).dot(along) >= 0.0;
}

class Collector {
  public:
    Collector(const SurfaceMesh& mesh, const Features& features, const PantsDecomposition& pants)
        : mesh_(mesh), features_(features), pants_(pants), patches_(pants.patches.size()) {
        for (const VertexHandle corner : features.corners) corners_.insert(corner.idx());
    }

    std::vector<PatchFeatures> run() {
        for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
            for (const CurveSide& side : pants_.patches[p].boundary) add_loop(p, side);
        }
        for (const auto vertex : mesh_.vertices()) add_corner(vertex);
        for (const auto& [halfedge, end] : ends_) trace(HalfedgeHandle(halfedge), end);
        check_all_traced();
        return std::move(patches_);
    }

  private:
    struct End {
        int patch;
        int node;
        int position;
    };

    [[nodiscard]] bool is_inner_feature(HalfedgeHandle h) const {
        const EdgeHandle edge = mesh_.edge_handle(h);
        return mesh_.data(edge).feature >= 0 && mesh_.data(edge).curve < 0 &&
               !mesh_.is_boundary(edge);
    }

    [[nodiscard]] bool is_on_curve(VertexHandle v) const {
        return mesh_.is_boundary(v) || std::ranges::any_of(mesh_.ve_range(v), [&](EdgeHandle edge) {
                   return mesh_.data(edge).curve >= 0;
               });
    }

    void add_end(int patch, int node, HalfedgeHandle h) {
        auto& ends = patches_[patch].nodes[node].curve_ends;
        ends_[h.idx()] = {patch, node, static_cast<int>(ends.size())};
        ends.push_back(-1);
    }

    void add_loop(int patch, const CurveSide& side) {
        PatchFeatures& features = patches_[patch];
        const int number = static_cast<int>(features.loops.size());
        PatchFeatures::Loop loop{side, pants_.curves[side.curve].curve.vertices, {}};
        if (!side.is_left) std::reverse(loop.vertices.begin() + 1, loop.vertices.end());
        const std::size_t n = loop.vertices.size();
        for (std::size_t k = 0; k < n; ++k) {
            const VertexHandle v = loop.vertices[k];
            const HalfedgeHandle out = mesh_.find_halfedge(v, loop.vertices[(k + 1) % n]);
            const VertexHandle previous = loop.vertices[(k + n - 1) % n];
            int node = -1;
            for (HalfedgeHandle h = rotated(mesh_, out); mesh_.to_vertex_handle(h) != previous;
                 h = rotated(mesh_, h)) {
                if (!is_inner_feature(h)) continue;
                if (node < 0) {
                    node = static_cast<int>(features.nodes.size());
                    features.nodes.push_back({v, number, {}});
                    loop.nodes.push_back(node);
                }
                add_end(patch, node, h);
            }
        }
        features.loops.push_back(std::move(loop));
    }

    void add_corner(VertexHandle v) {
        if (is_on_curve(v)) return;
        std::vector<HalfedgeHandle> spokes;
        const HalfedgeHandle first = mesh_.halfedge_handle(v);
        HalfedgeHandle h = first;
        do {
            if (is_inner_feature(h)) spokes.push_back(h);
            h = rotated(mesh_, h);
        } while (h != first);
        if (spokes.empty() || (spokes.size() == 2 && !corners_.contains(v.idx()))) return;
        const int patch = pants_.patch_of_face[mesh_.face_handle(first).idx()];
        const int node = static_cast<int>(patches_[patch].nodes.size());
        patches_[patch].nodes.push_back({v, -1, {}});
        const auto name = features_.corner_names.find(v.idx());
        if (name != features_.corner_names.end()) patches_[patch].nodes.back().name = name->second;
        for (const HalfedgeHandle spoke : spokes) add_end(patch, node, spoke);
    }

    void trace(HalfedgeHandle h, const End& start) {
        PatchFeatures& features = patches_[start.patch];
        if (features.nodes[start.node].curve_ends[start.position] >= 0) return;
        const int number = static_cast<int>(features.curves.size());
        PatchFeatures::Curve curve{start.node, -1, ArcKind::convex, {mesh_.from_vertex_handle(h)}};
        curve.name = features_.curves[mesh_.data(mesh_.edge_handle(h)).feature].name;
        for (;;) {
            is_traced_.insert(mesh_.edge_handle(h).idx());
            curve.vertices.push_back(mesh_.to_vertex_handle(h));
            const HalfedgeHandle back = mesh_.opposite_halfedge_handle(h);
            const auto end = ends_.find(back.idx());
            if (end != ends_.end()) {
                curve.to = end->second.node;
                features.nodes[start.node].curve_ends[start.position] = 2 * number;
                features.nodes[curve.to].curve_ends[end->second.position] = 2 * number + 1;
                break;
            }
            h = rotated(mesh_, back);
            while (!is_inner_feature(h)) h = rotated(mesh_, h);
        }
        curve.kind = kind_along(mesh_, curve.vertices);
        features.curves.push_back(std::move(curve));
    }

    void check_all_traced() const {
        for (const auto edge : mesh_.edges()) {
            const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
            if (!is_inner_feature(h) || is_traced_.contains(edge.idx())) continue;
            const Vector3& x = mesh_.point(mesh_.to_vertex_handle(h));
            throw TopologyError(
                "layout: the sharp edge that passes ({:.6g}, {:.6g}, {:.6g}) is closed and has no "
                "corner; let a cut cross it, or open the surface at the plane face that it bounds",
                x.x(), x.y(), x.z());
        }
    }

    const SurfaceMesh& mesh_;
    const Features& features_;
    const PantsDecomposition& pants_;
    std::vector<PatchFeatures> patches_;
    std::set<int> corners_;
    // By the halfedge that starts there.
    std::map<int, End> ends_;
    std::set<int> is_traced_;
};

}  // namespace

ArcKind kind_along(const SurfaceMesh& mesh, std::span<const VertexHandle> path) {
    double bend = 0.0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const HalfedgeHandle h = mesh.find_halfedge(path[k], path[k + 1]);
        bend += edge_length(mesh, mesh.edge_handle(h)) * (is_convex(mesh, h) ? 1.0 : -1.0);
    }
    return bend >= 0.0 ? ArcKind::convex : ArcKind::reflex;
}

std::vector<PatchFeatures> find_patch_features(const SurfaceMesh& mesh, const Features& features,
                                               const PantsDecomposition& pants) {
    return Collector(mesh, features, pants).run();
}

}  // namespace couture::meshing
