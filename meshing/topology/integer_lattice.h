#pragma once

#include <vector>

namespace couture::meshing {

/// Integer matrix by rows.
using IntegerMatrix = std::vector<std::vector<long long>>;

[[nodiscard]] IntegerMatrix multiply(const IntegerMatrix& a, const IntegerMatrix& b);
/// Row vector times matrix.
[[nodiscard]] std::vector<long long> multiply(const std::vector<long long>& row,
                                              const IntegerMatrix& matrix);

/// Determinant of a square matrix, exactly.
///
/// Source: [Bareiss68].
[[nodiscard]] long long determinant(IntegerMatrix matrix);

/// Elementary divisors (the non-zero diagonal of Smith's normal form), ascending by divisibility;
/// their number is the rank.
[[nodiscard]] std::vector<long long> elementary_divisors(IntegerMatrix matrix);

/// Whether the rows are part of a basis of all integer vectors: as many elementary divisors as
/// rows, all 1.
[[nodiscard]] bool is_primitive(const IntegerMatrix& rows);

/// Basis of the integer vectors x with x A = 0, as rows.
[[nodiscard]] IntegerMatrix left_kernel(const IntegerMatrix& matrix);

}  // namespace couture::meshing
