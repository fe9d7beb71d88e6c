#pragma once

#include "iga/linalg/block_matrix.h"
#include "iga/linalg/patch_structure.h"

namespace couture::iga {

/// The operator sum_k stretch[k] d^2/dxi_k^2 - reaction on the unit box that a patch's matrix
/// resembles, for one component.
struct PatchCoefficients {
    std::array<double, 3> stretch{};
    double reaction = 0.0;
};

/// Coefficients of a patch, one per component, from the rows of the assembled matrix: with q the
/// coefficient pulled back to the unit box, the row of function i times the coefficients of
/// -(xi_k - xi_k(i))^2 / 2 is the integral of N_i q_kk but for odd terms, and its sum is the
/// integral of N_i times the reaction. Both are averaged over the patch's inner functions, so the
/// stretch is the mean of the pulled-back coefficient whatever the physics.
[[nodiscard]] std::vector<PatchCoefficients> patch_coefficients(const BlockMatrix& matrix,
                                                                const PatchStructure& structure,
                                                                int patch);

/// Raises stretches of the first n directions that are nearly zero or negative, sets those of the
/// others to zero, and clears a reaction that is small beside them.
void make_definite(PatchCoefficients& coefficients, int n_directions);

}  // namespace couture::iga
