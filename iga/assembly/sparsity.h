#pragma once

#include "iga/linalg/block_matrix.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Where each global function lives: CSR over the functions of (patch, local function) pairs, in
/// order of patch and local number.
struct Incidence {
    std::vector<std::int64_t> begin;
    std::vector<int> patch;
    std::vector<int> function;
};

template <int d>
[[nodiscard]] Incidence make_incidence(const Space<d>& space);

/// Upper triangle of the pattern of all pairs of functions with common support, values not yet
/// set. Follows from the tensor structure, O(entries).
///
/// @throws SolverError  if the matrix would not fit into the machine's memory: the estimate
template <int d>
[[nodiscard]] BlockMatrix make_pattern(const Space<d>& space, int block_size);

/// First and last function in each direction whose support meets that of function i.
struct NeighbourRange {
    std::vector<int> first;
    std::vector<int> last;
};
[[nodiscard]] NeighbourRange neighbours(const KnotVector& knots);

}  // namespace couture::iga
