#pragma once

#include <array>
#include <span>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A piece of a surface, cut open: triangles in flat arrays that are copied in no time, split along
/// edges and sliced along paths. Vertices on a seam have one copy on each side.
///
/// Halfedge h belongs to triangle h / 3 and has it on its left; `twin(h)` is the one along the same
/// edge in the neighbouring triangle, -1 on the boundary. Vertices and triangles keep their
/// numbers: splitting and slicing only add some. A split moves the halfedge behind the one that is
/// split to a new triangle: keep vertices, not halfedges, where edges may be split.
class CutSurface {
  public:
    CutSurface() = default;

    /// The triangles of a soup; those that share an edge are neighbours.
    ///
    /// @throws TopologyError  if an edge has more than two triangles or two that run along it in
    ///                        the same direction
    explicit CutSurface(const TriangleSoup& soup);

    /// The named faces of a mesh, cut open along seams.
    ///
    /// @param is_seam  for each edge of the mesh
    CutSurface(const SurfaceMesh& mesh, std::span<const FaceHandle> faces,
               const std::vector<bool>& is_seam);

    [[nodiscard]] int n_vertices() const { return static_cast<int>(points_.size()); }
    [[nodiscard]] int n_faces() const { return static_cast<int>(origin_.size()) / 3; }
    [[nodiscard]] int n_halfedges() const { return static_cast<int>(origin_.size()); }

    [[nodiscard]] int origin(int h) const { return origin_[h]; }
    [[nodiscard]] int target(int h) const { return origin_[next(h)]; }
    [[nodiscard]] int twin(int h) const { return twin_[h]; }
    [[nodiscard]] static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    [[nodiscard]] static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
    [[nodiscard]] static int face(int h) { return h / 3; }
    /// A halfedge that starts at v; at a boundary vertex the first one counter-clockwise, which
    /// lies on the boundary. -1 for a vertex without triangles.
    [[nodiscard]] int outgoing(int v) const { return outgoing_[v]; }
    /// The next one that starts at the same vertex, counter-clockwise; -1 behind the last one of a
    /// boundary vertex.
    [[nodiscard]] int rotated(int h) const { return twin_[previous(h)]; }

    [[nodiscard]] bool is_boundary_vertex(int v) const {
        return outgoing_[v] >= 0 && twin_[outgoing_[v]] < 0;
    }
    /// Whether the edge of h joins two boundary vertices without lying on the boundary.
    [[nodiscard]] bool is_chord(int h) const {
        return twin_[h] >= 0 && is_boundary_vertex(origin(h)) && is_boundary_vertex(target(h));
    }
    [[nodiscard]] std::array<int, 3> triangle(int face) const {
        return {origin_[3 * face], origin_[3 * face + 1], origin_[3 * face + 2]};
    }
    [[nodiscard]] const Vector3& point(int v) const { return points_[v]; }
    [[nodiscard]] double length(int h) const {
        return (points_[origin(h)] - points_[target(h)]).norm();
    }
    /// Halfedge from u to v; one along the boundary is found from the side of its triangle only.
    /// -1 if there is none.
    [[nodiscard]] int find_halfedge(int u, int v) const;

    /// Number in the mesh or soup that the piece was taken from; -1 for vertices that came by
    /// splits.
    [[nodiscard]] int parent(int v) const { return parent_[v]; }
    /// The vertex that v is a copy of since a slice; v itself if it is none.
    [[nodiscard]] int original(int v) const { return original_[v]; }
    [[nodiscard]] int parent_face(int face) const { return parent_face_[face]; }

    /// A vertex that came by splitting the edge between two others.
    struct Split {
        int from;
        int to;
        double fraction;
        int vertex;
    };
    /// All splits so far, in order.
    [[nodiscard]] const std::vector<Split>& splits() const { return splits_; }

    /// Vertices of a closed path with those by which its edges were split since.
    [[nodiscard]] std::vector<int> with_splits(std::span<const int> vertices) const;

    /// Splits an edge and its one or two triangles.
    ///
    /// @param fraction  of the way along h, in (0, 1)
    /// @return the new vertex
    int split_edge(int h, double fraction = 0.5);

    /// Splits every chord, so that a path can pass. Afterwards any two vertices inside are joined
    /// by a path inside, if the piece is connected.
    void split_chords();

    /// Opens the surface along a path of halfedges, or any set of them that have a twin, no two on
    /// one edge. A vertex is divided into as many as it has fans of triangles afterwards: at the
    /// ends of a path only if they lie on the boundary already.
    void slice(std::span<const int> path);

    /// Boundary loops, each as halfedges in order with the surface on the left; in the order of
    /// their smallest halfedge, which comes first.
    [[nodiscard]] std::vector<std::vector<int>> boundary_loops() const;

    /// For each face the number of its component; components are counted in the order of their
    /// smallest face.
    [[nodiscard]] std::vector<int> face_components() const;

    /// Vertices - edges + faces; vertices without triangles don't count.
    [[nodiscard]] int euler_characteristic() const;

  private:
    void link_outgoing();
    void split_vertex(int v, std::vector<int>& outgoing);

    std::vector<Vector3> points_;
    std::vector<int> origin_;
    std::vector<int> twin_;
    std::vector<int> outgoing_;
    std::vector<int> parent_;
    std::vector<int> original_;
    std::vector<int> parent_face_;
    std::vector<Split> splits_;
};

}  // namespace couture::meshing
