#include "iga/solve/matrix_free_system.h"

#include <algorithm>

#include "iga/assembly/partial_assembly.h"
#include "iga/assembly/sparsity.h"
#include "iga/linalg/conjugate_gradients.h"
#include "iga/linalg/system_checks.h"
#include "iga/solve/static_system.h"

namespace couture::iga {

namespace {

constexpr const char* solver_name = "matrix_free";
/// Added to the coarse matrix' diagonal, as part of it: the one-point rule may leave motions of
/// very uneven elements without energy.
constexpr double coarse_shift = 1e-8;

using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix to_sparse(Eigen::Index n, const Triplets& entries) {
    SparseMatrix result(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

}  // namespace

template <int d>
MatrixFreeSystem<d>::MatrixFreeSystem(const Space<d>& space, BilinearForm<d> form,
                                      SparseMatrix addition, const Constraints<d>& constraints,
                                      std::optional<int> n_gauss_points)
    : space_(space),
      constraints_(constraints),
      form_(space, std::move(form), n_gauss_points),
      addition_(std::move(addition)),
      n_gauss_points_(n_gauss_points) {}

template <int d>
VectorX MatrixFreeSystem<d>::multiply(const VectorX& u) const {
    MatrixX global = u;
    constraints_.to_global(global);
    MatrixX product = form_ * VectorX(global.col(0));
    if (addition_.nonZeros() > 0) {
        product += addition_ * global;
    }
    constraints_.to_frames(product);
    return product.col(0);
}

template <int d>
MatrixX MatrixFreeSystem<d>::operator*(const MatrixX& u) const {
    MatrixX result(u.rows(), u.cols());
    for (Eigen::Index k = 0; k < u.cols(); ++k) {
        result.col(k) = multiply(u.col(k));
    }
    return result;
}

template <int d>
VectorX MatrixFreeSystem<d>::diagonal() const {
    const int nc = form_.n_components();
    MatrixX blocks = form_.diagonal_blocks(constraints_.frames.empty());
    for (int column = 0; column < addition_.outerSize(); ++column) {
        for (SparseMatrix::InnerIterator it(addition_, column); it; ++it) {
            if (it.row() / nc == column / nc) {
                blocks(it.row(), column % nc) += it.value();
            }
        }
    }
    for (const auto& [dof, Q] : constraints_.frames) {
        blocks.middleRows(d * dof, d) =
            (Q * Matrix<d>(blocks.middleRows(d * dof, d)) * Q.transpose()).eval();
    }
    VectorX result(blocks.rows());
    for (Eigen::Index i = 0; i < blocks.rows(); ++i) {
        result[i] = blocks(i, i % nc);
    }
    return result;
}

template <int d>
BlockMatrix MatrixFreeSystem<d>::submatrix(const std::vector<int>& functions) const {
    const int nc = form_.n_components();
    BlockMatrix matrix = assemble_between(space_, form_.form(), functions, n_gauss_points_);
    std::vector<int> row_of_dof(space_.n_dofs(), -1);
    Constraints<d> own;
    for (std::size_t i = 0; i < functions.size(); ++i) {
        row_of_dof[functions[i]] = static_cast<int>(i);
        const auto frame = constraints_.frames.find(functions[i]);
        if (frame != constraints_.frames.end()) {
            own.frames.emplace(static_cast<int>(i), frame->second);
        }
    }
    Triplets entries;
    for (int column = 0; column < addition_.outerSize(); ++column) {
        for (SparseMatrix::InnerIterator it(addition_, column); it; ++it) {
            const int i = row_of_dof[it.row() / nc];
            const int j = row_of_dof[column / nc];
            if (i >= 0 && j >= 0) {
                entries.emplace_back(i * nc + it.row() % nc, j * nc + column % nc, it.value());
            }
        }
    }
    add_symmetric(matrix, to_sparse(matrix.n_unknowns(), entries));
    rotate_to_frames(matrix, own);
    return matrix;
}

/// A fixed unknown is zero in the space but not in the coarse functions: they pay for what they
/// give it as if it stood alone, by the diagonal. What is added pays by its rows' sums.
template <int d>
BlockMatrix MatrixFreeSystem<d>::coarse_matrix(const CoarseFunctions& functions,
                                               const VectorX& diagonal) const {
    const int nc = form_.n_components();
    BlockMatrix matrix = assemble_multilinear(space_, form_.form(), functions);
    for (int row = 0; row < matrix.n_rows; ++row) {
        for (int c = 0; c < nc; ++c) {
            matrix.values[matrix.row_begin[row] * nc * nc + c * (nc + 1)] *= 1.0 + coarse_shift;
        }
    }
    std::map<int, MatrixX> blocks;
    const auto block_of = [&](int dof) -> MatrixX& {
        return blocks.try_emplace(dof, MatrixX::Zero(nc, nc)).first->second;
    };
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
        if (constraints_.is_fixed[i] == 0) {
            continue;
        }
        const int dof = static_cast<int>(i) / nc;
        VectorX direction = VectorX::Unit(nc, i % nc);
        const auto frame = constraints_.frames.find(dof);
        if (frame != constraints_.frames.end()) {
            direction = frame->second.row(i % nc).transpose();
        }
        block_of(dof) += diagonal[i] * direction * direction.transpose();
    }
    for (int column = 0; column < addition_.outerSize(); ++column) {
        for (SparseMatrix::InnerIterator it(addition_, column); it; ++it) {
            block_of(column / nc)(it.row() % nc, column % nc) += it.value();
        }
    }
    Triplets entries;
    for (const auto& [dof, block] : blocks) {
        for (std::int64_t k = functions.begin[dof]; k < functions.begin[dof + 1]; ++k) {
            for (std::int64_t l = functions.begin[dof]; l < functions.begin[dof + 1]; ++l) {
                const double weight = functions.weights[k] * functions.weights[l];
                for (int a = 0; a < nc; ++a) {
                    for (int b = 0; b < nc; ++b) {
                        entries.emplace_back(functions.nodes[k] * nc + a,
                                             functions.nodes[l] * nc + b,
                                             0.5 * weight * (block(a, b) + block(b, a)));
                    }
                }
            }
        }
    }
    add_symmetric(matrix, to_sparse(matrix.n_unknowns(), entries));
    return matrix;
}

template <int d>
void MatrixFreeSystem<d>::prepare(const MatrixX& near_null_space) {
    MatrixFreeParts parts;
    parts.block_size = form_.n_components();
    parts.is_fixed = constraints_.is_fixed;
    parts.near_null_space = near_null_space;
    parts.coefficients = form_.mean_coefficients();
    parts.diagonal = diagonal();
    scale_ = parts.diagonal.size() > 0 ? parts.diagonal.maxCoeff() : 0.0;
    parts.submatrix = [this](const std::vector<int>& functions) { return submatrix(functions); };
    parts.coarse_matrix = [this, &parts](const CoarseFunctions& functions) {
        return coarse_matrix(functions, parts.diagonal);
    };
    preconditioner_ = std::make_unique<FastDiagonalization>(space_, parts);
}

template <int d>
SolveReport MatrixFreeSystem<d>::solve(const MatrixX& b, const SolverOptions& options,
                                       MatrixX& x) const {
    SolveReport report;
    report.solver = solver_name;
    report.memory = memory();
    ConjugateGradientOptions iteration;
    iteration.tolerance = options.tolerance;
    iteration.max_iterations = options.max_iterations;
    const MatrixX free_b = free_part(constraints_.is_fixed, b);
    x = MatrixX::Zero(b.rows(), b.cols());
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
        x.col(k) = conjugate_gradients(
            solver_name, [this](const VectorX& p) { return multiply(p); }, constraints_.is_fixed,
            free_b.col(k), [this](const VectorX& r) { return preconditioner_->apply(r); },
            iteration, report);
    }
    return report;
}

template <int d>
std::size_t MatrixFreeSystem<d>::memory() const {
    return form_.memory() + (preconditioner_ ? preconditioner_->memory() : 0);
}

template <int d>
std::size_t matrix_memory(const Space<d>& space, int block_size) {
    double n_blocks = 0.0;
    for (int p = 0; p < space.n_patches(); ++p) {
        double of_patch = 1.0;
        for (const KnotVector& knots : space.tensor(p).knots) {
            const NeighbourRange range = neighbours(knots);
            double n = 0.0;
            for (std::size_t i = 0; i < range.first.size(); ++i) {
                n += range.last[i] - range.first[i] + 1;
            }
            of_patch *= n;
        }
        n_blocks += 0.5 * (of_patch + space.tensor(p).n_basis());
    }
    const double n_bytes = sizeof(double) * block_size * block_size + sizeof(int);
    return static_cast<std::size_t>(n_blocks * n_bytes);
}

template class MatrixFreeSystem<2>;
template class MatrixFreeSystem<3>;
template std::size_t matrix_memory(const Space<2>&, int);
template std::size_t matrix_memory(const Space<3>&, int);

}  // namespace couture::iga
