#pragma once

#include <vector>

#include "meshing/layout/embedded_layout.h"
#include "meshing/layout/layout_samples.h"

namespace couture::meshing {

struct NodeRelocationOptions {
    /// Wanted length of the cells along each arc next to that of the others, linear between
    /// opposite arcs of a quad; empty: all the same.
    std::vector<double> cell_lengths;
    /// Part of the energy that weighs cells by their area, in [0, 1]. Without it few wide cells on
    /// a bulge cost little next to many narrow ones; alone it lets cells beside them fold.
    double area_part = 0.5;
    int max_iterations = 60;
    /// It ends when a step lowers the energy by less than this part of it.
    double tolerance = 1e-5;
};

struct NodeRelocationReport {
    /// Of the start and after each step; 1 where all cells are squares of one size.
    std::vector<double> energies;
    bool is_converged = false;
    /// Corners of cells that turn the wrong way against the surface at the start and in the end; if
    /// some are left in the end, nothing has been moved.
    int n_inverted_at_start = 0;
    int n_inverted = 0;
    /// How far the nodes went.
    double largest_move = 0.0;
};

struct RelocatedSamples {
    LayoutSamples samples;
    NodeRelocationReport report;
};

/// Moves all points of a layout's grid, its nodes among them, on the surface that they sample:
/// minimises the symmetric Dirichlet energy of the map from the wanted cell to the surface's
/// tangent plane: its mean over all corners of cells and its mean over the surface's area, in
/// parts. Corner nodes stay, feature and boundary arcs' points slide along their curve, others on
/// their smooth region; each step is put back onto the surface and taken only if the energy falls,
/// with all corners the right way round. Cells that would bend by more than 45 degrees from their
/// middle to a corner, and more than at the start, are held instead: their points would slip off a
/// finger of the surface.
///
/// Source: [Maquart19] 4.2.2.2 and C.2 for its purpose. Differs: there one node at a time moves in
/// the polar map of its triangles along the gradient of the energy, the surface being triangulated
/// anew around it; here nodes and the grid move at once by Newton's method, on the surface as it
/// is.
///
/// @throws InputError  if sizes don't match
[[nodiscard]] RelocatedSamples relocate_nodes(const SurfaceMesh& mesh,
                                              const EmbeddedLayout& embedding,
                                              const LayoutSamples& samples,
                                              const NodeRelocationOptions& options = {});

/// The grid with each cell divided into n x n: bilinear, put back onto the surface. Feature
/// and boundary arcs go first; what that moved them by moves the points of the cells beside them,
/// too, less and less: so these stay on their side of a sharp edge that bends within a cell.
///
/// @throws InputError  for less than one part
[[nodiscard]] LayoutSamples refine_samples(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                           const LayoutSamples& samples, int n);

/// The grid with n x n cells joined to one each: every n-th of its points. Undoes refine_samples.
///
/// @throws InputError  for less than one cell, and for numbers of cells that n does not divide
[[nodiscard]] LayoutSamples coarsen_samples(const LayoutSamples& samples, int n);

}  // namespace couture::meshing
