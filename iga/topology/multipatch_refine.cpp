#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/topology/interface_match.h"
#include "iga/topology/refined_spaces.h"

namespace couture::iga {

template <int d>
std::vector<TensorSpace<d>> refined_spaces(const MultiPatch<d>& multipatch,
                                           std::optional<int> degree,
                                           std::optional<std::array<int, d>> n_elements) {
    std::vector<TensorSpace<d>> spaces;
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        spaces.push_back(multipatch.patches[p].space());
        for (int k = 0; k < d; ++k) {
            KnotVector& knots = spaces.back().knots[k];
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
    }
    make_conforming<d>(spaces, multipatch.interfaces);
    return spaces;
}

template <int d>
MultiPatch<d> refine(const MultiPatch<d>& multipatch, std::optional<int> degree,
                     std::optional<std::array<int, d>> n_elements) {
    check_combinatorics(multipatch);
    MultiPatch<d> result = multipatch;
    const std::vector<TensorSpace<d>> spaces =
        refined_spaces<d>(multipatch, degree, n_elements);
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        result.patches[p] = refine_to(multipatch.patches[p], spaces[p]);
    }
    return result;
}

template std::vector<TensorSpace<2>> refined_spaces<2>(const MultiPatch<2>&, std::optional<int>,
                                                       std::optional<std::array<int, 2>>);
template std::vector<TensorSpace<3>> refined_spaces<3>(const MultiPatch<3>&, std::optional<int>,
                                                       std::optional<std::array<int, 3>>);
template MultiPatch<2> refine<2>(const MultiPatch<2>&, std::optional<int>,
                                 std::optional<std::array<int, 2>>);
template MultiPatch<3> refine<3>(const MultiPatch<3>&, std::optional<int>,
                                 std::optional<std::array<int, 3>>);

}  // namespace couture::iga
