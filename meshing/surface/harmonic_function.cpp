#include "meshing/surface/harmonic_function.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

constexpr double smallest_tangent = 1e-10;
constexpr double largest_tangent = 1e10;
constexpr double shortest_length = 1e-12;
constexpr double largest_residual = 1e-10;

// Tangent of half the angle between a and b, without cancellation at either end of [0, pi].
double half_angle_tangent(const Vector3& a, const Vector3& b) {
    const double lengths = a.norm() * b.norm();
    const double cosine = a.dot(b);
    const double sine = a.cross(b).norm();
    double tangent = largest_tangent;
    if (cosine >= 0.0) {
        tangent = lengths > 0.0 ? sine / (lengths + cosine) : 0.0;
    } else if (sine > 0.0) {
        tangent = (lengths - cosine) / sine;
    }
    return std::clamp(tangent, smallest_tangent, largest_tangent);
}

double mean_edge_length(const HarmonicProblem& problem) {
    double sum = 0.0;
    for (const auto& t : problem.triangles) {
        for (int k = 0; k < 3; ++k) {
            sum += (problem.points[t[k]] - problem.points[t[(k + 1) % 3]]).norm();
        }
    }
    return problem.triangles.empty() ? 0.0
                                     : sum / (3.0 * static_cast<double>(problem.triangles.size()));
}

// Calls add(i, j, w) for both neighbours j of each corner i of each triangle.
template <typename Add>
void for_each_weight(const HarmonicProblem& problem, const Add& add) {
    const double shortest = shortest_length * mean_edge_length(problem);
    for (const auto& t : problem.triangles) {
        for (int k = 0; k < 3; ++k) {
            const int i = t[k];
            const int next = t[(k + 1) % 3];
            const int last = t[(k + 2) % 3];
            if (problem.weights == HarmonicWeights::uniform) {
                add(i, next, 1.0);
                add(i, last, 1.0);
                continue;
            }
            const Vector3 a = problem.points[next] - problem.points[i];
            const Vector3 b = problem.points[last] - problem.points[i];
            const double tangent = half_angle_tangent(a, b);
            add(i, next, tangent / std::max(a.norm(), shortest));
            add(i, last, tangent / std::max(b.norm(), shortest));
        }
    }
}

void check(const HarmonicProblem& problem) {
    const std::size_t n = problem.points.size();
    if (problem.is_fixed.size() != n || static_cast<std::size_t>(problem.values.rows()) != n ||
        (!problem.original.empty() &&
         (problem.original.size() != n || problem.jump.size() != problem.values.cols()))) {
        throw InputError(
            "solve_harmonic: {} points, {} flags, {} rows of values, {} originals, {} jumps for {} "
            "columns; there must be one of each per vertex and one jump per column",
            n, problem.is_fixed.size(), problem.values.rows(), problem.original.size(),
            problem.jump.size(), problem.values.cols());
    }
}

// Approximate minimum degree the way SparseLU wants it, which is the inverse of what
// Eigen::AMDOrdering returns.
struct MinimumDegree {
    using PermutationType = Eigen::AMDOrdering<int>::PermutationType;

    void operator()(const SparseMatrix& matrix, PermutationType& permutation) const {
        PermutationType inverse;
        Eigen::AMDOrdering<int>()(matrix, inverse);
        permutation = inverse.inverse();
    }
};

}  // namespace

HarmonicSolution solve_harmonic(const HarmonicProblem& problem) {
    check(problem);
    const int n = static_cast<int>(problem.points.size());
    const auto n_columns = problem.values.cols();
    const auto original = [&](int v) { return problem.original.empty() ? v : problem.original[v]; };

    std::vector<char> is_used(n, 0);
    DisjointSets components(n);
    for (const auto& t : problem.triangles) {
        for (int k = 0; k < 3; ++k) {
            is_used[original(t[k])] = 1;
            components.join(original(t[k]), original(t[(k + 1) % 3]));
        }
    }
    std::vector<char> has_fixed(n, 0);
    for (int v = 0; v < n; ++v) {
        if (problem.is_fixed[v] != 0) has_fixed[components.find(original(v))] = 1;
    }
    std::vector<int> unknown(n, -1);
    int n_unknowns = 0;
    for (int v = 0; v < n; ++v) {
        if (is_used[v] == 0 || problem.is_fixed[v] != 0) continue;
        if (has_fixed[components.find(v)] == 0) {
            throw InputError(
                "solve_harmonic: no vertex of the component of vertex {} is fixed; its values "
                "are not determined: fix at least one",
                v);
        }
        unknown[v] = n_unknowns++;
    }

    HarmonicSolution solution;
    solution.values = MatrixX::Zero(n, n_columns);
    double range = 0.0;
    // Solved for as differences from this, which keeps small ranges of large values apart.
    VectorX middle = VectorX::Zero(n_columns);
    for (Eigen::Index c = 0; c < n_columns; ++c) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (int v = 0; v < n; ++v) {
            if (problem.is_fixed[v] == 0) continue;
            solution.values(v, c) = problem.values(v, c);
            low = std::min(low, problem.values(v, c));
            high = std::max(high, problem.values(v, c));
        }
        if (low <= high) middle(c) = 0.5 * (low + high);
        if (high > low) range = std::max(range, high - low);
        if (!problem.original.empty()) range = std::max(range, std::abs(problem.jump(c)));
    }

    // Rows divided by their sums of weights: lambda_ij of Eq. (2.32), 1 on the diagonal.
    VectorX sums = VectorX::Zero(n_unknowns);
    for_each_weight(problem, [&](int i, int, double w) {
        if (unknown[original(i)] >= 0) sums(unknown[original(i)]) += w;
    });
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(6 * problem.triangles.size() + n_unknowns);
    MatrixX right = MatrixX::Zero(n_unknowns, n_columns);
    for (int i = 0; i < n_unknowns; ++i) entries.emplace_back(i, i, 1.0);
    for_each_weight(problem, [&](int i, int j, double w) {
        const int row = unknown[original(i)];
        if (row < 0) return;
        const double lambda = w / sums(row);
        const int column = unknown[original(j)];
        if (column >= 0) {
            entries.emplace_back(row, column, -lambda);
        } else {
            right.row(row) += lambda * (solution.values.row(original(j)) - middle.transpose());
        }
        const int shift = (original(j) != j ? 1 : 0) - (original(i) != i ? 1 : 0);
        if (shift != 0) right.row(row) += shift * lambda * problem.jump.transpose();
    });
    if (n_unknowns > 0) {
        SparseMatrix matrix(n_unknowns, n_unknowns);
        matrix.setFromTriplets(entries.begin(), entries.end());
        // Pivots on the diagonal: the matrix is diagonally dominant by rows.
        Eigen::SparseLU<SparseMatrix, MinimumDegree> factorization;
        factorization.isSymmetric(true);
        factorization.setPivotThreshold(0.0);
        factorization.compute(matrix);
        if (factorization.info() != Eigen::Success) {
            throw SolverError("solve_harmonic: the factorization of {} unknowns failed: {}",
                              n_unknowns, factorization.lastErrorMessage());
        }
        MatrixX x = factorization.solve(right);
        const MatrixX rest = right - matrix * x;
        x += factorization.solve(rest);
        const double residual = (right - matrix * x).cwiseAbs().maxCoeff();
        solution.residual = range > 0.0 ? residual / range : residual;
        if (!(solution.residual <= largest_residual)) {
            throw SolverError(
                "solve_harmonic: residual {:.3g} of {} unknowns exceeds {:.3g}; look for triangles "
                "without area",
                solution.residual, n_unknowns, largest_residual);
        }
        for (int v = 0; v < n; ++v) {
            if (unknown[v] >= 0) solution.values.row(v) = x.row(unknown[v]) + middle.transpose();
        }
    }
    for (int v = 0; v < n; ++v) {
        if (original(v) == v) continue;
        solution.values.row(v) = solution.values.row(original(v)) + problem.jump.transpose();
    }
    return solution;
}

VectorX harmonic_function(const CutSurface& surface, std::span<const int> vertices,
                          std::span<const double> values, HarmonicWeights weights) {
    const int n = surface.n_vertices();
    if (vertices.size() != values.size()) {
        throw InputError("harmonic_function: {} vertices and {} values; each vertex needs one",
                         vertices.size(), values.size());
    }
    HarmonicProblem problem;
    problem.weights = weights;
    problem.is_fixed.assign(n, 0);
    problem.values = MatrixX::Zero(n, 1);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const int v = vertices[i];
        if (v < 0 || v >= n || problem.is_fixed[v] != 0) {
            throw InputError(
                "harmonic_function: vertex {} (entry {}) {}; name different vertices of the {} "
                "there are",
                v, i, v < 0 || v >= n ? "does not exist" : "stands twice", n);
        }
        problem.is_fixed[v] = 1;
        problem.values(v, 0) = values[i];
    }
    std::vector<std::array<int, 3>> triangles(surface.n_faces());
    for (int f = 0; f < surface.n_faces(); ++f) triangles[f] = surface.triangle(f);
    std::vector<Vector3> points(n);
    for (int v = 0; v < n; ++v) points[v] = surface.point(v);
    problem.triangles = triangles;
    problem.points = points;
    return solve_harmonic(problem).values.col(0);
}

}  // namespace couture::meshing
