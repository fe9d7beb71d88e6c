#include "iga/linalg/sparse_solver.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "iga/core/error.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/linalg/petsc_solver.h"
#include "iga/linalg/umfpack_solver.h"

namespace couture::iga {

namespace {

/// CHOLMOD while its factor fits into memory, else PETSc.
class AutoSolver final : public LinearSolver {
  public:
    explicit AutoSolver(const SolverOptions& options) : options_(options) {}

    void factorize(const LinearSystem& system) override {
        chosen_ = nullptr;
        if (!system.matrix.is_symmetric) {
            use_petsc(system, "petsc: the matrix is not stored as symmetric");
            return;
        }
        try {
            if (!direct_) {
                direct_ = make_cholmod_solver(options_);
            }
            direct_->factorize(system);
            chosen_ = direct_.get();
            note_.clear();
        } catch (const FactorTooLarge& error) {
            direct_.reset();
            use_petsc(system, fmt::format("fell back to petsc: {}", error.what()));
        }
    }

    SolveReport solve(const MatrixX& b, MatrixX& x) override {
        if (chosen_ == nullptr) {
            throw SolverError("auto: solve was called before factorize succeeded");
        }
        SolveReport report = chosen_->solve(b, x);
        report.note =
            note_.empty() || report.note.empty() ? note_ + report.note : note_ + "; " + report.note;
        return report;
    }

  private:
    void use_petsc(const LinearSystem& system, const std::string& note) {
        if (!iterative_) {
            iterative_ = make_petsc_solver(options_);
        }
        iterative_->factorize(system);
        chosen_ = iterative_.get();
        note_ = note;
    }

    SolverOptions options_;
    std::unique_ptr<LinearSolver> direct_;
    std::unique_ptr<LinearSolver> iterative_;
    LinearSolver* chosen_ = nullptr;
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
    static const std::vector<std::string> names{"auto", "cholmod", "petsc", "umfpack"};
    return names;
}

}  // namespace couture::iga
