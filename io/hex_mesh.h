#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "iga/topology/space.h"

namespace couture::io {

/// Hexahedra of 8 or 20 nodes, in the order of Abaqus and CalculiX: corners of the face where the
/// third local axis is low, counter-clockwise seen from inside, those of the opposite face; then
/// mid-side nodes of the first face, of the opposite one, and between the two.
struct HexMesh {
    /// Where an element lies: in which patch, which element per direction. Its local axes are the
    /// patch's directions, the first of them backwards where that is left-handed.
    struct Place {
        int patch = 0;
        std::array<int, 3> element{};
        bool is_mirrored = false;
    };

    /// n_nodes x 3.
    MatrixX nodes;
    /// The function of the space that each node stands for.
    std::vector<int> dofs;
    /// Nodes of each element, numbered from 0: n_elements rows of 8 or 20.
    Eigen::MatrixXi elements;
    std::vector<Place> places;
    /// Nodes of each boundary set, increasing.
    std::map<std::string, std::vector<int>> node_sets;
};

/// The elements of a space, patch by patch, direction 0 fastest: 8 nodes each for degree 1, 20 for
/// degree 2. Nodes lie where the geometry has the corners and the middles of the elements' edges:
/// for a geometry of degree 1 the mesh is the geometry. Nodes of a space of degree 1 have the
/// numbers of its functions.
///
/// @throws InputError  unless all directions have degree 1, or degree 2 with double interior knots
[[nodiscard]] HexMesh make_hexahedra(const iga::Space<3>& space);

/// A continuous space of degree 1 or 2 with at least `n_elements` per patch and direction.
///
/// @throws InputError  for another degree, or no elements
[[nodiscard]] iga::SpacePtr<3> make_hexahedral_space(const iga::MultiPatch<3>& geometry, int degree,
                                                     const std::array<int, 3>& n_elements);

}  // namespace couture::io
