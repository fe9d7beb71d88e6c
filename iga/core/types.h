#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>

namespace couture {

using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;
/// Compressed columns.
using SparseMatrix = Eigen::SparseMatrix<double>;

template <int n>
using Vector = Eigen::Matrix<double, n, 1>;
template <int rows, int columns = rows>
using Matrix = Eigen::Matrix<double, rows, columns>;

using Vector2 = Vector<2>;
using Vector3 = Vector<3>;

}  // namespace couture
