#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::io {

/// MFEM's numbering of the corners of a quadrilateral and of a hexahedron: bit k of entry i is set
/// if corner i lies at the high end of direction k.
template <int d>
constexpr std::array<int, (1 << d)> mfem_corner_bits = {};
template <>
inline constexpr std::array<int, 4> mfem_corner_bits<2> = {0, 1, 3, 2};
template <>
inline constexpr std::array<int, 8> mfem_corner_bits<3> = {0, 1, 3, 2, 4, 5, 7, 6};

/// Vertices of a patch: entry b is the vertex of the corner whose bit k tells the high end of
/// direction k.
template <int d>
using CornerVertices = std::array<int, (1 << d)>;

/// Two vertices, the smaller first.
using VertexPair = std::pair<int, int>;
constexpr VertexPair sorted_pair(int a, int b) {
    return a < b ? VertexPair{a, b} : VertexPair{b, a};
}

/// An edge of a patch: its direction and the corners (bits) of its low and high end.
struct PatchEdge {
    int direction;
    int low;
    int high;
};
template <int d>
[[nodiscard]] std::vector<PatchEdge> patch_edges();

/// Corners (bits) of a side, first tangential direction fastest.
template <int d>
[[nodiscard]] std::vector<int> side_corners(int side);

/// Corners (bits) of a side in MFEM's cyclic order, seen from outside.
template <int d>
[[nodiscard]] std::vector<int> mfem_side_corners(int side);
/// Our side numbers in MFEM's order of an element's faces.
inline constexpr std::array<int, 6> mfem_face_sides = {4, 2, 1, 3, 0, 5};

/// Interfaces of elements that share all vertices of a side.
///
/// @throws TopologyError  if three sides share their vertices or two do so in another cyclic order
template <int d>
[[nodiscard]] std::vector<iga::Interface<d>> interfaces_of_vertices(
    const std::vector<CornerVertices<d>>& elements);

}  // namespace couture::io
