#include "rom/trend.h"

#include <cassert>

namespace couture::rom {

std::string to_string(Trend trend) {
    static constexpr const char* names[] = {"constant", "linear", "quadratic", "automatic"};
    return names[static_cast<int>(trend)];
}

int n_trend_functions(Trend trend, int n_inputs) {
    assert(trend != Trend::automatic);
    if (trend == Trend::constant) return 1;
    return 1 + n_inputs + (trend == Trend::quadratic ? n_inputs * (n_inputs + 1) / 2 : 0);
}

MatrixX trend_functions(const MatrixX& points, Trend trend) {
    const auto d = static_cast<int>(points.cols());
    MatrixX F = MatrixX::Ones(points.rows(), n_trend_functions(trend, d));
    if (trend == Trend::constant) return F;
    F.middleCols(1, d) = points;
    if (trend == Trend::linear) return F;
    for (int i = 0, k = 1 + d; i < d; ++i) {
        for (int j = i; j < d; ++j) F.col(k++) = points.col(i).cwiseProduct(points.col(j));
    }
    return F;
}

MatrixX independent_trend(const MatrixX& points, Trend trend) {
    MatrixX F = trend_functions(points, trend);
    MatrixX Q(F.rows(), F.cols());
    Eigen::Index n = 0;
    for (Eigen::Index j = 0; j < F.cols(); ++j) {
        VectorX rest = F.col(j);
        // Twice: rounding of the first pass is as large as what may be left.
        for (int pass = 0; pass < 2; ++pass) {
            rest -= Q.leftCols(n) * (Q.leftCols(n).transpose() * rest);
        }
        constexpr double dependent = 1e-8;
        if (rest.norm() > dependent * F.col(j).norm()) {
            Q.col(n++) = rest.normalized();
        } else {
            F.col(j).setZero();
        }
    }
    return F;
}

int n_independent_terms(const MatrixX& points, Trend trend) {
    const MatrixX F = independent_trend(points, trend);
    int n = 0;
    for (Eigen::Index j = 0; j < F.cols(); ++j) n += F.col(j).isZero(0.0) ? 0 : 1;
    return n;
}

MatrixX trend_slopes(const VectorX& point, Trend trend) {
    const auto d = static_cast<int>(point.size());
    MatrixX slopes = MatrixX::Zero(n_trend_functions(trend, d), d);
    if (trend == Trend::constant) return slopes;
    slopes.middleRows(1, d).setIdentity();
    if (trend == Trend::linear) return slopes;
    for (int i = 0, k = 1 + d; i < d; ++i) {
        for (int j = i; j < d; ++j, ++k) {
            slopes(k, i) += point[j];
            slopes(k, j) += point[i];
        }
    }
    return slopes;
}

}  // namespace couture::rom
