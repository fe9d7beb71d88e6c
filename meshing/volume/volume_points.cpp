#include "meshing/volume/volume_points.h"

namespace couture::meshing {

using iga::MultiPatch;

MatrixX points_of(const MultiPatch<3>& volume, const iga::DofMap& dofs) {
    MatrixX points(3, dofs.n_dofs);
    // Backwards, so that a shared point is that of its first patch.
    for (int p = volume.n_patches(); p-- > 0;) {
        for (std::size_t i = dofs.global[p].size(); i-- > 0;) {
            points.col(dofs.global[p][i]) = volume.patches[p].control_points().row(i).transpose();
        }
    }
    return points;
}

MultiPatch<3> with_points(const MultiPatch<3>& volume, const iga::DofMap& dofs,
                          const MatrixX& points) {
    MultiPatch<3> result = volume;
    for (int p = 0; p < volume.n_patches(); ++p) {
        const iga::Volume& patch = volume.patches[p];
        MatrixX own(patch.control_points().rows(), 3);
        for (int i = 0; i < own.rows(); ++i) {
            own.row(i) = points.col(dofs.global[p][i]).transpose();
        }
        result.patches[p] = iga::Volume(patch.space(), std::move(own), patch.weights());
    }
    return result;
}

}  // namespace couture::meshing
