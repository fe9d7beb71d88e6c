#pragma once

#include <vector>

#include "iga/topology/space.h"

namespace couture::rom {

class GridKernel;

/// Volumes of the patches of members of a family, with derivatives.
///
/// Functions are tabulated once at Gauss points of each element, (3 degree + 1) / 2 in each
/// direction: exact for polynomial patches. Rational ones get two more.
class MemberVolume {
  public:
    /// @param space  functions of the family (of the reference member's own geometry)
    explicit MemberVolume(iga::SpacePtr<3> space);
    ~MemberVolume();
    MemberVolume(const MemberVolume&) = delete;
    MemberVolume& operator=(const MemberVolume&) = delete;
    MemberVolume(MemberVolume&&) noexcept;
    MemberVolume& operator=(MemberVolume&&) noexcept;

    /// Of each patch: the integral of det J.
    ///
    /// @param control_points  3 n_dofs numbers, 3 node + component
    /// @throws InputError  for another number of them
    [[nodiscard]] VectorX values(const VectorX& control_points) const;
    /// Change of these with the control points along given directions: the integrals of
    /// div(dx) det J.
    ///
    /// @param changes  3 n_dofs x n
    /// @return n_patches x n
    [[nodiscard]] MatrixX changes(const VectorX& control_points, const MatrixX& changes) const;

  private:
    void require_size(const VectorX& control_points) const;
    template <typename Integrand>
    [[nodiscard]] double integral(int patch, const double* control_points, const double* field,
                                  const Integrand& integrand) const;

    iga::SpacePtr<3> space_;
    std::vector<GridKernel> kernels_;
    /// Products of the Gauss weights, one for each point of the patch's grid.
    std::vector<VectorX> weights_;
};

}  // namespace couture::rom
