#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/mesh_bench.h"
#include "drivers/ranks_bench.h"
#include "drivers/reduced_model_bench.h"
#include "drivers/solver_bench.h"
#include "iga/linalg/machine_limits.h"

namespace couture::drivers {

/// One assembly: quarter-annulus NURBS patch extruded, n elements per direction, p + 1 Gauss
/// points, the matrix in its final sparse form (pattern included), best of `n_runs`.
struct AssemblyRow {
    std::string problem;
    int degree = 0;
    int n_elements = 0;
    int n_threads = 1;
    int n_unknowns = 0;
    double seconds = 0.0;
    /// Of the contractions.
    double flops = 0.0;
    /// Bytes of the matrix.
    double bytes = 0.0;
};

/// One solution of the assembled elasticity problem, one side held, unit body force.
struct SolveRow {
    std::string solver;
    int degree = 0;
    int n_elements = 0;
    int n_unknowns = 0;
    double setup_seconds = 0.0;
    double solve_seconds = 0.0;
    int iterations = 0;
    double residual = 0.0;
    /// Bytes of the factor or preconditioner, 0 if unknown.
    double memory = 0.0;
};

/// Handle and tunnel loops, and the decomposition into pants (which looks for loops first), of a
/// part on one thread, in seconds of processor time: other programs on the machine don't count.
struct CuttingRow {
    std::string part;
    int genus = 0;
    int n_triangles = 0;
    double loops_cpu_seconds = 0.0;
    double pants_cpu_seconds = 0.0;
};

struct BenchOptions {
    /// Fewer and smaller cases, a few seconds.
    bool quick = false;
    int n_runs = 5;
    int max_threads = 2;
    /// Sections to run (see `bench_sections`); empty: all.
    std::vector<std::string> only;
};

/// Names of the sections that can be run by themselves: the arrays of the JSON.
[[nodiscard]] const std::vector<std::string>& bench_sections();

struct BenchResult {
    std::vector<iga::MachineLimits> limits;
    std::vector<AssemblyRow> assembly;
    std::vector<SolveRow> solves;
    std::vector<ProductRow> products;
    std::vector<IterativeRow> iterative;
    std::vector<RankRow> ranks;
    std::vector<CuttingRow> cuts;
    std::vector<MeshingRow> meshing;
    std::vector<EvaluationRow> evaluations;
};

[[nodiscard]] BenchResult run_benchmarks(const BenchOptions& options);
[[nodiscard]] std::string bench_text(const BenchResult& result);
[[nodiscard]] std::string bench_json(const BenchResult& result);

}  // namespace couture::drivers
