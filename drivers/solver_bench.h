#pragma once

#include <string>
#include <vector>

#include "iga/linalg/machine_limits.h"

namespace couture::drivers {

/// One product of elasticity's matrix, assembled or not, and a vector.
struct ProductRow {
    std::string problem;
    int degree = 0;
    int n_elements = 0;
    int n_threads = 1;
    int n_unknowns = 0;
    double assembly_seconds = 0.0;
    /// Best of several.
    double matrix_seconds = 0.0;
    double matrix_bytes = 0.0;
    /// Of the operator: geometry at the quadrature points.
    double setup_seconds = 0.0;
    double operator_seconds = 0.0;
    double operator_bytes = 0.0;
};

/// Annulus, degrees 1 to 4, from ten thousand unknowns to a million.
[[nodiscard]] std::vector<ProductRow> measure_products(bool quick, int max_threads);
[[nodiscard]] std::string products_text(const std::vector<ProductRow>& rows,
                                        const std::vector<iga::MachineLimits>& limits);

/// One system solved to 1e-8 by fast diagonalization, and by conjugate gradients with the matrix'
/// diagonal for comparison: unit body force, one side held in all components.
struct IterativeRow {
    /// "poisson" or "elasticity" (Poisson's ratio 0.3).
    std::string problem;
    std::string geometry;
    int n_patches = 1;
    int degree = 0;
    /// Per patch and direction.
    int n_elements = 0;
    int n_unknowns = 0;
    double assembly_seconds = 0.0;
    double setup_seconds = 0.0;
    double solve_seconds = 0.0;
    int iterations = 0;
    double residual = 0.0;
    double jacobi_seconds = 0.0;
    int jacobi_iterations = 0;
};

/// Degrees 1 to 4 on one patch (quarter annulus, twisted box) and on 27 (3 x 3 x 3 boxes, a
/// cylinder of 3 layers with a square core and two rings).
///
/// @param quick  smaller ones, a few seconds
[[nodiscard]] std::vector<IterativeRow> measure_iterative_solvers(bool quick);
[[nodiscard]] std::string iterative_text(const std::vector<IterativeRow>& rows);

/// The cases by themselves. `geometry`: "annulus", "twisted_box", "boxes" or "cylinder".
[[nodiscard]] IterativeRow measure_iterative_solver(const std::string& problem,
                                                    const std::string& geometry, int degree,
                                                    int n_elements);

}  // namespace couture::drivers
