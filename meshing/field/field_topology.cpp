#include "meshing/field/field_topology.h"

#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check_sizes(const SurfaceMesh& mesh, const DualCycles& cycles, const FieldTopology& topology) {
    if (!std::set<int>{1, 2, 4, 6}.contains(topology.symmetry)) {
        throw InputError("direction field: symmetry {}; it must be 1, 2, 4 or 6",
                         topology.symmetry);
    }
    const auto check = [](std::size_t n, std::size_t n_wanted, const char* what) {
        if (n != n_wanted) {
            throw InputError("direction field: {} turns for {} {}; give one for each", n, n_wanted,
                             what);
        }
    };
    check(topology.boundary_turns.size(), cycles.along_boundaries.size(), "boundaries");
    check(topology.generator_turns.size(), cycles.generators.size(), "generators");
    std::set<int> vertices;
    for (const auto& [vertex, index] : topology.singularities) {
        if (index == 0 || vertex < 0 || vertex >= static_cast<int>(mesh.n_vertices()) ||
            mesh.is_isolated(VertexHandle(vertex)) || mesh.is_boundary(VertexHandle(vertex)) ||
            !vertices.insert(vertex).second) {
            throw InputError(
                "direction field: a singularity of index {} at vertex {}; the index must not be "
                "0, the vertex lie inside the surface and have no other",
                index, vertex);
        }
    }
}

}  // namespace

double turning_number(int turns, int symmetry) { return -static_cast<double>(turns) / symmetry; }

int topological_freedom(const SurfaceInvariants& surface, int n_singularities) {
    const int n = surface.n_boundaries + n_singularities;
    return 2 * surface.genus + (n > 0 ? n - 1 : 0);
}

void check_topology(const SurfaceMesh& mesh, const DualCycles& cycles,
                    const FieldTopology& topology) {
    check_sizes(mesh, cycles, topology);
    const std::vector<int> component = face_components(mesh);
    const auto component_of = [&](HalfedgeHandle h) {
        return component[mesh.face_handle(h).idx()];
    };
    const std::vector<SurfaceInvariants> surfaces = component_invariants(mesh);
    std::vector<int> indices(surfaces.size(), 0);
    std::vector<int> turns(surfaces.size(), 0);
    for (const auto& [vertex, index] : topology.singularities) {
        indices[component_of(mesh.halfedge_handle(VertexHandle(vertex)))] += index;
    }
    const auto loops = boundary_loops(mesh);
    for (std::size_t b = 0; b < loops.size(); ++b) {
        const auto& v = loops[b].vertices;
        turns[component_of(mesh.find_halfedge(v[0], v[1]))] += topology.boundary_turns[b];
    }
    for (std::size_t c = 0; c < surfaces.size(); ++c) {
        const int wanted = topology.symmetry * surfaces[c].euler_characteristic;
        if (indices[c] + turns[c] != wanted) {
            throw TopologyError(
                "direction field: indices of singularities sum to {} and turns along boundaries to "
                "{} in component {}; together they must be {} (symmetry {} times Euler "
                "characteristic {})",
                indices[c], turns[c], c, wanted, topology.symmetry,
                surfaces[c].euler_characteristic);
        }
    }
}

}  // namespace couture::meshing
