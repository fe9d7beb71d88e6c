#include <algorithm>
#include <limits>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/topology/interface_match.h"

namespace couture::iga {

template <int d>
MultiPatch<d> refine(const MultiPatch<d>& multipatch, std::optional<int> degree,
                     std::optional<std::array<int, d>> n_elements) {
    check_combinatorics(multipatch);
    MultiPatch<d> result = multipatch;
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        TensorSpace<d> space = multipatch.patches[p].space();
        for (int k = 0; k < d; ++k) {
            KnotVector& knots = space.knots[k];
            if (degree && *degree < knots.degree()) {
                throw InputError(
                    "refine: degree {} is below degree {} of the geometry (patch {} direction {}); "
                    "splines cannot be lowered exactly",
                    *degree, knots.degree(), p, k);
            }
            knots = refine(knots, degree.value_or(knots.degree()),
                           n_elements ? (*n_elements)[k] : knots.n_elements())
                        .knots;
        }
        result.patches[p] = refine_to(multipatch.patches[p], space);
    }
    const bool conforms = std::all_of(
        result.interfaces.begin(), result.interfaces.end(), [&](const Interface<d>& interface) {
            return !nonconforming_direction(result.patches[interface.first_patch].space(),
                                            result.patches[interface.second_patch].space(),
                                            interface);
        });
    if (!conforms) {
        // The shapes agree as they did before; only knots are at stake.
        make_conforming(result, std::numeric_limits<double>::infinity());
    }
    return result;
}

template MultiPatch<2> refine<2>(const MultiPatch<2>&, std::optional<int>,
                                 std::optional<std::array<int, 2>>);
template MultiPatch<3> refine<3>(const MultiPatch<3>&, std::optional<int>,
                                 std::optional<std::array<int, 3>>);

}  // namespace couture::iga
