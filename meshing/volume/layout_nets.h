#pragma once

#include <vector>

#include "meshing/volume/layout_cells.h"

namespace couture::meshing {

/// Control nets of a layout's nodes, edges and faces, each once: what makes neighbours share their
/// control points exactly.
struct LayoutNets {
    /// For each edge, in its direction; those of a sheet conform.
    std::vector<iga::KnotVector> knots;
    /// n_nodes rows of 3 coordinates, or of 4 homogeneous ones.
    MatrixX nodes;
    /// For each edge n_basis rows, the ends those of its nodes; no rows: a straight line.
    std::vector<MatrixX> edges;
    /// For each face its net in its own frame, the border that of its edges; no rows: Coons.
    std::vector<MatrixX> faces;
};

/// Functions of a face in its own frame.
[[nodiscard]] iga::TensorSpace<2> face_space(const LayoutCells& cells,
                                             const std::vector<iga::KnotVector>& knots, int face);

/// The face's net with its border taken from the edges.
[[nodiscard]] MatrixX with_border(const LayoutCells& cells, const LayoutNets& nets, int face,
                                  MatrixX net);

/// Nets for edges without rows: the straight line plus, by the graph Laplacian over edges that face
/// each other, how those of the sheet that are given differ from theirs.
void bend_edges(const LayoutCells& cells, LayoutNets& nets);

/// One patch per cuboid with its directions, Coons volumes of their faces; interfaces where cuboids
/// share a face, sets those of the layout. Nets without rows are filled first.
[[nodiscard]] iga::MultiPatch<3> make_multipatch(const VolumetricLayout& layout,
                                                 const LayoutCells& cells, LayoutNets nets);

}  // namespace couture::meshing
