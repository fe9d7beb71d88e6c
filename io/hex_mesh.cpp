#include "io/hex_mesh.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "iga/core/error.h"
#include "iga/spline/refine.h"

namespace couture::io {

using namespace iga;

namespace {

/// Node k lies at these halves of the element's edges.
constexpr std::array<std::array<int, 3>, 20> node_halves = {
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
     {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
     {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}};

/// Common degree of all directions, 1 or 2.
int degree_of(const Space<3>& space) {
    const int degree = space.tensor(0).knots[0].degree();
    for (int patch = 0; patch < space.n_patches(); ++patch) {
        for (const KnotVector& knots : space.tensor(patch).knots) {
            if (knots.degree() != degree || degree > 2 ||
                knots.n_basis() != degree * knots.n_elements() + 1) {
                throw InputError(
                    "hexahedra: patch {} has degree {} with {} functions on {} elements; all "
                    "directions must have degree 1, or degree 2 with double interior knots",
                    patch, knots.degree(), knots.n_basis(), knots.n_elements());
            }
        }
    }
    return degree;
}

bool is_left_handed(const Patch<3>& patch) {
    Vector3 middle;
    for (int k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (patch.knots(k).front() + patch.knots(k).back());
    }
    const Matrix<3> J = patch.jacobian(middle);
    return J.determinant() < 0.0;
}

/// The point of function `i`, which belongs to a corner or to the middle of an edge.
Vector3 node_position(const Patch<3>& patch, const TensorSpace<3>& space, int i, int degree) {
    const std::array<int, 3> index = space.indices(i);
    Vector3 xi;
    for (int k = 0; k < 3; ++k) {
        const std::vector<double>& breakpoints = space.knots[k].breakpoints();
        const int element = index[k] / degree;
        xi[k] = index[k] % degree == 0 ? breakpoints[element]
                                       : 0.5 * (breakpoints[element] + breakpoints[element + 1]);
    }
    return patch.point(xi);
}

/// The functions of one element in the order of its nodes.
std::vector<int> functions_of(const TensorSpace<3>& space, const HexMesh::Place& place,
                              int degree) {
    std::vector<int> functions;
    const int n_nodes = degree == 1 ? 8 : 20;
    for (int a = 0; a < n_nodes; ++a) {
        std::array<int, 3> index;
        for (int k = 0; k < 3; ++k) {
            const int half =
                k == 0 && place.is_mirrored ? 2 - node_halves[a][k] : node_halves[a][k];
            index[k] = degree * place.element[k] + degree * half / 2;
        }
        functions.push_back(space.index(index));
    }
    return functions;
}

}  // namespace

SpacePtr<3> make_hexahedral_space(const MultiPatch<3>& geometry, int degree,
                                  const std::array<int, 3>& n_elements) {
    if (degree < 1 || degree > 2) {
        throw InputError("hexahedra: degree = {}; must be 1 or 2", degree);
    }
    std::vector<TensorSpace<3>> spaces;
    for (const Patch<3>& patch : geometry.patches) {
        TensorSpace<3> space = patch.space();
        for (int k = 0; k < 3; ++k) {
            const KnotVector fine =
                refine(patch.knots(k), patch.knots(k).degree(), n_elements[k]).knots;
            std::vector<double> knots = {fine.front()};
            for (const double breakpoint : fine.breakpoints()) {
                knots.insert(knots.end(), degree, breakpoint);
            }
            knots.push_back(fine.back());
            space.knots[k] = {degree, knots};
        }
        spaces.push_back(std::move(space));
    }
    return std::make_shared<const Space<3>>(geometry, std::move(spaces));
}

HexMesh make_hexahedra(const Space<3>& space) {
    const int degree = degree_of(space);
    HexMesh mesh;
    std::vector<std::vector<int>> elements;
    std::vector<std::optional<int>> nodes(space.n_dofs());
    const MultiPatch<3>& geometry = space.geometry();
    for (int patch = 0; patch < space.n_patches(); ++patch) {
        const TensorSpace<3>& tensor = space.tensor(patch);
        const std::array<int, 3> n = tensor.n_elements();
        const bool is_mirrored = is_left_handed(geometry.patches[patch]);
        for (int i = 0; i < n[0] * n[1] * n[2]; ++i) {
            mesh.places.push_back(
                {patch, {i % n[0], i / n[0] % n[1], i / (n[0] * n[1])}, is_mirrored});
            elements.push_back(functions_of(tensor, mesh.places.back(), degree));
            for (int& function : elements.back()) {
                function = space.dofs(patch)[function];
                nodes[function] = 0;
            }
        }
    }
    for (int dof = 0; dof < space.n_dofs(); ++dof) {
        if (nodes[dof]) {
            nodes[dof] = static_cast<int>(mesh.dofs.size());
            mesh.dofs.push_back(dof);
        }
    }
    mesh.elements.resize(static_cast<long>(elements.size()), degree == 1 ? 8 : 20);
    for (long e = 0; e < mesh.elements.rows(); ++e) {
        for (long a = 0; a < mesh.elements.cols(); ++a) {
            mesh.elements(e, a) = *nodes[elements[e][a]];
        }
    }
    mesh.nodes.resize(static_cast<long>(mesh.dofs.size()), 3);
    for (int patch = 0; patch < space.n_patches(); ++patch) {
        for (int i = 0; i < space.tensor(patch).n_basis(); ++i) {
            if (const std::optional<int> node = nodes[space.dofs(patch)[i]]) {
                mesh.nodes.row(*node) =
                    node_position(geometry.patches[patch], space.tensor(patch), i, degree);
            }
        }
    }
    for (const auto& [name, entities] : geometry.boundary_sets) {
        std::vector<int>& set = mesh.node_sets[name];
        for (const PatchEntity<3>& entity : entities) {
            for (const int dof : space.dofs_on(entity)) {
                if (nodes[dof]) {
                    set.push_back(*nodes[dof]);
                }
            }
        }
        std::sort(set.begin(), set.end());
        set.erase(std::unique(set.begin(), set.end()), set.end());
    }
    return mesh;
}

}  // namespace couture::io
