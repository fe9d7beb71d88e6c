#include "meshing/topology/tight_loop.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "meshing/surface/shortest_paths.h"
#include "meshing/topology/cylinder_cycle.h"

namespace couture::meshing {

namespace {

// Of the part of a mesh between its curves in which a path runs.
class Tightener {
  public:
    Tightener(const SurfaceMesh& mesh, VertexHandle inside,
              const std::function<double(VertexHandle)>& factor)
        : mesh_(mesh), factor_(factor) {
        const std::vector<int> region = regions_between_curves(mesh);
        const int here = region[(*mesh.cvf_begin(inside)).idx()];
        for (const auto face : mesh.faces()) {
            if (region[face.idx()] == here) faces_.push_back(face);
        }
        piece_ = CutSurface(mesh, faces_, curve_seams(mesh));
        is_boundary_ = boundary_vertices(piece_);
        number_.assign(mesh.n_vertices(), -1);
        for (int v = 0; v < piece_.n_vertices(); ++v) number_[piece_.parent(v)] = v;
    }

    [[nodiscard]] double weight(const SurfaceCurve& curve) const {
        double sum = 0.0;
        for (const HalfedgeHandle h : curve_halfedges(mesh_, curve)) {
            sum += 0.5 *
                   (factor_(mesh_.from_vertex_handle(h)) + factor_(mesh_.to_vertex_handle(h))) *
                   edge_length(mesh_, mesh_.edge_handle(h));
        }
        return sum;
    }

    // The shortest loop in an annulus around this one; nothing if there is no annulus.
    [[nodiscard]] std::optional<SurfaceCurve> tighten(const SurfaceCurve& curve,
                                                      double radius) const {
        std::vector<int> sources;
        for (const VertexHandle vertex : curve.vertices) sources.push_back(number_[vertex.idx()]);
        ShortestPaths search(piece_);
        search.run({.sources = sources, .is_blocked = &is_boundary_, .limit = radius});
        constexpr int n_radii = 5;
        for (int k = 0; k < n_radii; ++k, radius *= 0.5) {
            std::vector<FaceHandle> around;
            for (int f = 0; f < piece_.n_faces(); ++f) {
                const auto triangle = piece_.triangle(f);
                if (std::all_of(triangle.begin(), triangle.end(),
                                [&](int v) { return search.distance(v) <= radius; })) {
                    around.emplace_back(faces_[f]);
                }
            }
            if (around.empty()) return std::nullopt;
            if (auto found = shortest_in(around, curve)) return found;
        }
        return std::nullopt;
    }

  private:
    [[nodiscard]] std::vector<double> factors(const CutSurface& piece) const {
        std::vector<double> factor;
        for (int v = 0; v < piece.n_vertices(); ++v) {
            factor.push_back(factor_(VertexHandle(piece.parent(v))));
        }
        return factor;
    }

    [[nodiscard]] std::optional<SurfaceCurve> shortest_in(const std::vector<FaceHandle>& faces,
                                                          const SurfaceCurve& curve) const {
        const CutSurface annulus(mesh_, faces, curve_seams(mesh_));
        const auto component = annulus.face_components();
        if (*std::max_element(component.begin(), component.end()) > 0 ||
            annulus.euler_characteristic() != 0 || annulus.boundary_loops().size() != 2) {
            return std::nullopt;
        }
        // Which of the two ends lies on the left, and that the curve goes around at all.
        std::vector<int> number(mesh_.n_vertices(), -1);
        for (int v = 0; v < annulus.n_vertices(); ++v) number[annulus.parent(v)] = v;
        std::vector<int> path;
        for (std::size_t k = 0; k < curve.vertices.size(); ++k) {
            const int u = number[curve.vertices[k].idx()];
            const int v = number[curve.vertices[(k + 1) % curve.vertices.size()].idx()];
            const int h = u < 0 || v < 0 ? -1 : annulus.find_halfedge(u, v);
            if (h < 0 || annulus.is_boundary_vertex(u)) return std::nullopt;
            path.push_back(h);
        }
        CutSurface halves = annulus;
        halves.slice(path);
        const auto side = halves.face_components();
        const int left = side[CutSurface::face(path.front())];
        if (*std::max_element(side.begin(), side.end()) != 1 ||
            halves.boundary_loops().size() != 4) {
            return std::nullopt;
        }
        const auto ends = annulus.boundary_loops();
        const bool first_is_left = side[CutSurface::face(ends[0].front())] == left;
        Cutting cutting{annulus, factors(annulus)};
        const auto found =
            find_cycle_around(cutting, ends[first_is_left ? 0 : 1], ends[first_is_left ? 1 : 0],
                              boundary_vertices(annulus));
        if (!found || found->vertices.size() < 3) return std::nullopt;
        SurfaceCurve shorter;
        for (const int v : found->vertices) {
            shorter.vertices.emplace_back(annulus.parent(v));
        }
        return shorter;
    }

    const SurfaceMesh& mesh_;
    const std::function<double(VertexHandle)>& factor_;
    std::vector<FaceHandle> faces_;
    CutSurface piece_;
    std::vector<char> is_boundary_;
    // Vertex of the piece for each vertex of the mesh.
    std::vector<int> number_;
};

}  // namespace

SurfaceCurve tighten_loop(const SurfaceMesh& mesh, SurfaceCurve curve, double radius,
                          const std::function<double(VertexHandle)>& factor) {
    const Tightener tightener(mesh, curve.vertices.front(), factor);
    constexpr int max_rounds = 100;
    // What is less comes of rounding.
    constexpr double worth_going_on = 1e-12;
    double before = tightener.weight(curve);
    for (int round = 0; round < max_rounds; ++round) {
        const auto tighter = tightener.tighten(curve, radius);
        if (!tighter) break;
        const double after = tightener.weight(*tighter);
        if (after >= (1.0 - worth_going_on) * before) break;
        curve = *tighter;
        before = after;
    }
    return curve;
}

}  // namespace couture::meshing
