#pragma once

#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Connected vertices where the surface is curved the same way, and what they add up to.
struct CurvatureCluster {
    /// Ascending.
    std::vector<int> vertices;
    /// Gaussian and, on the boundary, geodesic curvature together, radians.
    double curvature = 0.0;
    /// Mean of the vertices.
    Vector3 center = Vector3::Zero();
    /// Of the singularities of a cross field that belong there: the sum of their indices in quarter
    /// turns, the nearest to the curvature.
    int quarter_turns = 0;
};

struct CurvatureClusters {
    /// Those that singularities belong to, in the order of their smallest vertex.
    std::vector<CurvatureCluster> clusters;
    /// For each vertex its cluster, or -1.
    std::vector<int> cluster_of_vertex;
    /// Curvature of all other vertices, radians.
    double rest = 0.0;
    /// Quarter turns that a cross field needs and the clusters don't give: 4 times the Euler
    /// characteristic minus their sum.
    int missing_quarter_turns = 0;
};

/// Where singularities of a cross field are expected. Vertices hang together if their Gaussian
/// curvature, averaged over a disc, has the same sign and is above a few over the diagonal squared;
/// a cluster with less than an eighth of a full turn is none. Sums obey the theorem of Gauss and
/// Bonnet exactly.
///
/// Source: [Maquart19] Eq. (2.26b), (2.27). Differs: for any curvature the index is the nearest
/// multiple of a quarter, which agrees with the classes of (2.27).
[[nodiscard]] CurvatureClusters find_curvature_clusters(const SurfaceMesh& mesh);

}  // namespace couture::meshing
