#include "meshing/pipeline/midpoint.h"

#include <algorithm>

#include "iga/core/error.h"

namespace couture::meshing {

iga::MultiPatch<3> midpoint(const iga::MultiPatch<3>& first, const iga::MultiPatch<3>& second) {
    const std::string signature = iga::signature(first);
    if (const std::string other = iga::signature(second); signature != other) {
        throw InputError(
            "midpoint: signatures {} and {} differ; only members with the same connectivity have "
            "one",
            signature, other);
    }
    iga::MultiPatch<3> result = first;
    for (std::size_t p = 0; p < first.patches.size(); ++p) {
        const iga::Patch<3>& a = first.patches[p];
        const iga::Patch<3>& b = second.patches[p];
        if (a.is_rational() || b.is_rational()) {
            throw InputError("midpoint: patch {} has weights; control points have no mean", p);
        }
        result.patches[p] =
            iga::Patch<3>(a.space(), 0.5 * (a.control_points() + b.control_points()));
    }
    return result;
}

iga::Validity certified(const iga::MultiPatch<3>& volume) {
    iga::Validity worst = iga::Validity::valid;
    for (const iga::Patch<3>& patch : volume.patches) {
        const auto certificate = iga::certify<3>(patch);
        worst = std::max(
            worst, certificate.orientation < 0 ? iga::Validity::folded : certificate.validity);
    }
    return worst;
}

}  // namespace couture::meshing
