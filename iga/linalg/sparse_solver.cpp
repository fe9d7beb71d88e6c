#include "iga/linalg/sparse_solver.h"

#include <fmt/ranges.h>

#include <optional>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/linalg/fast_diagonalization.h"
#include "iga/linalg/petsc_solver.h"
#include "iga/linalg/umfpack_solver.h"

namespace couture::iga {

namespace {

/// CHOLMOD while its factor fits into memory, else fast diagonalization if the system has a space,
/// else, or if that stalls, PETSc.
class AutoSolver final : public LinearSolver {
  public:
    explicit AutoSolver(const SolverOptions& options) : options_(options) {}

    void factorize(const LinearSystem& system) override {
        chosen_ = nullptr;
        system_.reset();
        if (!system.matrix.is_symmetric) {
            use(petsc_, "petsc", system, "petsc: the matrix is not stored as symmetric");
            return;
        }
        try {
            use(direct_, "cholmod", system, "");
        } catch (const FactorTooLarge& error) {
            direct_.reset();
            const bool has_space = !std::holds_alternative<std::monostate>(system.space);
            const std::string name = has_space ? "fast_diagonalization" : "petsc";
            use(has_space ? fast_ : petsc_, name, system,
                fmt::format("fell back to {}: {}", name, error.what()));
            if (has_space) {
                system_.emplace(system);
            }
        }
    }

    SolveReport solve(const MatrixX& b, MatrixX& x) override {
        if (chosen_ == nullptr) {
            throw SolverError("auto: solve was called before factorize succeeded");
        }
        SolveReport report;
        try {
            report = chosen_->solve(b, x);
        } catch (const NotPositiveDefinite&) {
            throw;
        } catch (const SolverError& error) {
            if (chosen_ != fast_.get()) {
                throw;
            }
            log::warn(fmt::format("{}; going on with petsc", error.what()));
            use(petsc_, "petsc", *system_,
                fmt::format("{}; fell back to petsc: {}", note_, error.what()));
            report = chosen_->solve(b, x);
        }
        report.note =
            note_.empty() || report.note.empty() ? note_ + report.note : note_ + "; " + report.note;
        return report;
    }

  private:
    void use(std::unique_ptr<LinearSolver>& solver, const std::string& name,
             const LinearSystem& system, const std::string& note) {
        if (!solver) {
            SolverOptions options = options_;
            options.name = name;
            solver = make_linear_solver(options);
        }
        solver->factorize(system);
        chosen_ = solver.get();
        note_ = note;
    }

    SolverOptions options_;
    std::unique_ptr<LinearSolver> direct_;
    std::unique_ptr<LinearSolver> fast_;
    std::unique_ptr<LinearSolver> petsc_;
    LinearSolver* chosen_ = nullptr;
    /// The system that fast diagonalization works on, for PETSc.
    std::optional<LinearSystem> system_;
    std::string note_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_linear_solver(const SolverOptions& options) {
    if (options.name == "auto") {
        return std::make_unique<AutoSolver>(options);
    }
    if (options.name == "cholmod") {
        return make_cholmod_solver(options);
    }
    if (options.name == "fast_diagonalization" || options.name == "matrix_free") {
        return make_fast_diagonalization_solver(options);
    }
    if (options.name == "petsc") {
        return make_petsc_solver(options);
    }
    if (options.name == "umfpack") {
        return make_umfpack_solver(options);
    }
    throw InputError("linear solver: unknown name '{}'; there are {}", options.name,
                     fmt::join(linear_solver_names(), ", "));
}

const std::vector<std::string>& linear_solver_names() {
    static const std::vector<std::string> names{"auto",        "cholmod", "fast_diagonalization",
                                                "matrix_free", "petsc",   "umfpack"};
    return names;
}

}  // namespace couture::iga
