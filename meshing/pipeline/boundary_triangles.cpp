#include "meshing/pipeline/boundary_triangles.h"

#include <algorithm>

#include "iga/core/error.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/volume/layout_cells.h"
#include "meshing/volume/layout_of_volume.h"

namespace couture::meshing {

namespace {

void check_input(const iga::MultiPatch<3>& volume, const BoundaryFeatures& features,
                 int n_per_element) {
    if (n_per_element < 1) {
        throw InputError("triangulate_boundary: {} cells per element; there must be 1 or more",
                         n_per_element);
    }
    if (const std::string own = iga::signature(volume); own != features.signature()) {
        throw TopologyError(
            "triangulate_boundary: the volume has signature {}, its features {}; they must be "
            "equal",
            own, features.signature());
    }
    for (int p = 0; p < volume.n_patches(); ++p) {
        if (features.orientation(p) < 0) {
            throw InputError(
                "triangulate_boundary: patch {} is left-handed; cuboids are right-handed: reverse "
                "one of its directions",
                p);
        }
    }
}

// Parameters of the grid lines of a knot vector, n per element.
std::vector<double> grid_lines(const iga::KnotVector& knots, int n) {
    const std::vector<double>& ends = knots.breakpoints();
    std::vector<double> lines;
    for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
        for (int i = 0; i < n; ++i) lines.push_back(ends[e] + (ends[e + 1] - ends[e]) * i / n);
    }
    lines.push_back(ends.back());
    return lines;
}

// The direction in which two neighbouring corners of a cuboid differ.
int direction_between(int corner, int other) {
    const int difference = corner ^ other;
    return difference == 1 ? 0 : difference == 2 ? 1 : 2;
}

// Points of an outer side, its corners as side_corners, s fastest.
MatrixX side_points(const iga::Volume& patch, int side, int n_per_element) {
    const std::array<int, 4>& corners = side_corners(side);
    const int along_s = direction_between(corners[0], corners[1]);
    const int along_t = direction_between(corners[1], corners[2]);
    std::array<std::vector<double>, 3> lines;
    Vector3 xi;
    for (int k = 0; k < 3; ++k) {
        lines[k] = grid_lines(patch.knots(k), n_per_element);
        const bool is_high = (corners[0] >> k & 1) != 0;
        xi[k] = is_high ? lines[k].back() : lines[k].front();
        // From corner 0 on.
        if (is_high) std::ranges::reverse(lines[k]);
    }
    const std::size_t n_s = lines[along_s].size();
    MatrixX points(3, static_cast<Eigen::Index>(n_s * lines[along_t].size()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        xi[along_s] = lines[along_s][static_cast<std::size_t>(i) % n_s];
        xi[along_t] = lines[along_t][static_cast<std::size_t>(i) / n_s];
        points.col(i) = patch.point(xi);
    }
    return points;
}

// Cells along each arc.
std::vector<int> cells_of(const iga::MultiPatch<3>& volume, const LayoutBoundary& boundary,
                          int n_per_element) {
    std::vector<int> cells(boundary.layout.n_arcs());
    for (int q = 0; q < boundary.layout.n_quads(); ++q) {
        const auto& [cuboid, side] = boundary.sides[q];
        const std::array<int, 4>& corners = side_corners(side);
        for (int k = 0; k < 4; ++k) {
            const int direction = direction_between(corners[k], corners[(k + 1) % 4]);
            cells[boundary.layout.sides(q)[k].arc] =
                n_per_element * volume.patches[cuboid].knots(direction).n_elements();
        }
    }
    return cells;
}

// Triangles of the grid's cells, quad by quad, each cell cut along its shorter diagonal.
struct GridTriangles {
    TriangleSoup soup;
    std::vector<int> quad_of_triangle;
    /// Of the grid's points; -1 for nodes inside the volume.
    std::vector<int> vertex_of_point;
};

GridTriangles triangles_of(const SampleGrid& grid, const MatrixX& points) {
    GridTriangles result;
    result.vertex_of_point.assign(grid.n_points, -1);
    for (const std::vector<int>& quad : grid.quads) {
        for (const int point : quad) {
            int& vertex = result.vertex_of_point[point];
            if (vertex >= 0) continue;
            vertex = static_cast<int>(result.soup.points.size());
            result.soup.points.emplace_back(points.col(point));
        }
    }
    for (std::size_t q = 0; q < grid.quads.size(); ++q) {
        const auto [n_s, n_t] = grid.sizes[q];
        for (int cell = 0; cell < n_s * n_t; ++cell) {
            const int first = cell / n_s * (n_s + 1) + cell % n_s;
            std::array<int, 4> v{first, first + 1, first + n_s + 2, first + n_s + 1};
            for (int& corner : v) corner = result.vertex_of_point[grid.quads[q][corner]];
            const auto length = [&](int a, int b) {
                return (result.soup.points[v[a]] - result.soup.points[v[b]]).norm();
            };
            if (length(0, 2) > length(1, 3)) std::ranges::rotate(v, v.begin() + 1);
            result.soup.triangles.push_back({v[0], v[1], v[2]});
            result.soup.triangles.push_back({v[0], v[2], v[3]});
            result.quad_of_triangle.insert(result.quad_of_triangle.end(), 2, static_cast<int>(q));
        }
    }
    return result;
}

// Marks the features of a volume on its drawn layout.
class FeatureMarker {
  public:
    FeatureMarker(const VolumetricLayout& layout, const iga::MultiPatch<3>& volume,
                  CuboidDecomposition& result)
        : layout_(layout), volume_(volume), result_(result) {}

    void run(const BoundaryFeatures& features) {
        mark_corners(features);
        for (std::size_t c = 0; c < features.curves().size(); ++c) {
            for (const iga::PatchEntity<3>& edge : features.curves()[c]) {
                mark_arc(arc_of(edge), static_cast<int>(c));
            }
        }
        for (const auto& [name, entities] : volume_.boundary_sets) {
            for (const iga::PatchEntity<3>& entity : entities) check_named(name, entity);
        }
    }

  private:
    // The node of a patch's edge or corner at an end of the edge's free direction.
    [[nodiscard]] int node_of(iga::PatchEntity<3> entity, iga::End end) const {
        std::ranges::replace(entity.position, iga::End::free, end);
        return layout_.cuboids[entity.patch][corner_at(entity.position)];
    }

    // -1 for one inside the volume.
    [[nodiscard]] int arc_of(const iga::PatchEntity<3>& edge) const {
        return result_.surface.layout.find_arc(node_of(edge, iga::End::low),
                                               node_of(edge, iga::End::high));
    }

    void mark_corners(const BoundaryFeatures& features) {
        for (int p = 0; p < volume_.n_patches(); ++p) {
            const iga::TensorSpace<3>& space = volume_.patches[p].space();
            for (int corner = 0; corner < 8; ++corner) {
                std::array<int, 3> at{};
                for (int k = 0; k < 3; ++k) {
                    at[k] = (corner >> k & 1) != 0 ? space.sizes()[k] - 1 : 0;
                }
                const int dof = features.dofs().global[p][space.index(at)];
                if (features.freedom(dof) != Freedom::fixed) continue;
                result_.surface.is_corner_node[layout_.cuboids[p][corner]] = true;
            }
        }
    }

    void mark_arc(int arc, int curve) {
        if (arc < 0) return;
        result_.surface.is_feature_arc[arc] = true;
        const std::vector<VertexHandle>& path = result_.surface.arcs[arc];
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const HalfedgeHandle h = result_.mesh.find_halfedge(path[k], path[k + 1]);
            result_.mesh.data(result_.mesh.edge_handle(h)).feature = curve;
        }
    }

    void check_named(const std::string& name, const iga::PatchEntity<3>& entity) {
        bool is_outside = true;
        if (entity.is_side()) {
            const CuboidSide side{entity.patch, entity.side()};
            is_outside = std::ranges::find(result_.sides, side) != result_.sides.end();
        } else if (entity.dimension() == 1) {
            is_outside = arc_of(entity) >= 0;
        } else {
            const int node = node_of(entity, iga::End::low);
            is_outside = result_.surface.nodes[node].is_valid();
            result_.surface.is_corner_node[node] = true;
        }
        if (!is_outside) {
            throw TopologyError(
                "triangulate_boundary: boundary set '{}' names {}, which lies inside the volume; a "
                "surface does not show it",
                name, entity.name());
        }
    }

    const VolumetricLayout& layout_;
    const iga::MultiPatch<3>& volume_;
    CuboidDecomposition& result_;
};

std::vector<int> elements_of_sheets(const iga::MultiPatch<3>& volume, const LayoutCells& cells) {
    std::vector<int> elements(cells.n_sheets());
    for (int p = 0; p < volume.n_patches(); ++p) {
        for (int i = 0; i < 12; ++i) {
            elements[cells.sheets[cells.cuboid_edges[p][i]]] =
                volume.patches[p].knots(i / 4).n_elements();
        }
    }
    return elements;
}

}  // namespace

CuboidDecomposition triangulate_boundary(const iga::MultiPatch<3>& volume,
                                         const BoundaryFeatures& features, int n_per_element) {
    check_input(volume, features, n_per_element);
    CuboidDecomposition result;
    result.volume = layout_of_volume(volume);
    const LayoutBoundary boundary = layout_boundary(result.volume);
    const SampleGrid grid =
        make_sample_grid(boundary.layout, cells_of(volume, boundary, n_per_element));
    MatrixX points(3, grid.n_points);
    for (std::size_t q = 0; q < boundary.sides.size(); ++q) {
        const auto& [cuboid, side] = boundary.sides[q];
        points(Eigen::all, grid.quads[q]) =
            side_points(volume.patches[cuboid], side, n_per_element);
    }
    GridTriangles triangles = triangles_of(grid, points);
    result.mesh = make_surface_mesh(triangles.soup);
    result.sides = boundary.sides;
    result.surface.layout = boundary.layout;
    result.surface.quad_of_face = std::move(triangles.quad_of_triangle);
    result.surface.is_corner_node.assign(boundary.layout.n_nodes(), false);
    result.surface.is_feature_arc.assign(boundary.layout.n_arcs(), false);
    for (int n = 0; n < boundary.layout.n_nodes(); ++n) {
        result.surface.nodes.emplace_back(triangles.vertex_of_point[n]);
    }
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        std::vector<VertexHandle>& path = result.surface.arcs.emplace_back();
        for (const int point : grid.arcs[a]) path.emplace_back(triangles.vertex_of_point[point]);
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const HalfedgeHandle h = result.mesh.find_halfedge(path[k], path[k + 1]);
            result.mesh.data(result.mesh.edge_handle(h)).curve = a;
        }
    }
    FeatureMarker(result.volume, volume, result).run(features);
    result.record.elements = elements_of_sheets(volume, make_layout_cells(result.volume));
    result.record.sets = result.volume.sets;
    return result;
}

}  // namespace couture::meshing
