#include "meshing/topology/integer_lattice.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace couture::meshing {

IntegerMatrix multiply(const IntegerMatrix& a, const IntegerMatrix& b) {
    IntegerMatrix product;
    for (const auto& row : a) product.push_back(multiply(row, b));
    return product;
}

std::vector<long long> multiply(const std::vector<long long>& row, const IntegerMatrix& matrix) {
    std::vector<long long> product(matrix.empty() ? 0 : matrix.front().size(), 0);
    for (std::size_t k = 0; k < row.size(); ++k) {
        if (row[k] == 0) continue;
        for (std::size_t j = 0; j < product.size(); ++j) product[j] += row[k] * matrix[k][j];
    }
    return product;
}

long long determinant(IntegerMatrix matrix) {
    const std::size_t n = matrix.size();
    long long previous = 1;
    int sign = 1;
    for (std::size_t k = 0; k + 1 < n; ++k) {
        std::size_t pivot = k;
        while (pivot < n && matrix[pivot][k] == 0) ++pivot;
        if (pivot == n) return 0;
        if (pivot != k) {
            std::swap(matrix[pivot], matrix[k]);
            sign = -sign;
        }
        for (std::size_t i = k + 1; i < n; ++i) {
            for (std::size_t j = k + 1; j < n; ++j) {
                matrix[i][j] =
                    (matrix[i][j] * matrix[k][k] - matrix[i][k] * matrix[k][j]) / previous;
            }
        }
        previous = matrix[k][k];
    }
    return n == 0 ? 1 : sign * matrix[n - 1][n - 1];
}

namespace {

// The entry of smallest size other than 0 in rows and columns from k on; false if there is none.
bool find_pivot(const IntegerMatrix& matrix, std::size_t k, std::size_t& row, std::size_t& column) {
    long long best = 0;
    for (std::size_t i = k; i < matrix.size(); ++i) {
        for (std::size_t j = k; j < matrix[i].size(); ++j) {
            const long long size = std::llabs(matrix[i][j]);
            if (size != 0 && (best == 0 || size < best)) {
                best = size;
                row = i;
                column = j;
            }
        }
    }
    return best != 0;
}

}  // namespace

std::vector<long long> elementary_divisors(IntegerMatrix matrix) {
    std::vector<long long> divisors;
    const std::size_t n_rows = matrix.size();
    const std::size_t n_columns = n_rows == 0 ? 0 : matrix.front().size();
    for (std::size_t k = 0; k < std::min(n_rows, n_columns); ++k) {
        for (;;) {
            std::size_t row = k;
            std::size_t column = k;
            if (!find_pivot(matrix, k, row, column)) return divisors;
            std::swap(matrix[row], matrix[k]);
            for (auto& r : matrix) std::swap(r[column], r[k]);
            const long long pivot = matrix[k][k];
            bool is_clear = true;
            for (std::size_t i = k + 1; i < n_rows; ++i) {
                const long long factor = matrix[i][k] / pivot;
                for (std::size_t j = k; j < n_columns; ++j) matrix[i][j] -= factor * matrix[k][j];
                is_clear = is_clear && matrix[i][k] == 0;
            }
            for (std::size_t j = k + 1; j < n_columns; ++j) {
                const long long factor = matrix[k][j] / pivot;
                for (std::size_t i = k; i < n_rows; ++i) matrix[i][j] -= factor * matrix[i][k];
                is_clear = is_clear && matrix[k][j] == 0;
            }
            if (!is_clear) continue;
            // Each divisor must divide all that is left.
            bool divides = true;
            for (std::size_t i = k + 1; i < n_rows && divides; ++i) {
                for (std::size_t j = k + 1; j < n_columns && divides; ++j) {
                    if (matrix[i][j] % pivot == 0) continue;
                    for (std::size_t m = k; m < n_columns; ++m) matrix[k][m] += matrix[i][m];
                    divides = false;
                }
            }
            if (divides) break;
        }
        divisors.push_back(std::llabs(matrix[k][k]));
    }
    return divisors;
}

bool is_primitive(const IntegerMatrix& rows) {
    const auto divisors = elementary_divisors(rows);
    return divisors.size() == rows.size() &&
           std::all_of(divisors.begin(), divisors.end(), [](long long d) { return d == 1; });
}

IntegerMatrix left_kernel(const IntegerMatrix& matrix) {
    // Row operations on [A | I] until the rows below the echelon form are 0 on the left: what they
    // hold on the right is the kernel.
    const std::size_t n = matrix.size();
    const std::size_t n_columns = n == 0 ? 0 : matrix.front().size();
    IntegerMatrix work = matrix;
    IntegerMatrix operations(n, std::vector<long long>(n, 0));
    for (std::size_t i = 0; i < n; ++i) operations[i][i] = 1;
    std::size_t top = 0;
    for (std::size_t column = 0; column < n_columns && top < n; ++column) {
        for (;;) {
            std::size_t pivot = n;
            int n_left = 0;
            for (std::size_t i = top; i < n; ++i) {
                if (work[i][column] == 0) continue;
                ++n_left;
                if (pivot == n || std::llabs(work[i][column]) < std::llabs(work[pivot][column])) {
                    pivot = i;
                }
            }
            if (n_left == 0) break;
            std::swap(work[pivot], work[top]);
            std::swap(operations[pivot], operations[top]);
            if (n_left == 1) {
                ++top;
                break;
            }
            for (std::size_t i = top + 1; i < n; ++i) {
                const long long factor = work[i][column] / work[top][column];
                if (factor == 0) continue;
                for (std::size_t j = 0; j < n_columns; ++j) work[i][j] -= factor * work[top][j];
                for (std::size_t j = 0; j < n; ++j) {
                    operations[i][j] -= factor * operations[top][j];
                }
            }
        }
    }
    return {operations.begin() + static_cast<std::ptrdiff_t>(top), operations.end()};
}

}  // namespace couture::meshing
