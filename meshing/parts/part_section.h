#pragma once

#include <vector>

#include "meshing/parts/part_surface.h"

namespace couture::meshing {

/// What a plane leaves of a part.
struct PartSection {
    /// Without the cut face.
    TriangleSoup rest;
    /// Number of the part's face for each triangle of `rest`.
    std::vector<int> face_of_triangle;
    /// The cut face, its normals towards what is taken away.
    TriangleSoup cut;
    /// Boundary of the cut face as closed polygons.
    std::vector<std::vector<Vector3>> outlines;
    /// What is left of the feature curves, in pieces.
    std::vector<std::vector<Vector3>> feature_curves;
};

/// Cuts a part along the plane x_axis = place, for pictures: the plane is moved by a millionth of
/// the part's size so that it meets no vertex, and outlines have no shorter edges than ten times
/// that.
///
/// @param axis  0, 1, 2
/// @param kept  +1: what lies at higher coordinates is left; -1: at lower ones
/// @throws GeometryError  if the plane does not meet the part
[[nodiscard]] PartSection cut_part(const PartSurface& part, int axis, double place, int kept);

}  // namespace couture::meshing
