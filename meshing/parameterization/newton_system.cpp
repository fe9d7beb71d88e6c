#include "meshing/parameterization/newton_system.h"

#include <algorithm>

#include "iga/core/error.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::meshing {

struct NewtonSystem::Factor {
    // Rows of the upper triangle: the columns of matrix_.
    iga::BlockMatrix matrix;
    std::unique_ptr<iga::LinearSolver> solver;
};

NewtonSystem::NewtonSystem(int n_unknowns, std::vector<Element> elements)
    : elements_(std::move(elements)),
      gradient_(VectorX::Zero(n_unknowns)),
      matrix_(n_unknowns, n_unknowns),
      factor_(std::make_unique<Factor>()) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n_unknowns; ++i) entries.emplace_back(i, i, 0.0);
    for (const Element& element : elements_) {
        for (const int row : element) {
            for (const int column : element) {
                if (column >= 0 && row >= column) entries.emplace_back(row, column, 0.0);
            }
        }
    }
    matrix_.setFromTriplets(entries.begin(), entries.end());
    const auto* begin = matrix_.outerIndexPtr();
    const auto* rows = matrix_.innerIndexPtr();
    for (const Element& element : elements_) {
        std::array<int, 36>& places = places_.emplace_back();
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j < 6; ++j) {
                const int row = element[i];
                const int column = element[j];
                const bool is_stored = column >= 0 && row >= column;
                places[6 * i + j] =
                    is_stored ? static_cast<int>(std::lower_bound(rows + begin[column],
                                                                  rows + begin[column + 1], row) -
                                                 rows)
                              : -1;
            }
        }
    }
    factor_->matrix.n_rows = n_unknowns;
    factor_->matrix.row_begin.assign(begin, begin + n_unknowns + 1);
    factor_->matrix.columns.assign(rows, rows + matrix_.nonZeros());
    iga::SolverOptions options;
    options.name = "cholmod";
    // Steps are searched along, so that they need not be exact; near-flat cells condition badly.
    constexpr double inexact = 1e-6;
    options.tolerance = inexact;
    factor_->solver = iga::make_linear_solver(options);
}

NewtonSystem::NewtonSystem(NewtonSystem&&) noexcept = default;
NewtonSystem& NewtonSystem::operator=(NewtonSystem&&) noexcept = default;
NewtonSystem::~NewtonSystem() = default;

void NewtonSystem::set_zero() {
    gradient_.setZero();
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
}

void NewtonSystem::add(int element, const Vector<6>& gradient, const Matrix<6>& hessian) {
    double* values = matrix_.valuePtr();
    for (int i = 0; i < 6; ++i) {
        if (elements_[element][i] >= 0) gradient_[elements_[element][i]] += gradient[i];
        for (int j = 0; j < 6; ++j) {
            const int place = places_[element][6 * i + j];
            if (place >= 0) values[place] += hessian(i, j);
        }
    }
}

VectorX NewtonSystem::step() {
    if (gradient_.size() == 0) return gradient_;
    constexpr double regularization = 1e-12;
    double largest = 0.0;
    for (Eigen::Index i = 0; i < matrix_.cols(); ++i) {
        largest = std::max(largest, matrix_.valuePtr()[matrix_.outerIndexPtr()[i]]);
    }
    for (Eigen::Index i = 0; i < matrix_.cols(); ++i) {
        matrix_.valuePtr()[matrix_.outerIndexPtr()[i]] += regularization * largest;
    }
    factor_->matrix.values =
        Buffer<double>(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
    factor_->solver->factorize({.matrix = factor_->matrix, .is_fixed = {}, .near_null_space = {}});
    MatrixX step;
    factor_->solver->solve(-gradient_, step);
    return step.col(0);
}

}  // namespace couture::meshing
