#pragma once

#include <map>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

struct FeatureOptions {
    /// Angle between the normals of two faces from which their edge is sharp, in (0, pi).
    double angle = 40.0 * std::numbers::pi / 180.0;
    /// Turn of a curve at a vertex from which that is a corner, in (0, pi).
    double corner_angle = 45.0 * std::numbers::pi / 180.0;
    /// Connected sharp edges that are together shorter don't count, a length. Boundary edges and
    /// what hangs together with them always do.
    double min_length = 0.0;
    /// How far the vertices of a planar region may lie from its plane, relative to the diagonal of
    /// the mesh's bounding box.
    double planar_tolerance = 1e-6;
};

/// A chain of sharp edges, or of boundary edges, between two corners or closed.
struct FeatureCurve {
    /// In order; the first one of a closed curve is not repeated at its end.
    std::vector<VertexHandle> vertices;
    bool is_closed = false;
    /// Whether its edges lie on the boundary of the mesh.
    bool is_boundary = false;
    double length = 0.0;
    /// Of a part: that of its curve; empty of others.
    std::string name = {};
};

/// A smooth face: triangles that hang together without crossing a feature curve.
struct FeatureRegion {
    /// Ascending.
    std::vector<FaceHandle> faces;
    double area = 0.0;
    /// Mean of the normals by area, unit length; zero if they cancel out.
    Vector3 normal = Vector3::Zero();
    /// Centre of mass.
    Vector3 centroid = Vector3::Zero();
    bool is_planar = false;
    /// Numbers of the curves along it, ascending.
    std::vector<int> curves;
    /// Boundary loops of the region, cut open along the curves that end in it.
    int n_loops = 0;
    /// Euler characteristic of the region, cut open in the same way.
    int euler_characteristic = 0;

    [[nodiscard]] bool is_disc() const { return n_loops == 1 && euler_characteristic == 1; }
};

/// Feature curves, corners and smooth faces of a part.
struct Features {
    /// Numbered by their position. Detected ones: first those from corner to corner, by their first
    /// corner and the vertex after it, then closed ones by their smallest vertex.
    std::vector<FeatureCurve> curves;
    /// Vertices where three or more curves meet, where one ends, or where one turns sharply;
    /// ascending.
    std::vector<VertexHandle> corners;
    /// Of corners of a part, by the number of their vertex.
    std::map<int, std::string> corner_names = {};
    /// In the order of their smallest face.
    std::vector<FeatureRegion> regions;
};

/// Feature curves along sharp edges and boundary edges; their numbers go to
/// `mesh.data(edge).feature` (-1 elsewhere), those of the regions to `mesh.data(face).region`.
/// Depends on the numbers of vertices and faces only, not on the order of anything else.
/// O(n log n).
///
/// @throws InputError  if an option is out of its range
[[nodiscard]] Features detect_features(SurfaceMesh& mesh, const FeatureOptions& options = {});

/// Feature curves as a part declares them, with their numbers; boundary edges that no curve names
/// form curves behind them. Corners are the ends of the declared curves, and of boundary curves
/// also sharp turns. Tags as `detect_features`; the options' `angle` and `min_length` don't matter.
///
/// @param curves  vertices in order; the first one of a closed curve repeated at its end
/// @throws InputError  if an option is out of its range, or if a curve has less than one edge, of a
///                     closed one three
/// @throws TopologyError  if two vertices in a row have no common edge, if an edge stands in two
///                        curves, if a curve is partly on the boundary, or if a curve meets another
///                        one in its middle
[[nodiscard]] Features tag_features(SurfaceMesh& mesh,
                                    std::span<const std::vector<VertexHandle>> curves,
                                    const FeatureOptions& options = {});

/// Angle between the normals of the faces beside an edge, in [0, pi]; 0 on the boundary and beside
/// a face without area.
[[nodiscard]] double dihedral_angle(const SurfaceMesh& mesh, EdgeHandle edge);

/// Whether all vertices of some faces lie within a distance of the plane through their centroid
/// along their mean normal, and no face is turned over.
///
/// @param tolerance  a length
[[nodiscard]] bool is_planar(const SurfaceMesh& mesh, std::span<const FaceHandle> faces,
                             double tolerance);

}  // namespace couture::meshing
