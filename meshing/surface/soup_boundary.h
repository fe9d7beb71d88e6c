#pragma once

#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// For each corner (3 t + k for corner k of triangle t) the first corner of its fan. The triangles
/// at a vertex are in one fan if they hang together across edges at the vertex, however many
/// triangles those have. A manifold has one fan at each vertex.
[[nodiscard]] std::vector<int> corner_fans(const TriangleSoup& soup);

/// A chain of edges with one triangle each.
struct OpenLoop {
    /// In order; the first one of a closed chain is not repeated.
    std::vector<int> vertices;
    /// The triangle at the edge behind each vertex; behind the last one only if the chain is
    /// closed.
    std::vector<int> triangles;
    /// False where a chain ends at an edge with three or more triangles.
    bool is_closed = true;
};

/// The open edges of a soup in chains that follow one fan at each vertex. Each begins with its
/// smallest vertex if it is closed, and runs as the triangles do where these run alike. In the
/// order of their smallest edge (low end, high end).
[[nodiscard]] std::vector<OpenLoop> open_loops(const TriangleSoup& soup);

}  // namespace couture::meshing
