#include "iga/assembly/reference_configuration.h"

#include "iga/core/error.h"

namespace couture::iga {

template <int d>
SpacePtr<d> ReferenceConfiguration<d>::undeformed() const {
    if (is_undeformed()) {
        return space;
    }
    if (!space->is_isoparametric()) {
        throw InputError(
            "ReferenceConfiguration: the displacement of a deformed reference needs the functions "
            "of its geometry; refine the geometry to the field's space");
    }
    MultiPatch<d> body = space->geometry();
    for (int p = 0; p < body.n_patches(); ++p) {
        const Patch<d>& patch = body.patches[p];
        MatrixX points = patch.control_points();
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
            points.row(i) -= displacement.row(space->dofs(p)[i]);
        }
        body.patches[p] = Patch<d>(patch.space(), points, patch.weights());
    }
    return std::make_shared<const Space<d>>(std::move(body));
}

template <int d>
ReferencePtr<d> make_reference(const SpacePtr<d>& space) {
    return std::make_shared<const ReferenceConfiguration<d>>(
        ReferenceConfiguration<d>{space, {}, {}});
}

template struct ReferenceConfiguration<2>;
template struct ReferenceConfiguration<3>;
template ReferencePtr<2> make_reference(const SpacePtr<2>&);
template ReferencePtr<3> make_reference(const SpacePtr<3>&);

}  // namespace couture::iga
