#pragma once

#include <array>
#include <memory>

#include "iga/linalg/block_matrix.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Multilinear functions on a coarse grid of every patch, as combinations of the space's functions
/// (by their values at the Greville points).
struct CoarseFunctions {
    int n_nodes = 0;
    /// Nodes and weights of each function of the space: entries [begin[i], begin[i + 1]).
    std::vector<std::int64_t> begin;
    std::vector<int> nodes;
    std::vector<double> weights;
    /// Of each patch the elements of its grid in each direction (1 in one that is missing), and its
    /// nodes, first direction fastest.
    std::vector<std::array<int, 3>> n_elements;
    std::vector<std::vector<int>> nodes_of_patch;
    /// [patch][side]: nodes on the side.
    std::vector<std::vector<std::vector<int>>> nodes_on_side;
    /// [patch][side]: functions of the space on the side.
    std::vector<std::vector<std::vector<int>>> functions_on_side;
};

/// @param elements_per_node  the grid has about this many times fewer elements than the space
/// @param n_elements_max  at most so many in each direction
template <int d>
[[nodiscard]] CoarseFunctions make_coarse_functions(const Space<d>& space, int elements_per_node,
                                                    int n_elements_max);

/// Galerkin approximation P (P^T A P)^-1 P^T of A^-1 on coarse functions times the components.
/// Nodes on sides that are fixed in a component are left out there.
class CoarseSpace {
  public:
    /// @param is_fixed  n_unknowns flags
    /// @param translations  n_unknowns x components: axes of the unknowns of each function; empty:
    ///                      those of the components
    CoarseSpace(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                const MatrixX& translations, CoarseFunctions functions);
    /// @param coarse  spectrally equivalent to P^T A P: upper triangle of blocks of all nodes
    CoarseSpace(CoarseFunctions functions, BlockMatrix coarse, const std::vector<char>& is_fixed,
                const MatrixX& translations);

    [[nodiscard]] VectorX apply(const VectorX& r) const;
    [[nodiscard]] int n_unknowns() const { return matrix_->n_unknowns(); }
    [[nodiscard]] std::size_t memory() const;

  private:
    /// Block of function i in P without the weight.
    [[nodiscard]] MatrixX block(int i) const;
    [[nodiscard]] BlockMatrix galerkin(const BlockMatrix& matrix) const;
    void find_fixed_nodes();
    void factorize();

    CoarseFunctions functions_;
    int block_size_;
    std::vector<char> is_fixed_;
    /// Functions whose unknowns are along other axes, and these: rows of an orthogonal matrix.
    std::vector<char> is_turned_;
    MatrixX translations_;
    std::unique_ptr<BlockMatrix> matrix_;
    std::vector<char> is_node_fixed_;
    std::unique_ptr<LinearSolver> solver_;
};

}  // namespace couture::iga
