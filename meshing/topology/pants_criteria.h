#pragma once

#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// What makes a closed curve a good cut, as weights of terms; none but `sharp` may be negative,
/// length, symmetry and curvature not all 0.
struct CriterionWeights {
    double length = 1.0;
    /// Distance from the nearest plane of symmetry.
    double symmetry = 0.0;
    /// Convexity: 0 in the valleys of the surface, 1 on its ridges (minima rule).
    double curvature = 0.0;
    /// How much cheaper feature edges are than other ways: lengths there are divided by 1 + sharp.
    /// Above -1; below 0 they are dearer, so that cuts cross them.
    double sharp = 0.0;

    friend bool operator==(const CriterionWeights&, const CriterionWeights&) = default;
};

/// Mirror plane { x : normal . x = offset }.
struct SymmetryPlane {
    Vector3 normal = Vector3::UnitX();
    double offset = 0.0;
    /// Root mean square distance between the surface and its image, by the diagonal of its box.
    double deviation = 0.0;
};

/// Planes in which a surface is its own mirror image to about half an edge length. They pass
/// through its centre of gravity; their normals are looked for among the axes, the principal axes
/// of inertia and, where these are not unique, all around. O(n) for each direction.
[[nodiscard]] std::vector<SymmetryPlane> find_symmetry_planes(const SurfaceMesh& mesh);

/// The terms of a criterion, evaluated once per vertex.
class CutCriterion {
  public:
    /// @throws InputError  for weights that are negative, not finite or all 0
    CutCriterion(const SurfaceMesh& mesh, const CriterionWeights& weights,
                 const std::vector<SymmetryPlane>& planes, const char* name);

    /// Whether it is length alone: factors are all 1.
    [[nodiscard]] bool is_plain_length() const { return is_plain_length_; }
    /// Positive factor on lengths at a point of the surface given by its place on the first mesh.
    [[nodiscard]] double factor(const SurfacePoint& place) const;
    /// No closed curve of that length scores less.
    [[nodiscard]] double least_score(double length) const;
    /// Of a closed curve given by the factors at its points: length times factors, by the diagonal
    /// of the surface's box.
    ///
    /// @throws InputError  if the numbers of factors and points differ
    [[nodiscard]] double score(const std::vector<double>& factors,
                               const std::vector<Vector3>& points) const;

  private:
    bool is_plain_length_ = true;
    double diagonal_ = 1.0;
    std::vector<double> factor_;
};

}  // namespace couture::meshing
