#pragma once

#include <array>
#include <vector>

#include "meshing/layout/embedded_layout.h"
#include "meshing/parameterization/layout_charts.h"

namespace couture::meshing {

/// What a vertex is to a layout: a node, a vertex of an arc, or inside a quad.
struct LayoutPlace {
    int node = -1;
    int arc = -1;
};

/// For each vertex of the mesh.
///
/// @throws TopologyError  if an arc does not run along edges from its first to its second node, or
///                        if it touches a node or another arc; names arc and vertex
[[nodiscard]] std::vector<LayoutPlace> layout_places(const SurfaceMesh& mesh,
                                                     const EmbeddedLayout& embedding);

/// For each edge of the mesh the arc that it is part of, or -1.
[[nodiscard]] std::vector<int> arcs_of_edges(const SurfaceMesh& mesh,
                                             const EmbeddedLayout& embedding);

/// Which points of the plane describe a map to the charts: one per vertex, in its own chart, that
/// each face sees through a transition.
class ChartVertices {
  public:
    /// @throws as layout_places
    ChartVertices(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                  const LayoutCharts& charts);

    /// Quad whose chart a vertex's point belongs to; -1 for nodes, whose point is the origin, and
    /// for vertices without faces.
    [[nodiscard]] int chart(int vertex) const { return chart_[vertex]; }
    /// From the own chart of a face's vertex (in the order of face_vertices) to that of the face.
    [[nodiscard]] const ChartTransition& transition(int face, int corner) const {
        return transitions_[face][corner];
    }
    /// Whether a coordinate of a vertex is held.
    [[nodiscard]] bool is_fixed(int vertex, int coordinate) const {
        return is_fixed_[vertex][coordinate];
    }

  private:
    std::vector<int> chart_;
    std::vector<std::array<ChartTransition, 3>> transitions_;
    std::vector<std::array<bool, 2>> is_fixed_;
};

}  // namespace couture::meshing
