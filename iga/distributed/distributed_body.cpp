#include "iga/distributed/distributed_body.h"

#include "iga/distributed/distributed_constraints.h"
#include "iga/distributed/distributed_solver.h"

namespace couture::iga {

template <int d>
DistributedBody<d>::DistributedBody(const Communicator& ranks, RefinedGeometry<d>& geometry,
                                    const DistributedSpace<d>& space, SolverOptions solver,
                                    std::optional<int> n_gauss_points)
    : ranks_(ranks),
      geometry_(geometry),
      space_(space),
      solver_(std::move(solver)),
      n_gauss_points_(n_gauss_points),
      weights_(static_cast<Eigen::Index>(space.numbers.n_local()) * d),
      is_owner_(space.numbers.n_local(), 0) {
    for (int i = 0; i < space.numbers.n_local(); ++i) {
        weights_.segment<d>(static_cast<Eigen::Index>(i) * d)
            .setConstant(1.0 / space.numbers.multiplicities()[i]);
    }
    for (const int i : space.numbers.owned()) {
        is_owner_[i] = 1;
    }
}

template <int d>
Problem DistributedBody<d>::on_pieces(const Problem& whole) const {
    return iga::on_pieces(whole, space_.pieces.boxes);
}

template <int d>
void DistributedBody<d>::require_held(const Problem& whole) const {
    ranks_.together([&] { iga::require_held<d>(geometry_.geometry(), whole); });
}

template <int d>
Constraints<d> DistributedBody<d>::constraints(const Problem& whole) const {
    Constraints<d> result;
    ranks_.together([&] { result = constraints_on(geometry_, space_.pieces, whole, {""}); });
    return result;
}

template <int d>
MatrixX DistributedBody<d>::loads(const Problem& whole) const {
    MatrixX result;
    ranks_.together([&] {
        result = loads_on(geometry_, space_.pieces, is_owner_, whole, on_pieces(whole), "",
                          n_gauss_points_);
    });
    return result;
}

template <int d>
MatrixX DistributedBody<d>::complete(const MatrixX& share) const {
    MatrixX result(share.rows(), share.cols());
    for (Eigen::Index k = 0; k < share.cols(); ++k) {
        result.col(k) = space_.numbers.spread(space_.numbers.add(share.col(k), d), d);
    }
    return result;
}

template <int d>
MatrixX DistributedBody<d>::solve(const BlockMatrix& share, const SparseMatrix& skew,
                                  const std::vector<char>& is_fixed, const MatrixX& motions,
                                  const MatrixX& b) {
    const bool is_symmetric = ranks_.sum(static_cast<std::int64_t>(skew.nonZeros())) == 0;
    DistributedSolver solver(ranks_, solver_);
    solver.factorize(
        {space_.numbers, d, &share, is_fixed, motions, is_symmetric ? nullptr : &skew});
    MatrixX x;
    (void)solver.solve(weights_.asDiagonal() * b, x);
    return x;
}

template class DistributedBody<2>;
template class DistributedBody<3>;

}  // namespace couture::iga
