#pragma once

#include <string>
#include <string_view>

#include "io/raw_splines.h"

namespace couture::io {

/// Reads an MFEM NURBS mesh in either layout: knot vectors, weights and nodes of the mesh as a
/// whole (degrees of freedom of vertices, edges, faces, interiors, in that order; an edge runs from
/// its smaller vertex, a face along its first element's; an edge `k a b` says that knot vector k
/// runs from a to b), or `patches` with knot vectors and control points each. Elements that share
/// the vertices of a side meet there. Boundary attribute n becomes the set `boundary_n`.
///
/// @throws FileError  with file and line
[[nodiscard]] RawSplines read_mfem_mesh(const std::string& file, std::string_view text);

/// The multipatch as MFEM NURBS mesh with `patches`. MFEM knows numbers, not names: `boundary_n`
/// keeps n, other sets get the next free numbers.
///
/// @param notes  gains the table of numbers and names where names are lost
/// @throws InputError  for surfaces in space, sets of edges or corners, sides in two sets, and
///                     patches whose sides or edges can't be told apart by their vertices
template <int d>
[[nodiscard]] std::string to_mfem_mesh(const iga::MultiPatch<d>& multipatch,
                                       std::vector<std::string>& notes);

}  // namespace couture::io
