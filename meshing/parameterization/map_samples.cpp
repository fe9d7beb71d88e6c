#include "meshing/parameterization/map_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/parameterization/chart_vertices.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/surface/planar_map.h"

namespace couture::meshing {

namespace {

/// A face and how its chart lies in another one.
struct PlacedFace {
    FaceHandle face;
    ChartTransition placement;
};

/// The faces of a map unfolded into its charts.
class Unfolding {
  public:
    Unfolding(const SurfaceMesh& mesh, const EmbeddedLayout& embedding, const LayoutMap& map)
        : mesh_(mesh),
          embedding_(embedding),
          map_(map),
          arcs_of_edges_(arcs_of_edges(mesh, embedding)) {}

    [[nodiscard]] std::array<Vector2, 3> corners(const PlacedFace& placed) const {
        std::array<Vector2, 3> result = map_.corners[placed.face.idx()];
        for (Vector2& corner : result) corner = placed.placement(corner);
        return result;
    }

    /// All faces that meet the inside of a quad's chart, placed there.
    [[nodiscard]] std::vector<PlacedFace> cover(int quad) const {
        std::vector<PlacedFace> faces{first_face(quad)};
        std::set<std::tuple<int, int, double, double>> is_met;
        const auto meet = [&](const PlacedFace& f) {
            const Vector2& shift = f.placement.shift;
            return is_met.emplace(f.face.idx(), f.placement.quarter_turns, shift.x(), shift.y())
                .second;
        };
        meet(faces.front());
        const auto [n_s, n_t] = map_.charts.size(quad);
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const PlacedFace placed = faces[i];
            const auto at = corners(placed);
            HalfedgeHandle h = mesh_.halfedge_handle(placed.face);
            for (int k = 0; k < 3; ++k, h = mesh_.next_halfedge_handle(h)) {
                if (mesh_.is_boundary(mesh_.opposite_halfedge_handle(h)) ||
                    !meets_inside(at[k], at[(k + 1) % 3], n_s, n_t)) {
                    continue;
                }
                const PlacedFace next = across(placed, h);
                if (meet(next)) faces.push_back(next);
            }
        }
        return faces;
    }

  private:
    /// Whether a segment meets the inside of [0, n_s] x [0, n_t].
    static bool meets_inside(const Vector2& a, const Vector2& b, double n_s, double n_t) {
        constexpr double margin = 1e-9;
        double begin = 0.0;
        double end = 1.0;
        for (int k = 0; k < 2; ++k) {
            const double low = margin;
            const double high = (k == 0 ? n_s : n_t) - margin;
            const double d = b[k] - a[k];
            if (d == 0.0) {
                if (a[k] < low || a[k] > high) return false;
                continue;
            }
            const auto [first, last] = std::minmax({(low - a[k]) / d, (high - a[k]) / d});
            begin = std::max(begin, first);
            end = std::min(end, last);
        }
        return begin <= end;
    }

    /// The face across a halfedge of a placed one.
    [[nodiscard]] PlacedFace across(const PlacedFace& placed, HalfedgeHandle h) const {
        const FaceHandle next = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
        const int arc = arcs_of_edges_[mesh_.edge_handle(h).idx()];
        if (arc < 0) return {next, placed.placement};
        const ChartTransition& transition = map_.charts.across(arc);
        const bool is_next_left =
            embedding_.layout.arc_quads(arc)[0].quad == embedding_.quad_of_face[next.idx()];
        return {next, placed.placement.after(is_next_left ? transition : transition.inverse())};
    }

    /// The face at corner 0 of a quad that has part of the chart's inside: found by turning around
    /// the node from a face of the quad on.
    [[nodiscard]] PlacedFace first_face(int quad) const {
        const VertexHandle node = embedding_.nodes[embedding_.layout.quads()[quad][0]];
        HalfedgeHandle spoke;
        for (const HalfedgeHandle h : mesh_.voh_range(node)) {
            const FaceHandle face = mesh_.face_handle(h);
            if (face.is_valid() && embedding_.quad_of_face[face.idx()] == quad) spoke = h;
        }
        PlacedFace placed{mesh_.face_handle(spoke), {}};
        auto [begin, width] = sector(placed, spoke);
        constexpr double quarter = 0.5 * std::numbers::pi;
        constexpr double margin = 1e-6;
        const int valence = static_cast<int>(mesh_.valence(node));
        for (int i = 0; i <= valence; ++i) {
            if (begin + width > margin && begin < quarter - margin) return placed;
            if (begin >= quarter - margin) {
                // Clockwise, across the spoke.
                if (mesh_.is_boundary(mesh_.opposite_halfedge_handle(spoke))) break;
                placed = across(placed, spoke);
                spoke = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(spoke));
                width = sector(placed, spoke).second;
                begin -= width;
            } else {
                const HalfedgeHandle back =
                    mesh_.next_halfedge_handle(mesh_.next_halfedge_handle(spoke));
                if (mesh_.is_boundary(mesh_.opposite_halfedge_handle(back))) break;
                placed = across(placed, back);
                spoke = mesh_.opposite_halfedge_handle(back);
                begin += width;
                width = sector(placed, spoke).second;
            }
        }
        throw GeometryError(
            "sample_layout_map: no face around node {} (vertex {}) covers corner 0 of quad {}; the "
            "map is not seamless there",
            embedding_.layout.quads()[quad][0], node.idx(), quad);
    }

    /// Angle of a spoke at its start and that of its face there.
    [[nodiscard]] std::pair<double, double> sector(const PlacedFace& placed,
                                                   HalfedgeHandle spoke) const {
        const auto at = corners(placed);
        int k = 0;
        for (HalfedgeHandle h = mesh_.halfedge_handle(placed.face); h != spoke;
             h = mesh_.next_halfedge_handle(h)) {
            ++k;
        }
        const Vector2 a = at[(k + 1) % 3] - at[k];
        const Vector2 b = at[(k + 2) % 3] - at[k];
        return {std::atan2(a.y(), a.x()), std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))};
    }

    const SurfaceMesh& mesh_;
    const EmbeddedLayout& embedding_;
    const LayoutMap& map_;
    std::vector<int> arcs_of_edges_;
};

/// Where a grid point lies.
struct GridPlace {
    FaceHandle face;
    Vector3 weights;
    // Smallest weight, not cut off at zero.
    double depth = -1e-6;
};

/// Improves the places of the grid points in a triangle.
void locate(const std::array<Vector2, 3>& at, FaceHandle face, const std::array<int, 2>& size,
            std::vector<GridPlace>& places) {
    constexpr double margin = 1e-9;
    std::array<int, 2> low{};
    std::array<int, 2> high{};
    for (int k = 0; k < 2; ++k) {
        const auto [least, most] = std::minmax({at[0][k], at[1][k], at[2][k]});
        low[k] = static_cast<int>(std::ceil(std::clamp(least - margin, 0.0, size[k] + 1.0)));
        high[k] = static_cast<int>(std::floor(std::clamp(most + margin, -1.0, 0.0 + size[k])));
    }
    const auto cross = [](const Vector2& a, const Vector2& b) {
        return a.x() * b.y() - a.y() * b.x();
    };
    const double area = cross(at[1] - at[0], at[2] - at[0]);
    for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
            const Vector2 point(i, j);
            double depth = 1.0;
            for (int k = 0; k < 3; ++k) {
                const Vector2& a = at[(k + 1) % 3];
                depth = std::min(depth, cross(at[(k + 2) % 3] - a, point - a) / area);
            }
            GridPlace& place = places[j * (size[0] + 1) + i];
            if (depth > place.depth) {
                place = {face, barycentric_weights(point, at), depth};
            }
        }
    }
}

}  // namespace

LayoutSamples sample_layout_map(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                const LayoutMap& map, int n_per_cell) {
    if (n_per_cell < 1) {
        throw InputError("sample_layout_map: {} parts of each cell; there must be 1 or more",
                         n_per_cell);
    }
    std::vector<int> cells = map.charts.cells();
    for (int& n : cells) n *= n_per_cell;
    const SampleGrid grid = make_sample_grid(embedding.layout, cells);
    const Unfolding unfolding(mesh, embedding, map);
    MatrixX points(3, grid.n_points);
    std::vector<bool> is_known(grid.n_points, false);
    for (int n = 0; n < embedding.layout.n_nodes(); ++n) {
        if (!embedding.nodes[n].is_valid()) continue;
        points.col(n) = mesh.point(embedding.nodes[n]);
        is_known[n] = true;
    }
    for (int q = 0; q < embedding.layout.n_quads(); ++q) {
        std::vector<GridPlace> places(grid.quads[q].size());
        for (const PlacedFace& placed : unfolding.cover(q)) {
            auto at = unfolding.corners(placed);
            for (Vector2& corner : at) corner *= n_per_cell;
            locate(at, placed.face, grid.sizes[q], places);
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            const int number = grid.quads[q][i];
            if (is_known[number]) continue;
            if (!places[i].face.is_valid()) {
                throw GeometryError(
                    "sample_layout_map: quad {}: grid point {} of {} x {} cells is covered by no "
                    "face; the map is not seamless there",
                    q, i, grid.sizes[q][0], grid.sizes[q][1]);
            }
            const auto vertices = face_vertices(mesh, places[i].face);
            Vector3 point = Vector3::Zero();
            for (int k = 0; k < 3; ++k) {
                point += places[i].weights[k] * mesh.point(vertices[k]);
            }
            points.col(number) = point;
            is_known[number] = true;
        }
    }
    return to_samples(embedding, std::move(cells), grid, points);
}

}  // namespace couture::meshing
