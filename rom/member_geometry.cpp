#include "rom/member_geometry.h"

#include <cmath>

#include "iga/core/error.h"

namespace couture::rom {

namespace {

/// Weights of two members may differ by rounding only.
constexpr double weight_tolerance = 1e-12;

void require_own_functions(const iga::Space<3>& reference) {
    if (!reference.is_isoparametric()) {
        throw InputError(
            "reference member: its functions are not those of its geometry; refine the geometry to "
            "the functions first");
    }
}

void check_weights(const VectorX& reference, const VectorX& member, int patch) {
    if (reference.size() != member.size()) {
        throw InputError(
            "member: patch {} {} rational, that of the reference {}; both must have the same "
            "weights",
            patch, member.size() > 0 ? "is" : "is not", reference.size() > 0 ? "is" : "is not");
    }
    for (Eigen::Index i = 0; i < reference.size(); ++i) {
        if (std::abs(member[i] - reference[i]) > weight_tolerance * reference[i]) {
            throw InputError(
                "member: patch {}: weight {} is {}, that of the reference is {}; the members of a "
                "family have the same weights",
                patch, i, member[i], reference[i]);
        }
    }
}

}  // namespace

VectorX to_field(const iga::Space<3>& reference, const iga::MultiPatch<3>& member) {
    require_own_functions(reference);
    const std::string expected = iga::signature(reference.geometry());
    const std::string found = iga::signature(member);
    if (found != expected) {
        throw InputError(
            "member: its signature is {}, that of the reference is {}; both must have the same "
            "patches, knots, interfaces and sets",
            found, expected);
    }
    VectorX field(3 * reference.n_dofs());
    for (int p = 0; p < reference.n_patches(); ++p) {
        const iga::Patch<3>& patch = member.patches[p];
        check_weights(reference.geometry().patches[p].weights(), patch.weights(), p);
        const std::vector<int>& dofs = reference.dofs(p);
        // A shared control point is that of the last patch: they differ by rounding only.
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            field.segment<3>(3 * static_cast<Eigen::Index>(dofs[i])) =
                patch.control_points().row(static_cast<Eigen::Index>(i)).transpose();
        }
    }
    return field;
}

iga::MultiPatch<3> to_member(const iga::Space<3>& reference, const VectorX& control_points) {
    require_own_functions(reference);
    if (control_points.size() != 3 * reference.n_dofs()) {
        throw InputError("member: {} numbers for control points; expected 3 for each of {} nodes",
                         control_points.size(), reference.n_dofs());
    }
    iga::MultiPatch<3> member = reference.geometry();
    for (int p = 0; p < reference.n_patches(); ++p) {
        const std::vector<int>& dofs = reference.dofs(p);
        MatrixX points(dofs.size(), 3);
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            points.row(static_cast<Eigen::Index>(i)) =
                control_points.segment<3>(3 * static_cast<Eigen::Index>(dofs[i])).transpose();
        }
        const iga::Patch<3>& patch = member.patches[p];
        member.patches[p] = iga::Patch<3>(patch.space(), std::move(points), patch.weights());
    }
    return member;
}

}  // namespace couture::rom
