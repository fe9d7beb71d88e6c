#pragma once

#include <map>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// Closed path of halfedges with its class in Z^rank. The path is good until edges are split; the
/// vertices are good for ever.
struct AnnotatedLoop {
    double length = 0.0;
    std::vector<int> path;
    /// Origins of the halfedges.
    std::vector<int> vertices;
    std::vector<int> homology_class;
};

/// A surface with what each halfedge adds to the first homology class of a path: the class of a
/// closed path, in Z^rank, is the sum of `classes[annotation[h]]` over its halfedges.
///
/// The annotation is a cocycle (its sum around every triangle is 0); it survives `split_chords` and
/// any slicing of `surface`.
struct AnnotatedSurface {
    CutSurface surface;
    int rank = 0;
    /// For each halfedge a number in `classes`; 0 stands for the zero class.
    std::vector<int> annotation;
    std::vector<std::vector<int>> classes;
    std::map<std::vector<int>, int> number_of_class;

    /// Class of a path of halfedges.
    [[nodiscard]] std::vector<int> class_of(const std::vector<int>& path) const;
    /// A closed path of halfedges with its vertices, length and class.
    [[nodiscard]] AnnotatedLoop make_loop(std::vector<int> path) const;
    /// Number of a class in `classes`, new if need be.
    int number(const std::vector<int>& homology_class);
    /// As CutSurface::split_edge and split_chords, with annotations of the new edges.
    void split_edge(int h);
    void split_chords();
};

/// A first homology basis b_1 .. b_2g made of edges, and the dual basis b*_1 .. b*_2g of paths that
/// cross edges. The annotation counts signed crossings with the dual basis: the class of b_i is the
/// i-th unit vector.
struct HomologyBasis {
    /// Closed.
    AnnotatedSurface annotated;
    int genus = 0;
    /// Halfedges of b_i in order, a closed path; 2 genus of them.
    std::vector<std::vector<int>> loops;
    /// Halfedges crossed by b*_i, in order: it goes from the triangle of each to that of its twin.
    /// b*_i crosses the first halfedge of b_i from right to left, and no other b_j.
    std::vector<std::vector<int>> dual_loops;
};

/// Closes each boundary loop of a surface by a fan around its centre of gravity. Vertices,
/// triangles and halfedges keep their numbers; those of the caps come behind.
[[nodiscard]] CutSurface close_with_caps(const CutSurface& surface);

/// Homology basis of a closed connected surface by a shortest-path tree and a cotree that leaves
/// over the edges with the shortest loops: O(n log n).
///
/// @throws TopologyError  if the surface has a boundary or several components
///
/// Source: [EricksonWhittlesey05] Sec. 3; [Maquart19] Def. 2.7, Prop. 2.1.
[[nodiscard]] HomologyBasis make_homology_basis(CutSurface surface);

}  // namespace couture::meshing
