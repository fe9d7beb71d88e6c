#pragma once

#include <memory>

#include "iga/topology/dof_map.h"
#include "iga/topology/multipatch.h"

namespace couture::iga {

/// A field space on a multipatch: splines (rational where the geometry is and its functions
/// are contained) on every patch, continuous across interfaces.
template <int d>
class Space {
  public:
    /// The geometry's own functions.
    explicit Space(MultiPatch<d> geometry);
    /// Given functions per patch: finer than, of another degree than, or lower in degree than the
    /// geometry. Breakpoints must contain those of the geometry. Rational where they contain the
    /// geometry's functions, else B-splines.
    Space(MultiPatch<d> geometry, std::vector<TensorSpace<d>> spaces);

    /// The geometry's own functions, or B-splines, joined as `dof_map` says: for parts of patches,
    /// whose functions do not follow from where they meet.
    Space(MultiPatch<d> geometry, std::vector<TensorSpace<d>> spaces, DofMap dof_map);

    [[nodiscard]] const MultiPatch<d>& geometry() const { return geometry_; }
    [[nodiscard]] int n_patches() const { return geometry_.n_patches(); }
    /// Number of scalar functions; a field with c components has c n_dofs unknowns.
    [[nodiscard]] int n_dofs() const { return dof_map_.n_dofs; }
    [[nodiscard]] const TensorSpace<d>& tensor(int patch) const { return spaces_[patch]; }
    /// Weights of the patch's functions, or empty.
    [[nodiscard]] const VectorX& weights(int patch) const { return weights_[patch]; }
    /// Global number of each function of the patch.
    [[nodiscard]] const std::vector<int>& dofs(int patch) const { return dof_map_.global[patch]; }
    /// Global numbers of the functions that do not vanish on the entity, increasing.
    [[nodiscard]] std::vector<int> dofs_on(const PatchEntity<d>& entity) const;
    /// True when each patch's functions are exactly those of the geometry.
    [[nodiscard]] bool is_isoparametric() const { return is_isoparametric_; }

  private:
    MultiPatch<d> geometry_;
    std::vector<TensorSpace<d>> spaces_;
    std::vector<VectorX> weights_;
    DofMap dof_map_;
    bool is_isoparametric_ = false;
};

template <int d>
using SpacePtr = std::shared_ptr<const Space<d>>;

}  // namespace couture::iga
