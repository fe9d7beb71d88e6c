#include "rom/tensor_design.h"

namespace couture::rom {

int TensorDesign::n_points() const {
    int n = 1;
    for (const MatrixX& factor : factors) {
        n *= static_cast<int>(factor.rows());
    }
    return n;
}

int TensorDesign::n_parameters() const {
    int n = 0;
    for (const MatrixX& factor : factors) {
        n += static_cast<int>(factor.cols());
    }
    return n;
}

std::vector<int> TensorDesign::sizes() const {
    std::vector<int> sizes;
    for (const MatrixX& factor : factors) {
        sizes.push_back(static_cast<int>(factor.rows()));
    }
    return sizes;
}

MatrixX TensorDesign::points() const {
    MatrixX points(n_points(), n_parameters());
    for (int i = 0; i < points.rows(); ++i) {
        Eigen::Index column = points.cols();
        int rest = i;
        for (std::size_t g = factors.size(); g-- > 0;) {
            const MatrixX& factor = factors[g];
            const int n = static_cast<int>(factor.rows());
            column -= factor.cols();
            points.row(i).segment(column, factor.cols()) = factor.row(rest % n);
            rest /= n;
        }
    }
    return points;
}

}  // namespace couture::rom
