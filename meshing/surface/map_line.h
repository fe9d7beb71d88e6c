#pragma once

#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// Where a line meets the edges of a map: in a vertex, or in the inside of an edge.
struct LineNode {
    /// -1 inside an edge.
    int vertex = -1;
    /// The edge, as the halfedge that has the rest of the line on its left; -1 at a vertex. Its
    /// origin lies right of the line.
    int halfedge = -1;
    /// Of the way along the halfedge, in [0, 1] (the ends by rounding only).
    double fraction = 0.0;
};

/// Follows the straight line between two vertices through a map to the plane, by exact signs: which
/// edges it crosses, which vertices it passes. From one vertex to the next along an edge there is
/// nothing between.
///
/// @param parameters  one per vertex; every triangle counter-clockwise
/// @return nodes in order, the two vertices included
/// @throws InputError     if the vertices are the same or have no triangles
/// @throws GeometryError  if the line leaves the map (its domain need not be convex), or the map is
///                        not one-to-one; says where. A slanted side of the domain is straight but
///                        for rounding only, so that a line along it may leave the map.
[[nodiscard]] std::vector<LineNode> trace_line(const CutSurface& surface,
                                               std::span<const Vector2> parameters, int from,
                                               int to);

struct InsertLineOptions {
    /// A crossing nearer to an end of its edge than this part of it is moved to that vertex, unless
    /// it lies on the boundary, so that no sliver comes about. The path then leaves the line by no
    /// more than this part of the edge. In [0, 0.5].
    double snap_fraction = 1e-3;
};

/// Makes the straight line between two vertices of a map a path of edges: splits the edges that it
/// crosses and gives the new vertices their parameters. Vertices that were there keep their numbers
/// and parameters, and every triangle stays counter-clockwise.
///
/// A crossing that cannot be told from an end of its edge in double precision, or whose edge ends
/// on the line but for rounding, is moved there whatever the options say: a line along an earlier
/// one follows its edges. A path that would pass a vertex twice after that is shortened.
///
/// @return the path as halfedges in order; where it follows the boundary against its direction, the
///         one halfedge that there is. Later splits, also those of further lines, move edges to
///         other halfedges: keep the vertices.
/// @throws as trace_line
[[nodiscard]] std::vector<int> insert_line(CutSurface& surface, std::vector<Vector2>& parameters,
                                           int from, int to, const InsertLineOptions& options = {});

/// Makes a parameter point a vertex: the vertex there, or one that splits the edge it lies on, or
/// one inside a triangle (by two splits). A point nearer to a vertex or edge than the snap fraction
/// (in barycentric weights) is moved there.
///
/// @throws GeometryError  for a point outside the map
[[nodiscard]] int insert_point(CutSurface& surface, std::vector<Vector2>& parameters,
                               const Vector2& point, const InsertLineOptions& options = {});

/// Inserts the lines between consecutive parameter points, end to end.
///
/// @return the paths as halfedges, one after the other; vertices where later parts cross earlier
///         ones are part of both
/// @throws InputError  for fewer than two points, and as insert_point and insert_line
[[nodiscard]] std::vector<int> insert_polyline(CutSurface& surface,
                                               std::vector<Vector2>& parameters,
                                               std::span<const Vector2> points,
                                               const InsertLineOptions& options = {});

}  // namespace couture::meshing
