#include "iga/linalg/patch_coefficients.h"

#include <algorithm>

#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Pieces of work; sums are taken piece by piece, the same for any number of threads.
constexpr int n_chunks = 32;
/// Smallest stretch as part of the largest, and smallest reaction as part of the stretches.
constexpr double smallest_stretch = 1e-8;
constexpr double smallest_reaction = 1e-10;

/// Functions whose rows are complete and without boundary terms; with fewer to choose from, any.
std::vector<char> choose_functions(const PatchStructure& structure, int patch) {
    const PatchFunctions& functions = structure.patches[patch];
    std::vector<char> inner(functions.dofs.size(), 0);
    std::vector<char> interior(functions.dofs.size(), 0);
    std::array<int, 3> i{};
    for (i[2] = 0; i[2] < functions.size(2); ++i[2]) {
        for (i[1] = 0; i[1] < functions.size(1); ++i[1]) {
            for (i[0] = 0; i[0] < functions.size(0); ++i[0]) {
                const int f = functions.index(i);
                interior[f] = structure.places[functions.dofs[f]] == Place::interior ? 1 : 0;
                inner[f] = interior[f];
                for (int k = 0; k < 3; ++k) {
                    const bool is_end = i[k] == 0 || i[k] == functions.size(k) - 1;
                    inner[f] = is_end && functions.size(k) > 1 ? 0 : inner[f];
                }
            }
        }
    }
    for (const std::vector<char>& some : {inner, interior}) {
        if (std::find(some.begin(), some.end(), 1) != some.end()) {
            return some;
        }
    }
    return std::vector<char>(functions.dofs.size(), 1);
}

}  // namespace

std::vector<PatchCoefficients> patch_coefficients(const BlockMatrix& matrix,
                                                  const PatchStructure& structure, int patch) {
    const PatchFunctions& functions = structure.patches[patch];
    const int n_functions = static_cast<int>(functions.dofs.size());
    const int nc = matrix.block_size;
    const std::vector<char> is_chosen = choose_functions(structure, patch);
    std::vector<int> local(structure.n_dofs, -1);
    for (int f = 0; f < n_functions; ++f) {
        local[functions.dofs[f]] = f;
    }
    const auto indices = [&](int f) {
        return std::array<int, 3>{f % functions.size(0), f / functions.size(0) % functions.size(1),
                                  f / (functions.size(0) * functions.size(1))};
    };
    // Moments in the three directions, then the sum: [component][4].
    std::vector<MatrixX> sums(n_chunks, MatrixX::Zero(4, nc));
    parallel_for(n_chunks, [&](int chunk) {
        const auto bound = [&](int c) {
            return static_cast<int>(static_cast<std::int64_t>(n_functions) * c / n_chunks);
        };
        MatrixX& sum = sums[chunk];
        for (int f = bound(chunk); f < bound(chunk + 1); ++f) {
            const int row = functions.dofs[f];
            if (local[row] != f) {
                continue;
            }
            const auto i = indices(f);
            for (std::int64_t e = matrix.row_begin[row]; e < matrix.row_begin[row + 1]; ++e) {
                const int g = local[matrix.columns[e]];
                if (g < 0 || (is_chosen[f] == 0 && is_chosen[g] == 0)) {
                    continue;
                }
                const auto j = indices(g);
                const double n_rows = is_chosen[f] + (f == g ? 0 : is_chosen[g]);
                Vector<4> moment(0.0, 0.0, 0.0, n_rows);
                for (int k = 0; k < 3; ++k) {
                    const Univariate& u = *functions.directions[k];
                    const double product = 2.0 * u.linear[i[k]] * u.linear[j[k]];
                    const auto of_row = [&](int from, int to) {
                        return 0.5 * (u.square[to] - product + u.linear[from] * u.linear[from]);
                    };
                    moment[k] = is_chosen[f] * of_row(i[k], j[k]) +
                                (f == g ? 0.0 : is_chosen[g] * of_row(j[k], i[k]));
                }
                for (int c = 0; c < nc; ++c) {
                    sum.col(c) += matrix.values[(e * nc + c) * nc + c] * moment;
                }
            }
        }
    });
    MatrixX sum = MatrixX::Zero(4, nc);
    for (const MatrixX& part : sums) {
        sum += part;
    }
    double volume = 0.0;
    for (int f = 0; f < n_functions; ++f) {
        const auto i = indices(f);
        volume += is_chosen[f] * functions.directions[0]->integral[i[0]] *
                  functions.directions[1]->integral[i[1]] * functions.directions[2]->integral[i[2]];
    }
    std::vector<PatchCoefficients> result(nc);
    for (int c = 0; c < nc; ++c) {
        for (int k = 0; k < 3; ++k) {
            result[c].stretch[k] = -sum(k, c) / volume;
        }
        result[c].reaction = sum(3, c) / volume;
        make_definite(result[c], functions.size(2) > 1 ? 3 : 2);
    }
    return result;
}

void make_definite(PatchCoefficients& coefficients, int n_directions) {
    double largest = 0.0;
    for (int k = 0; k < n_directions; ++k) {
        largest = std::max(largest, coefficients.stretch[k]);
    }
    for (int k = 0; k < 3; ++k) {
        // A matrix without stiffness, like a mass matrix, has no positive moments.
        const double least = largest > 0.0 ? smallest_stretch * largest : 1.0;
        double& stretch = coefficients.stretch[k];
        stretch = k < n_directions ? std::max(stretch, least) : 0.0;
    }
    double& reaction = coefficients.reaction;
    reaction = reaction > smallest_reaction * largest ? reaction : 0.0;
}

}  // namespace couture::iga
