#pragma once

#include <functional>

#include "iga/assembly/constraints.h"
#include "iga/linalg/block_matrix.h"

namespace couture::iga {

/// What Newton's method needs of the other processes where each has some elements of a body. A
/// share is what this process' elements contribute; a complete vector holds, for each unknown that
/// this process has, the sum of the shares of all. All calls are collective.
template <int d>
class BodyShare {
  public:
    virtual ~BodyShare() = default;

    /// The problem on this process' pieces.
    [[nodiscard]] virtual Problem on_pieces(const Problem& whole) const = 0;
    /// @throws InputError  if rigid-body motions are free
    virtual void require_held(const Problem& whole) const = 0;
    [[nodiscard]] virtual Constraints<d> constraints(const Problem& whole) const = 0;
    /// Share of `assemble_loads`, n_dofs x d.
    [[nodiscard]] virtual MatrixX loads(const Problem& whole) const = 0;

    /// Complete from shares, column by column of unknowns.
    [[nodiscard]] virtual MatrixX complete(const MatrixX& share) const = 0;
    /// 1 / processes that have it, for each unknown here.
    [[nodiscard]] virtual const VectorX& weights() const = 0;
    [[nodiscard]] virtual double sum(double value) const = 0;
    [[nodiscard]] virtual double max(double value) const = 0;

    /// Solves with the sum of the shares for complete columns; zero at fixed unknowns.
    ///
    /// @param skew  share of what makes the matrix unsymmetric, between free unknowns; may be empty
    ///              on all
    /// @param motions  unknowns x motions without energy, in the frames
    /// @throws SolverError  if that fails, on all
    [[nodiscard]] virtual MatrixX solve(const BlockMatrix& share, const SparseMatrix& skew,
                                        const std::vector<char>& is_fixed, const MatrixX& motions,
                                        const MatrixX& b) = 0;
};

}  // namespace couture::iga
