#pragma once

#include "iga/distributed/distributed_space.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/solve/body_share.h"

namespace couture::iga {

/// A rank's elements of a hyperelastic body, for `follow_loads`.
template <int d>
class DistributedBody final : public BodyShare<d> {
  public:
    /// All must outlive this.
    DistributedBody(const Communicator& ranks, RefinedGeometry<d>& geometry,
                    const DistributedSpace<d>& space, SolverOptions solver,
                    std::optional<int> n_gauss_points);

    [[nodiscard]] Problem on_pieces(const Problem& whole) const override;
    void require_held(const Problem& whole) const override;
    [[nodiscard]] Constraints<d> constraints(const Problem& whole) const override;
    [[nodiscard]] MatrixX loads(const Problem& whole) const override;
    [[nodiscard]] MatrixX complete(const MatrixX& share) const override;
    [[nodiscard]] const VectorX& weights() const override { return weights_; }
    [[nodiscard]] double sum(double value) const override { return ranks_.sum(value); }
    [[nodiscard]] double max(double value) const override { return ranks_.max(value); }
    [[nodiscard]] MatrixX solve(const BlockMatrix& share, const SparseMatrix& skew,
                                const std::vector<char>& is_fixed, const MatrixX& motions,
                                const MatrixX& b) override;

  private:
    const Communicator& ranks_;
    RefinedGeometry<d>& geometry_;
    const DistributedSpace<d>& space_;
    SolverOptions solver_;
    std::optional<int> n_gauss_points_;
    VectorX weights_;
    std::vector<char> is_owner_;
};

}  // namespace couture::iga
