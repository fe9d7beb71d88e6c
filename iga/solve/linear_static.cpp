#include "iga/solve/linear_static.h"

#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/solve/matrix_free_system.h"
#include "iga/solve/static_system.h"

namespace couture::iga {

namespace {

/// Runs one phase, times it, and says so when it starts.
template <typename Body>
auto timed(std::vector<Phase>& phases, const std::string& name, const Body& body) {
    log::detail(name);
    const Timer timer;
    auto result = body();
    phases.push_back({name, timer.seconds(), peak_memory()});
    log::info(fmt::format("{:<14} {:8.2f} s", name, phases.back().seconds));
    return result;
}

/// The equations of all load cases, with a matrix or without.
template <int d>
class Equations {
  public:
    Equations(const Space<d>& space, const Problem& problem, const Constraints<d>& constraints,
              const SparseMatrix& foundations, const LinearStaticOptions& options)
        : space_(space),
          problem_(problem),
          constraints_(constraints),
          foundations_(foundations),
          options_(options) {
        if (is_matrix_free()) {
            system_.emplace(space, stiffness_form<d>(problem, space.n_patches()), foundations,
                            constraints, options.n_gauss_points);
        } else {
            form_matrix();
        }
    }

    [[nodiscard]] MatrixX operator*(const MatrixX& u) const {
        return matrix_ ? MatrixX(*matrix_ * u) : *system_ * u;
    }

    void factorize() {
        std::vector<std::string> names;
        MatrixX near_null_space = rigid_body_modes(space_, problem_, names);
        constraints_.to_frames(near_null_space);
        if (system_) {
            try {
                system_->prepare(near_null_space);
                return;
            } catch (const SolverError& error) {
                go_on_with_matrix(error);
            }
        }
        solver_ = options_.reused_solver;
        if (solver_ == nullptr) {
            own_solver_ = make_linear_solver(options_.solver);
            solver_ = own_solver_.get();
        }
        solver_->factorize({*matrix_, constraints_.is_fixed, std::move(near_null_space), &space_});
    }

    [[nodiscard]] SolveReport solve(const MatrixX& b, MatrixX& u) {
        if (!system_) {
            return solver_->solve(b, u);
        }
        SolverOptions solver = options_.solver;
        if (is_chosen_) {
            solver.max_iterations = std::min(solver.max_iterations, max_chosen_iterations);
        }
        try {
            SolveReport report = system_->solve(b, solver, u);
            report.note = note_;
            return report;
        } catch (const SolverError& error) {
            go_on_with_matrix(error);
        }
        factorize();
        SolveReport report = solver_->solve(b, u);
        report.note = report.note.empty() ? note_ : note_ + "; " + report.note;
        return report;
    }

  private:
    void form_matrix() {
        matrix_ = assemble(space_, stiffness_form<d>(problem_, space_.n_patches()),
                           options_.n_gauss_points);
        add_symmetric(*matrix_, foundations_);
        rotate_to_frames(*matrix_, constraints_);
    }

    /// Where matrix_free was chosen by size; else what it failed of is thrown on.
    void go_on_with_matrix(const SolverError& error) {
        if (!is_chosen_) {
            throw;
        }
        log::warn(fmt::format("{}; going on with the matrix", error.what()));
        note_ += fmt::format("; fell back to the matrix: {}", error.what());
        system_.reset();
        form_matrix();
    }

    /// Says why in `note_`, if it is not the user's wish.
    [[nodiscard]] bool is_matrix_free() {
        if (options_.solver.name == "matrix_free") {
            return true;
        }
        if (options_.reused_solver != nullptr || options_.solver.name != "auto") {
            return false;
        }
        // Where a factorization takes longer than hundreds of products without a matrix, for one
        // load case (see couture bench --only products, solution).
        constexpr int least_unknowns = 60'000;
        const int nc = n_components<d>(problem_);
        const int n_unknowns = space_.n_dofs() * nc;
        const auto n_cases = static_cast<int>(problem_.load_cases().size());
        if (d == 3 && n_unknowns / n_cases >= least_unknowns) {
            note_ = fmt::format("matrix_free: {} unknowns for {} load case{}", n_unknowns, n_cases,
                                n_cases > 1 ? "s" : "");
            is_chosen_ = true;
            return true;
        }
        // The pattern's rows are kept once more while it is made.
        constexpr double share = 0.75;
        const std::size_t needed = matrix_memory(space_, nc);
        const std::size_t limit = options_.solver.memory_limit > 0
                                      ? std::min(options_.solver.memory_limit, available_memory())
                                      : available_memory();
        if (static_cast<double>(needed) < share * limit) {
            return false;
        }
        constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
        note_ = fmt::format(
            "matrix_free: the matrix would take {:.1f} GiB of the {:.1f} GiB that it may",
            needed / gibibyte, limit / gibibyte);
        return true;
    }

    const Space<d>& space_;
    const Problem& problem_;
    const Constraints<d>& constraints_;
    const SparseMatrix& foundations_;
    const LinearStaticOptions& options_;
    std::optional<BlockMatrix> matrix_;
    std::unique_ptr<LinearSolver> own_solver_;
    LinearSolver* solver_ = nullptr;
    std::optional<MatrixFreeSystem<d>> system_;
    std::string note_;
    /// By size, not by the user and not for want of memory: there is a way back.
    bool is_chosen_ = false;
    static constexpr int max_chosen_iterations = 500;
};

void require_finite(const MatrixX& u) {
    if (!u.allFinite()) {
        throw SolverError(
            "the solution is not finite; check materials and loads for extreme values");
    }
}

}  // namespace

template <int d>
LinearStaticResult<d> solve_linear_static(const SpacePtr<d>& space, const Problem& problem,
                                          const LinearStaticOptions& options) {
    LinearStaticResult<d> result;
    const int nc = n_components<d>(problem);
    const std::vector<std::string> cases = problem.load_cases();
    const auto n_cases = static_cast<Eigen::Index>(cases.size());
    result.n_unknowns = space->n_dofs() * nc;
    for (int p = 0; p < space->n_patches(); ++p) {
        int n = 1;
        for (const int n_k : space->tensor(p).n_elements()) {
            n *= n_k;
        }
        result.n_elements += n;
    }

    const SparseMatrix foundations = assemble_foundations(*space, problem, options.n_gauss_points);
    const Constraints<d> constraints = make_constraints(*space, problem, cases);
    require_held(*space, problem, constraints, foundations);

    std::vector<MatrixX> loads;
    const auto equations = timed(result.phases, "assembly", [&] {
        for (const std::string& name : cases) {
            loads.push_back(assemble_loads(*space, problem, name, options.n_gauss_points));
        }
        return std::make_unique<Equations<d>>(*space, problem, constraints, foundations, options);
    });

    MatrixX f(result.n_unknowns, n_cases);
    for (Eigen::Index c = 0; c < n_cases; ++c) {
        f.col(c) = flatten(loads[c]);
    }
    if (!f.allFinite()) {
        throw InputError("a load is not finite; check its value or expression over the whole set");
    }
    constraints.to_frames(f);
    const MatrixX b = f - *equations * constraints.values;
    timed(result.phases, "factorization", [&] {
        equations->factorize();
        return 0;
    });
    MatrixX u;
    result.solver = timed(result.phases, "solution", [&] { return equations->solve(b, u); });
    u += constraints.values;
    require_finite(u);

    const MatrixX Ku = *equations * u;
    for (Eigen::Index c = 0; c < n_cases; ++c) {
        CaseResult<d> one;
        one.name = cases[c];
        MatrixX u_global = u.col(c);
        constraints.to_global(u_global);
        one.displacement = {space, unflatten(u_global, nc)};

        const VectorX from_ground =
            foundations.nonZeros() > 0 ? VectorX(foundations * u_global) : VectorX::Zero(u.rows());
        one.foundation_force = -sum_of_components(unflatten(from_ground, nc));
        one.energy = strain_energy(problem, one.displacement, cases[c], options.n_gauss_points);
        one.applied_force = sum_of_components(loads[c]);

        one.reactions = support_reactions(problem, constraints, VectorX(Ku.col(c) - f.col(c)));
        one.balance = force_balance(problem, one.applied_force, one.reactions, one.foundation_force,
                                    f.col(c).norm());
        result.cases.push_back(std::move(one));
    }

    add_combinations<d>(result.cases, problem, [&](const CaseResult<d>& sum) {
        return strain_energy(problem, sum.displacement, sum.name, options.n_gauss_points);
    });
    return result;
}

template <int d>
void add_combinations(std::vector<CaseResult<d>>& cases, const Problem& problem,
                      const std::function<double(const CaseResult<d>&)>& energy) {
    const std::vector<CaseResult<d>> single = cases;
    for (const auto& [name, factors] : problem.combinations) {
        CaseResult<d> sum;
        sum.name = name;
        sum.displacement = {single.front().displacement.space,
                            MatrixX::Zero(single.front().displacement.coefficients.rows(),
                                          single.front().displacement.coefficients.cols())};
        for (const auto& [case_name, factor] : factors) {
            const auto one = std::find_if(
                single.begin(), single.end(),
                [&wanted = case_name](const CaseResult<d>& r) { return r.name == wanted; });
            if (one == single.end()) {
                throw InputError("combination '{}': there is no load case '{}'; there are: {}",
                                 name, case_name, fmt::join(problem.load_cases(), ", "));
            }
            sum.displacement.coefficients += factor * one->displacement.coefficients;
            sum.applied_force += factor * one->applied_force;
            sum.foundation_force += factor * one->foundation_force;
            for (const auto& [on, force] : one->reactions) {
                sum.reactions.try_emplace(on, Vector3::Zero()).first->second += factor * force;
            }
            sum.balance = std::max(sum.balance, one->balance);
        }
        sum.energy = energy(sum);
        cases.push_back(std::move(sum));
    }
}

double force_balance(const Problem& problem, const Vector3& applied,
                     const std::map<std::string, Vector3>& reactions, const Vector3& foundations,
                     double load_norm) {
    Vector3 imbalance = applied + foundations;
    double scale = std::max({applied.norm(), foundations.norm(), load_norm, 1e-300});
    for (const auto& [on, force] : reactions) {
        imbalance += force;
        scale = std::max(scale, force.norm());
    }
    if (problem.kinematics == Kinematics::axisymmetric) {
        imbalance[0] = 0.0;  // hoop stress carries radial loads
    }
    return imbalance.norm() / scale;
}

template void add_combinations(std::vector<CaseResult<2>>&, const Problem&,
                               const std::function<double(const CaseResult<2>&)>&);
template void add_combinations(std::vector<CaseResult<3>>&, const Problem&,
                               const std::function<double(const CaseResult<3>&)>&);
template LinearStaticResult<2> solve_linear_static(const SpacePtr<2>&, const Problem&,
                                                   const LinearStaticOptions&);
template LinearStaticResult<3> solve_linear_static(const SpacePtr<3>&, const Problem&,
                                                   const LinearStaticOptions&);

}  // namespace couture::iga
