#pragma once

#include <string>
#include <vector>

#include "iga/mechanics/problem.h"
#include "rom/sample_grid.h"

namespace couture::rom {

/// Fields at the points of grids, grid by grid.
struct FieldSamples {
    /// Of the undeformed member, and displacements: 3 x n_points.
    MatrixX points;
    MatrixX displacements;
    /// Cauchy stress, Voigt order 11, 22, 33, 23, 13, 12: 6 x n_points.
    MatrixX stresses;
    VectorX von_mises;
};

class GridKernel;

/// Evaluates members of a family at grids of points: geometry, displacement, and the stress of the
/// displacement's derivative on that geometry.
///
/// The functions are tabulated once. Sums are factorized, direction by direction, and run over
/// several points of one direction side by side.
class FieldSampler {
  public:
    /// @param space  functions of the family (of the reference member's own geometry)
    /// @throws InputError  for a grid of a patch that does not exist, or with parameters outside
    FieldSampler(iga::SpacePtr<3> space, std::vector<SampleGrid> grids);
    ~FieldSampler();
    FieldSampler(const FieldSampler&) = delete;
    FieldSampler& operator=(const FieldSampler&) = delete;
    FieldSampler(FieldSampler&&) noexcept;
    FieldSampler& operator=(FieldSampler&&) noexcept;

    [[nodiscard]] const std::vector<SampleGrid>& grids() const { return grids_; }
    [[nodiscard]] int n_points() const { return first_points_.back(); }
    /// Number of the first point of a grid.
    [[nodiscard]] int first_point(int i_grid) const { return first_points_[i_grid]; }

    /// @param control_points, displacement  3 n_dofs numbers each, 3 node + component
    /// @param problem    materials of the patches and temperatures; solids. Hyperelastic stresses
    ///                   are those of the deformation gradient, no volumetric part is projected
    /// @param load_case  of the temperatures
    /// @throws InputError  for other sizes, a problem that is no elastic solid, a patch without
    ///                     material
    [[nodiscard]] FieldSamples sample(const VectorX& control_points, const VectorX& displacement,
                                      const iga::Problem& problem,
                                      const std::string& load_case = "") const;

  private:
    iga::SpacePtr<3> space_;
    std::vector<SampleGrid> grids_;
    std::vector<int> first_points_;
    std::vector<GridKernel> kernels_;
};

}  // namespace couture::rom
