#include "iga/solve/static_system.h"

#include <algorithm>

namespace couture::iga {

void add_symmetric(BlockMatrix& matrix, const SparseMatrix& addition) {
    const int n = matrix.block_size;
    for (int column = 0; column < addition.outerSize(); ++column) {
        for (SparseMatrix::InnerIterator it(addition, column); it; ++it) {
            const int row_block = static_cast<int>(it.row()) / n;
            const int column_block = column / n;
            if (row_block > column_block) {
                continue;
            }
            const auto first = matrix.columns.begin() + matrix.row_begin[row_block];
            const auto last = matrix.columns.begin() + matrix.row_begin[row_block + 1];
            const auto place = std::lower_bound(first, last, column_block);
            matrix
                .values[(place - matrix.columns.begin()) * n * n + it.row() % n * n + column % n] +=
                it.value();
        }
    }
}

template <int d>
void rotate_to_frames(BlockMatrix& matrix, const Constraints<d>& constraints) {
    if (constraints.frames.empty()) {
        return;
    }
    std::vector<const Matrix<d>*> frame(matrix.n_rows, nullptr);
    for (const auto& [dof, Q] : constraints.frames) {
        frame[dof] = &Q;
    }
    using Block = Eigen::Matrix<double, d, d, Eigen::RowMajor>;
    for (int row = 0; row < matrix.n_rows; ++row) {
        for (std::int64_t e = matrix.row_begin[row]; e < matrix.row_begin[row + 1]; ++e) {
            Eigen::Map<Block> block(&matrix.values[e * d * d]);
            if (frame[row] != nullptr) {
                block = (*frame[row] * block).eval();
            }
            if (const Matrix<d>* Q = frame[matrix.columns[e]]; Q != nullptr) {
                block = (block * Q->transpose()).eval();
            }
        }
    }
}

VectorX flatten(const MatrixX& coefficients) { return coefficients.transpose().reshaped(); }

MatrixX unflatten(const VectorX& unknowns, int n_components) {
    return unknowns.reshaped(n_components, unknowns.size() / n_components).transpose();
}

Vector3 sum_of_components(const MatrixX& forces) {
    Vector3 sum = Vector3::Zero();
    sum.head(forces.cols()) = forces.colwise().sum().transpose();
    return sum;
}

template <int d>
std::map<std::string, Vector3> support_reactions(const Problem& problem,
                                                 const Constraints<d>& constraints,
                                                 const VectorX& residual) {
    const int nc = constraints.n_components;
    std::map<std::string, Vector3> reactions;
    for (const Support& support : problem.supports) {
        reactions.try_emplace(support.on, Vector3::Zero());
    }
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
        if (constraints.is_fixed[i] == 0) {
            continue;
        }
        Vector3 force = Vector3::Zero();
        const auto frame = constraints.frames.find(static_cast<int>(i) / nc);
        if (frame == constraints.frames.end()) {
            force[i % nc] = residual[i];
        } else {
            force.head<d>() = residual[i] * frame->second.row(i % nc).transpose();
        }
        reactions[problem.supports[constraints.support[i]].on] += force;
    }
    return reactions;
}

template void rotate_to_frames<2>(BlockMatrix&, const Constraints<2>&);
template void rotate_to_frames<3>(BlockMatrix&, const Constraints<3>&);
template std::map<std::string, Vector3> support_reactions<2>(const Problem&, const Constraints<2>&,
                                                             const VectorX&);
template std::map<std::string, Vector3> support_reactions<3>(const Problem&, const Constraints<3>&,
                                                             const VectorX&);

}  // namespace couture::iga
