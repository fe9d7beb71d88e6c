#pragma once

#include <map>
#include <string>
#include <vector>

#include "meshing/parts/parts.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

enum class PartFaceKind { plane, cylinder, torus, swept };

/// A smooth face of a part: what lies between its feature curves.
struct PartFace {
    std::string name;
    PartFaceKind kind = PartFaceKind::plane;
    /// A plane face that the part may be opened at.
    bool is_cap = false;
};

/// A vertex where three or more feature curves meet.
struct PartCorner {
    std::string name;
    int vertex = -1;
};

/// A curve along which two faces meet at an angle of more than 40 degrees between their normals.
struct PartCurve {
    std::string name;
    /// In order; the first one of a closed curve is not repeated.
    std::vector<int> vertices;
    bool is_closed = false;
};

/// A part as a closed surface. Its names are the same for all values of its parameters; numbers
/// and counts of vertices and triangles are not.
struct PartSurface {
    TriangleSoup soup;
    /// Number of the face that each triangle belongs to.
    std::vector<int> face_of_triangle;
    std::vector<PartFace> faces;
    std::vector<PartCorner> corners;
    std::vector<PartCurve> feature_curves;
};

/// All parts that there are as surfaces, in the order of `README.md`. Some have the name and
/// parameters of a spline part: that is then the same shape.
[[nodiscard]] const std::vector<PartInfo>& part_surfaces();

/// Length of edges that a part has if none is asked for: small enough for the fewest triangles that
/// its users need.
///
/// @throws InputError  for an unknown part
[[nodiscard]] double default_edge_length(const std::string& name);

/// Builds the surface of a part. Vertices lie exactly on its faces, those of feature curves on
/// both; normals point outwards; edges are shorter where a curve or face would turn by more than
/// about 15 or 20 degrees along them. A feature
/// curve is named after its two faces in the order of `faces`, "bore-top", and a corner after all
/// of its faces, with a place behind it where several have the same.
///
/// @param parameters          by name; those left out take their defaults. mm.
/// @param target_edge_length  mm; 0: the part's default. At least a twentieth of that.
/// @throws InputError  for an unknown part or parameter (names the nearest and lists all), and a
///                     value or length that is not finite or out of range
[[nodiscard]] PartSurface make_part_surface(const std::string& name,
                                            const std::map<std::string, double>& parameters = {},
                                            double target_edge_length = 0.0);

}  // namespace couture::meshing
