#include "meshing/volume/coons.h"

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

constexpr int power_of_3(int exponent) { return exponent == 0 ? 1 : 3 * power_of_3(exponent - 1); }

// Greville abscissae as parts of the interval.
std::vector<double> unit_greville(const iga::KnotVector& knots) {
    return knots.rescaled(0.0, 1.0).greville();
}

}  // namespace

template <int d>
MatrixX fill_coons(const iga::TensorSpace<d>& space, MatrixX net) {
    if (net.rows() != space.n_basis()) {
        throw InputError("fill_coons: the net has {} rows; the space has {} functions", net.rows(),
                         space.n_basis());
    }
    std::array<std::vector<double>, d> xi;
    for (int k = 0; k < d; ++k) xi[k] = unit_greville(space.knots[k]);
    const std::array<int, d> sizes = space.sizes();
    for (int row = 0; row < net.rows(); ++row) {
        const std::array<int, d> at = space.indices(row);
        bool is_inner = true;
        for (int k = 0; k < d; ++k) is_inner = is_inner && at[k] > 0 && at[k] + 1 < sizes[k];
        if (!is_inner) continue;
        // Each direction free, at its low or at its high end: faces count once, edges are taken
        // off, corners put back.
        Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(net.cols());
        for (int code = 1; code < power_of_3(d); ++code) {
            std::array<int, d> end = at;
            double weight = -1.0;
            for (int k = 0, rest = code; k < d; ++k, rest /= 3) {
                if (rest % 3 == 0) continue;
                const bool is_high = rest % 3 == 2;
                end[k] = is_high ? sizes[k] - 1 : 0;
                weight *= is_high ? -xi[k][at[k]] : xi[k][at[k]] - 1.0;
            }
            sum += weight * net.row(space.index(end));
        }
        net.row(row) = sum;
    }
    return net;
}

template MatrixX fill_coons<2>(const iga::TensorSpace<2>&, MatrixX);
template MatrixX fill_coons<3>(const iga::TensorSpace<3>&, MatrixX);

MatrixX straight_net(const iga::KnotVector& knots, const MatrixX& first, const MatrixX& last) {
    const std::vector<double> xi = unit_greville(knots);
    MatrixX net(knots.n_basis(), first.cols());
    for (int i = 0; i < net.rows(); ++i) net.row(i) = (1.0 - xi[i]) * first + xi[i] * last;
    net.row(0) = first;
    net.row(net.rows() - 1) = last;
    return net;
}

}  // namespace couture::meshing
