#pragma once

#include <cstdint>
#include <optional>

#include "iga/core/types.h"
#include "rom/inner_product.h"

namespace couture::rom {

struct PodOptions {
    /// At most this many modes; without it as many as the tolerance asks for.
    std::optional<int> n_modes = std::nullopt;
    /// Modes are left out while the relative error (1.14) of the snapshots stays below this; 0
    /// keeps the numerical rank.
    double tolerance = 0.0;
    /// More snapshots than this are compressed by a randomised range finder.
    int randomised_above = 4000;
    std::uint64_t seed = 1;
};

/// Modes of a set of fields by proper orthogonal decomposition.
struct PodBasis {
    /// n_values x n_modes, orthonormal in the inner product; the largest value of each is positive.
    MatrixX modes;
    /// All that were computed, falling; at least as many as modes.
    VectorX singular_values;
    /// Sum of the squares of those that were not computed; 0 unless randomised.
    double remaining_energy = 0.0;
    /// Number of singular values above rounding: no more modes have a meaning.
    int rank = 0;

    /// Error of the best approximation of the snapshots by that many modes, over their norm.
    ///
    /// Source: [Maquart19] Eq. (1.14).
    [[nodiscard]] double relative_error(int n_modes) const;
};

/// The basis of rank r that is nearest to the snapshots in the inner product.
///
/// A Householder QR factorization in the inner product and the SVD of R: small singular values
/// keep an absolute accuracy of rounding times the largest, which the eigenvalues of U^T W U lose.
///
/// @param snapshots  n_values x n_snapshots, a field in each column
/// @throws InputError  without snapshots, for values that are not finite, for fewer than 1 mode
///
/// Source: [Maquart19] Sec. 1.3.2, Eq. (1.12)-(1.14); [HalkoMartinssonTropp11] Alg. 4.4, 5.1.
[[nodiscard]] PodBasis make_pod_basis(const MatrixX& snapshots, const InnerProduct& product,
                                      const PodOptions& options = {});

/// Coefficients of fields in the basis: n_modes x n_fields. Source: [Maquart19] Eq. (1.20).
[[nodiscard]] MatrixX project(const PodBasis& basis, const InnerProduct& product,
                              const MatrixX& fields);

}  // namespace couture::rom
