#pragma once

#include <string>

#include "io/export_content.h"

namespace couture::io {

/// A reduced model for `rom/embed/couture_rom.h`, the evaluator that other programs include: bytes
/// that depend on nothing else.
///
/// Layout, version 1. Numbers are little-endian: i is an integer of 64 bits, f a double of 64
/// bits. A text is i (its bytes), then the bytes. A list of length n is n numbers in a row;
/// matrices are lists row by row.
///
///   "COUTROM\n"                8 bytes
///   version                    i
///   size                       i, of the whole file
///   checksum                   i, 64-bit FNV-1a of all bytes after it
///   title, length unit, stress unit, why there are no stresses (empty: there are), program
///                              texts
///   n_parameters               i; for each
///     name, unit               texts
///     is_periodic              i: both ends of its range are one state
///     lower, upper, reference  f
///     factor power             i: 1 the displacement is proportional to it, -1 to its inverse
///   n_nodes                    i
///   n_models                   i; for each model of coefficients
///     n_inputs, inputs, waves  i, lists of i: parameters in the unit cube of their ranges; 0: the
///                              value t itself, of periodic ones 1: (1 + cos(2 pi t)) / 2,
///                              2: (1 + sin(2 pi t)) / 2
///     n_coefficients           i
///     without inputs           list of f, the coefficients; nothing more
///     is_gaussian, degree      i: correlation (else Matern 5/2); of the trend, 0 to 2, products too
///     n_factors                i; for each n_points, n_inputs, points: of the tensor design
///     for each coefficient
///       lengths                n_inputs f
///       trend                  n_trend f: 1, then of the inputs if it is linear
///       weights                n_points f, the last factor fastest
///       variance               f, of the process
///       one factor:            lower Cholesky factor of K, n^2 f
///       several:               of each factor its eigenvectors (columns), n_g^2 f; then the
///                              eigenvalues of K, n_points f
///       K^-1 F                 n_points x n_trend f
///       Cholesky factor        of F^T K^-1 F, n_trend^2 f
///   has_amplitude              i; 1: a model of one coefficient, the logarithm of a factor on the
///                              displacement
///   geometry, displacement
///     model                    i
///     n_modes, gram            i, n_modes^2 f
///     truncation, leave-one-out ratio, size, calibration   f
///     mean                     3 n_nodes f
///     modes                    n_modes lists of 3 n_nodes f
///   von Mises calibration      f
///   n_validated                i, full solutions that estimates are calibrated by; 0: none
///   n_materials                i; for each
///     follows parameters       i; 0: stiffness, 36 f (Voigt 11, 22, 33, 23, 13, 12)
///                              1: Young's modulus, Poisson's ratio: f, i each, the number and the
///                              parameter that multiplies it (-1: none)
///   n_patches, materials       i, list of i
///   n_grids                    i; for each
///     patch                    i
///     3 directions             n_points, n_functions, n_active: i; first active function of
///                              each point: list of i; values, derivatives of the active ones:
///                              n_points x n_active f
///     nodes                    list of i, of all combinations of functions, direction 0 fastest
///     n_weights, weights       i (0: not rational), list of f, in the same order
///
/// @throws InputError  as the parts of the model
[[nodiscard]] std::string to_embedded(const rom::ReducedModel& model, const ExportContent& content);

}  // namespace couture::io
