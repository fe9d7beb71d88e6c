#pragma once

#include <map>
#include <vector>

#include "meshing/layout/embedded_layout.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

/// Where the points of a layout's grid may go: corner nodes, and nodes where other than two feature
/// or boundary arcs meet, stay; points of these arcs slide along their curve; all others slide on
/// the region between the curves that they lie in.
class SurfaceSlide {
  public:
    /// @param grid  of the layout; its sizes don't matter to the surface
    SurfaceSlide(const SurfaceMesh& mesh, const EmbeddedLayout& embedding, const SampleGrid& grid);

    /// Directions of a point to first order, in columns: 0, 1 or 2 of them.
    [[nodiscard]] int n_directions(int point) const;

    /// Points on the surface and what is known of them there.
    struct State {
        /// In columns.
        MatrixX points;
        /// For each point its directions, of unit length; those it does not have are zero.
        std::vector<Matrix<3, 2>> directions;
        /// For each quad and each of its grid points the normal of the surface on its side.
        std::vector<MatrixX> normals;
    };
    /// The nearest places that the points may have.
    [[nodiscard]] State placed(const MatrixX& points) const;

  private:
    /// Feature or boundary arcs in a row, between nodes that stay or closed.
    struct Curve {
        std::vector<VertexHandle> vertices;
    };
    struct CurvePlace {
        int segment = 0;
        double fraction = 0.0;
        Vector3 point = Vector3::Zero();
    };
    void find_curves(const EmbeddedLayout& embedding, const SampleGrid& grid);
    void find_regions(const EmbeddedLayout& embedding);
    void find_normals();
    [[nodiscard]] CurvePlace nearest_on(const Curve& curve, const Vector3& point) const;
    /// Of the surface at a vertex, on the side of a region.
    [[nodiscard]] Vector3 normal_at(VertexHandle vertex, int region) const;

    const SurfaceMesh& mesh_;
    const SampleGrid& grid_;
    std::vector<Curve> curves_;
    std::vector<bool> is_curve_edge_;
    std::vector<int> region_of_face_;
    std::vector<std::vector<FaceHandle>> faces_of_region_;
    std::vector<TriangleTree> trees_;
    std::map<std::pair<int, int>, Vector3> normals_;
    std::vector<int> region_of_quad_;
    // For each point its curve, or -1; its vertex, if it stays; a region that it belongs to.
    std::vector<int> curve_of_point_;
    std::vector<VertexHandle> vertex_of_point_;
    std::vector<int> region_of_point_;
};

}  // namespace couture::meshing
