#include "meshing/pipeline/remesh_solid.h"

#include <algorithm>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "meshing/pipeline/boundary_triangles.h"
#include "meshing/surface/self_intersection.h"

namespace couture::meshing {

namespace {

// What splines of degree 1 show exactly, and higher ones bend within a thousandth of an element.
constexpr int cells_per_degree = 2;

void check_weights(const iga::MultiPatch<3>& body) {
    for (int p = 0; p < body.n_patches(); ++p) {
        if (body.patches[p].is_rational()) {
            throw InputError(
                "remesh: patch {} has weights; new splines have none: take geometry = "
                "\"interpolated\" in [discretization]",
                p);
        }
    }
}

int cells_per_element(const iga::MultiPatch<3>& body) {
    int degree = 1;
    for (const iga::Volume& patch : body.patches) {
        for (int k = 0; k < 3; ++k) degree = std::max(degree, patch.knots(k).degree());
    }
    return cells_per_degree * degree;
}

void check_boundary(const SurfaceMesh& mesh) {
    const SelfIntersections found = find_self_intersections(to_soup(mesh));
    if (found.crossings.empty()) return;
    throw GeometryError(
        "remesh: the body's boundary meets itself: {}{} pairs of its triangles cross or touch, the "
        "first near {}; a body that folds onto itself can't be meshed: end the run before, or "
        "remesh earlier",
        found.is_cut_short ? "more than " : "", found.crossings.size(),
        format_point(found.crossings.front().position));
}

// Knots of the layout's edges, from 0 to 1.
std::vector<iga::KnotVector> knots_of_edges(const iga::MultiPatch<3>& body,
                                            const VolumetricLayout& layout) {
    const LayoutCells cells = make_layout_cells(layout);
    std::vector<iga::KnotVector> knots(cells.edges.size(), iga::KnotVector::uniform(1, 1));
    for (int p = 0; p < body.n_patches(); ++p) {
        for (int i = 0; i < 12; ++i) {
            const auto [a, b] = iga::tangential_directions<3>(2 * (i / 4));
            const int low = (i & 1) << a | (i >> 1 & 1) << b;
            const auto& nodes = layout.cuboids[p];
            const iga::KnotVector own = body.patches[p].knots(i / 4).rescaled(0.0, 1.0);
            knots[cells.cuboid_edges[p][i]] =
                nodes[low] < nodes[low | 1 << (i / 4)] ? own : own.reversed();
        }
    }
    return knots;
}

}  // namespace

void check_remeshable(const iga::MultiPatch<3>& body, const BoundaryFeatures& features) {
    check_weights(body);
    static_cast<void>(triangulate_boundary(body, features, 1));
}

RemeshedSolid remesh_solid(const iga::MultiPatch<3>& deformed, const BoundaryFeatures& features) {
    check_weights(deformed);
    CuboidDecomposition cuboids =
        triangulate_boundary(deformed, features, cells_per_element(deformed));
    check_boundary(cuboids.mesh);
    RemeshedSolid result;
    result.n_triangles = static_cast<int>(cuboids.mesh.n_faces());
    SolidMeshOptions options;
    options.volume.knots = knots_of_edges(deformed, cuboids.volume);
    SolidMesh solid = mesh_solid(std::move(cuboids), options);
    result.relocation = *solid.relocation;
    const auto& parameterization = solid.volume->report.parameterization;
    if (parameterization.validity != iga::Validity::valid) {
        throw GeometryError(
            "remesh: the new volume is {} in patch {}, its smallest Bernstein coefficient of det J "
            "is {:.3g}: the body is too distorted for its layout; remesh earlier",
            iga::to_string(parameterization.validity), parameterization.worst_patch,
            parameterization.min_coefficient);
    }
    result.volume = deformed;
    for (int p = 0; p < deformed.n_patches(); ++p) {
        result.volume.patches[p] = {deformed.patches[p].space(),
                                    solid.volume->volume.patches[p].control_points()};
    }
    // The map makes quads even on the mean, not the worst element good.
    OptimizedVolume better = optimize_volume(result.volume, features);
    result.volume = std::move(better.volume);
    result.optimization = better.report;
    result.distance = volume_distance(result.volume, solid.cuboids);
    result.volume_change = iga::volume(result.volume) / iga::volume(deformed) - 1.0;
    return result;
}

}  // namespace couture::meshing
