#include "meshing/field/direction_field.h"

#include <cmath>
#include <numbers>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// For each edge (4.1) solved for the jump, rounded.
DirectionField with_jumps(const SurfaceMesh& mesh, std::vector<double> angles, int symmetry,
                          const Connection& connection) {
    const FaceFrames frames(mesh);
    DirectionField field{symmetry, std::move(angles), std::vector<int>(mesh.n_edges(), 0)};
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const double left = field.angles[mesh.face_handle(h).idx()];
        const double right = field.angles[mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx()];
        const double gap = right - left - frames.rotation(h) - connection(mesh, h);
        field.period_jumps[edge.idx()] =
            static_cast<int>(std::lround(gap * symmetry / (2.0 * std::numbers::pi)));
    }
    return field;
}

}  // namespace

DirectionField integrate_connection(const SurfaceMesh& mesh, const Connection& connection,
                                    int symmetry, double angle, const DualTree& tree) {
    const FaceFrames frames(mesh);
    std::vector<double> angles(mesh.n_faces(), angle);
    for (const FaceHandle face : tree.order) {
        const HalfedgeHandle h = tree.crossed[face.idx()];
        if (!h.is_valid()) continue;
        angles[face.idx()] =
            angles[mesh.face_handle(h).idx()] + frames.rotation(h) + connection(mesh, h);
    }
    return with_jumps(mesh, std::move(angles), symmetry, connection);
}

DirectionField field_of_angles(const SurfaceMesh& mesh, std::vector<double> angles, int symmetry) {
    if (angles.size() != mesh.n_faces()) {
        throw InputError("direction field: {} angles for {} faces; give one for each",
                         angles.size(), mesh.n_faces());
    }
    return with_jumps(mesh, std::move(angles), symmetry,
                      Connection(std::vector<double>(mesh.n_edges(), 0.0)));
}

Connection field_curvature(const SurfaceMesh& mesh, const DirectionField& field) {
    const FaceFrames frames(mesh);
    std::vector<double> x(mesh.n_edges(), 0.0);
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const double left = field.angles[mesh.face_handle(h).idx()];
        const double right = field.angles[mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx()];
        x[edge.idx()] = right - left - frames.rotation(h) -
                        2.0 * std::numbers::pi / field.symmetry * field.period_jumps[edge.idx()];
    }
    return Connection(std::move(x));
}

FieldTopology topology_of(const SurfaceMesh& mesh, const DualCycles& cycles,
                          const DirectionField& field) {
    const Connection connection = field_curvature(mesh, field);
    const auto turns = [&](const DualCycle& cycle) {
        return static_cast<int>(std::lround(turns_against(mesh, cycle, connection) *
                                            field.symmetry / (2.0 * std::numbers::pi)));
    };
    FieldTopology topology;
    topology.symmetry = field.symmetry;
    for (std::size_t k = 0; k < cycles.inner_vertices.size(); ++k) {
        const int index = field.symmetry - turns(cycles.around_vertices[k]);
        if (index != 0) topology.singularities.push_back({cycles.inner_vertices[k].idx(), index});
    }
    for (const DualCycle& cycle : cycles.along_boundaries) {
        topology.boundary_turns.push_back(turns(cycle));
    }
    for (const DualCycle& cycle : cycles.generators) {
        topology.generator_turns.push_back(turns(cycle));
    }
    return topology;
}

}  // namespace couture::meshing
