#pragma once

#include <set>
#include <string>
#include <vector>

#include "meshing/parts/part_surface.h"

namespace couture::meshing {

/// What can be measured of a part's surface. Angles in degrees.
struct SurfaceFigures {
    int n_triangles = 0;
    int euler_characteristic = 0;
    double volume = 0.0;
    double smallest_angle = 180.0;
    /// Part of the triangles with an angle below 15 and below 25 degrees.
    double part_below_15 = 0.0;
    double part_below_25 = 0.0;
    double mean_edge = 0.0;
    double longest_edge = 0.0;
    /// Angles between the normals beside edges.
    double smallest_at_features = 180.0;
    double largest_elsewhere = 0.0;
    /// Edges of feature curves that are no edges of the mesh or stand in two curves.
    int n_wrong_feature_edges = 0;
    /// Feature edges whose two triangles belong to one face, and others whose two don't.
    int n_misplaced_edges = 0;
    /// Faces, or parts of faces, that hang together without crossing a feature curve.
    int n_regions = 0;
    /// Largest distance of a vertex from the plane of its plane face.
    double largest_bulge = 0.0;
};

/// @throws TopologyError  if the surface is no closed oriented manifold
[[nodiscard]] SurfaceFigures measure(const PartSurface& part);

/// All names, for comparison: faces with kind and cap, corners, curves with whether they are
/// closed.
[[nodiscard]] std::vector<std::string> names_of(const PartSurface& part);

/// A face's vertices.
[[nodiscard]] std::set<int> vertices_of_face(const PartSurface& part, const std::string& name);

}  // namespace couture::meshing
