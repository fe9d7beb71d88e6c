#pragma once

// In this order: the traits of Eigen's vectors make them points of the mesh.
// clang-format off
#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <OpenMesh/Core/Geometry/EigenVectorT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
// clang-format on

#include <array>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// Triangles by vertex numbers: what readers and parts hand over, and what writers take.
struct TriangleSoup {
    std::vector<Vector3> points;
    /// Vertex numbers, counter-clockwise seen from outside.
    std::vector<std::array<int, 3>> triangles;
};

/// A place on the surface as it was first made: a convex combination of up to three of its
/// vertices, all of one triangle.
struct SurfacePoint {
    /// Vertex numbers, ascending; -1 behind the last one.
    std::array<int, 3> vertices{-1, -1, -1};
    /// Positive beside a vertex, sum 1; 0 beside -1.
    std::array<double, 3> weights{0.0, 0.0, 0.0};
};

/// What the elements of a SurfaceMesh carry: `mesh.data(handle).member`.
struct SurfaceTraits : OpenMesh::DefaultTraits {
    using Point = Eigen::Vector3d;
    using Normal = Eigen::Vector3d;

    VertexTraits {
        /// Where the vertex lies on the surface before any edge was split.
        SurfacePoint source;
    };
    EdgeTraits {
        /// Number of the feature curve that the edge belongs to, or -1.
        int feature = -1;
        /// Number of the curve (loop, cut, arc) that the edge belongs to, or -1.
        int curve = -1;
    };
    FaceTraits {
        /// Triangle of the surface before any edge was split.
        int source = -1;
        /// Number of the smooth face (the region between feature curves), or -1.
        int region = -1;
    };
};

/// The one triangle mesh of a part, oriented, possibly with boundary. Elements are only ever added
/// (by split_edge), so handles stay valid.
using SurfaceMesh = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;

using VertexHandle = OpenMesh::VertexHandle;
using HalfedgeHandle = OpenMesh::HalfedgeHandle;
using EdgeHandle = OpenMesh::EdgeHandle;
using FaceHandle = OpenMesh::FaceHandle;

/// The mesh of triangles that form an oriented manifold (repair.h makes them so); vertices and
/// faces keep their numbers.
///
/// @throws TopologyError  if a triangle cannot be added: an edge with more than two triangles, or
///                        two that run along it in the same direction; names the triangle
/// @throws InputError     for a vertex number that does not exist or stands twice in a triangle
[[nodiscard]] SurfaceMesh make_surface_mesh(const TriangleSoup& soup);

/// The triangles of a mesh, vertices and faces by their numbers.
[[nodiscard]] TriangleSoup to_soup(const SurfaceMesh& mesh);

/// Vertices of a face, counter-clockwise seen from outside.
[[nodiscard]] std::array<VertexHandle, 3> face_vertices(const SurfaceMesh& mesh, FaceHandle face);

[[nodiscard]] double edge_length(const SurfaceMesh& mesh, EdgeHandle edge);
[[nodiscard]] double face_area(const SurfaceMesh& mesh, FaceHandle face);
/// Unit length; zero for a face without area.
[[nodiscard]] Vector3 face_normal(const SurfaceMesh& mesh, FaceHandle face);
/// Mean of the normals of the faces around a vertex by their areas, unit length; zero if they cancel
/// out.
[[nodiscard]] Vector3 vertex_normal(const SurfaceMesh& mesh, VertexHandle vertex);
/// Angle of the face left of the halfedge at the vertex where it starts, in radians.
[[nodiscard]] double corner_angle(const SurfaceMesh& mesh, HalfedgeHandle halfedge);
[[nodiscard]] double surface_area(const SurfaceMesh& mesh);
/// Volume inside a closed surface, positive if it is oriented outwards; with boundary: that of the
/// cone over the surface from the origin.
[[nodiscard]] double signed_volume(const SurfaceMesh& mesh);
/// Diagonal of the bounding box.
[[nodiscard]] double bounding_box_diagonal(const SurfaceMesh& mesh);

/// Splits an edge and its one or two faces at a point of the edge. Both halves keep what the edge
/// carries, the new faces what theirs did; the shape does not change.
///
/// @param fraction  of the way along `halfedge`, in (0, 1)
/// @return the new vertex
VertexHandle split_edge(SurfaceMesh& mesh, HalfedgeHandle halfedge, double fraction = 0.5);

}  // namespace couture::meshing
