#include "iga/distributed/distributed_static.h"

#include <algorithm>
#include <memory>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/form_operator.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/distributed/distributed_constraints.h"
#include "iga/distributed/distributed_solver.h"
#include "iga/solve/matrix_free_system.h"
#include "iga/solve/static_system.h"

namespace couture::iga {

namespace {

template <int d>
Vector3 middle_of(const MultiPatch<d>& geometry) {
    Vector3 middle = Vector3::Zero();
    const MatrixX box = geometry.bounding_box();
    middle.head(box.rows()) = 0.5 * (box.col(0) + box.col(1));
    return middle;
}

/// @param share  bytes of one triangle of this rank's matrix
/// @throws SolverError  if as much as that for all ranks of this machine would not fit
void require_memory(std::size_t share, int n_ranks_here, int n_unknowns) {
    // The share, rows of both triangles, and those of multigrid: measured, see scaling.md.
    constexpr double copies = 9.0;
    constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
    const double needed = copies * static_cast<double>(share) * n_ranks_here;
    const auto free = static_cast<double>(available_memory());
    if (needed > free) {
        throw SolverError(
            "the matrix of {} unknowns and its multigrid would take about {:.1f} GiB on this "
            "machine's {} ranks, {:.1f} GiB are free; take linear = \"matrix_free\", more "
            "machines or fewer elements",
            n_unknowns, needed / gibibyte, n_ranks_here, free / gibibyte);
    }
}

/// A rank's share of the equations on one kind of functions.
template <int d>
struct Share {
    const DistributedSpace<d>& space;
    Constraints<d> constraints;
    SparseMatrix foundations;
    MatrixX motions;
    std::optional<BlockMatrix> matrix;
    std::unique_ptr<FormOperator<d>> form;

    [[nodiscard]] VectorX operator*(const VectorX& u) const {
        if (matrix) {
            return *matrix * u;
        }
        MatrixX global = u;
        constraints.to_global(global);
        MatrixX result = *form * VectorX(global);
        if (foundations.nonZeros() > 0) {
            result += foundations * global;
        }
        constraints.to_frames(result);
        return result;
    }
    [[nodiscard]] MatrixX times(const MatrixX& u) const {
        MatrixX result(u.rows(), u.cols());
        for (Eigen::Index c = 0; c < u.cols(); ++c) {
            result.col(c) = *this * u.col(c);
        }
        return result;
    }
    [[nodiscard]] DistributedSystem system() const {
        return {space.numbers, constraints.n_components, matrix ? &*matrix : nullptr,
                constraints.is_fixed, motions};
    }
};

template <int d>
class Equations {
  public:
    Equations(const Communicator& ranks, RefinedGeometry<d>& geometry,
              const DistributedSpace<d>& space, const Problem& problem, const Problem& on_pieces,
              const LinearStaticOptions& options)
        : ranks_(ranks),
          geometry_(geometry),
          problem_(problem),
          on_pieces_(on_pieces),
          options_(options),
          solver_(ranks, options.solver),
          is_matrix_free_(options.solver.name == "matrix_free") {
        ranks.together([&] {
            fine_.reset(new Share<d>{space, {}, {}, {}, {}, {}});
            set_up(*fine_, Functions::refined, !is_matrix_free_);
        });
    }

    [[nodiscard]] const Share<d>& share() const { return *fine_; }

    void factorize() {
        if (!is_matrix_free_) {
            solver_.factorize(fine_->system());
            return;
        }
        coarse_space_.emplace(
            distribute<d>(geometry_, ranks_, fine_->space.parts, Functions::linear));
        ranks_.together([&] {
            coarse_.reset(new Share<d>{*coarse_space_, {}, {}, {}, {}, {}});
            set_up(*coarse_, Functions::linear, true);
            prolongation_ =
                prolongation_from_linear(geometry_, fine_->space.pieces, coarse_space_->pieces);
            make_levels();
        });
        solver_.prepare(fine_->system(), *levels_);
    }

    [[nodiscard]] SolveReport solve(const MatrixX& b, MatrixX& u) { return solver_.solve(b, u); }

  private:
    void set_up(Share<d>& share, Functions functions, bool with_matrix) {
        const Space<d>& space = *share.space.pieces.space;
        share.constraints = constraints_on(geometry_, share.space.pieces, problem_,
                                           problem_.load_cases(), functions);
        share.foundations = assemble_foundations(space, on_pieces_, options_.n_gauss_points);
        std::vector<std::string> names;
        share.motions = rigid_body_modes(space, problem_, names, middle_of(geometry_.geometry()));
        share.constraints.to_frames(share.motions);
        BilinearForm<d> form = stiffness_form<d>(on_pieces_, space.n_patches());
        if (with_matrix) {
            share.matrix = assemble(space, form, options_.n_gauss_points);
            add_symmetric(*share.matrix, share.foundations);
            rotate_to_frames(*share.matrix, share.constraints);
        } else {
            share.form =
                std::make_unique<FormOperator<d>>(space, std::move(form), options_.n_gauss_points);
        }
    }

    /// Component by component, along the axes.
    [[nodiscard]] VectorX prolonged(const VectorX& u) const {
        MatrixX global = u;
        coarse_->constraints.to_global(global);
        const int nc = fine_->constraints.n_components;
        MatrixX fine = flatten(prolongation_ * unflatten(VectorX(global), nc));
        fine_->constraints.to_frames(fine);
        return fine;
    }
    [[nodiscard]] VectorX restricted(const VectorX& u) const {
        MatrixX global = u;
        fine_->constraints.to_global(global);
        const int nc = fine_->constraints.n_components;
        MatrixX coarse = flatten(prolongation_.transpose() * unflatten(VectorX(global), nc));
        coarse_->constraints.to_frames(coarse);
        return coarse;
    }

    void make_levels() {
        const int nc = fine_->constraints.n_components;
        const MatrixX blocks = fine_->form->diagonal_blocks(fine_->constraints.frames.empty());
        VectorX diagonal(blocks.rows());
        for (int i = 0; i < blocks.rows() / nc; ++i) {
            MatrixX block = blocks.middleRows(static_cast<Eigen::Index>(i) * nc, nc);
            for (int a = 0; a < nc && fine_->foundations.nonZeros() > 0; ++a) {
                block(a, a) += fine_->foundations.coeff(nc * i + a, nc * i + a);
            }
            if (const auto frame = fine_->constraints.frames.find(i);
                frame != fine_->constraints.frames.end()) {
                block = (frame->second * block * frame->second.transpose()).eval();
            }
            diagonal.segment(static_cast<Eigen::Index>(i) * nc, nc) = block.diagonal();
        }
        levels_.emplace(MatrixFreeLevels{[this](const VectorX& u) { return *fine_ * u; },
                                         std::move(diagonal), coarse_->system(),
                                         [this](const VectorX& u) { return prolonged(u); },
                                         [this](const VectorX& u) { return restricted(u); }});
    }

    const Communicator& ranks_;
    RefinedGeometry<d>& geometry_;
    const Problem& problem_;
    const Problem& on_pieces_;
    const LinearStaticOptions& options_;
    std::unique_ptr<Share<d>> fine_;
    std::optional<DistributedSpace<d>> coarse_space_;
    std::unique_ptr<Share<d>> coarse_;
    SparseMatrix prolongation_;
    std::optional<MatrixFreeLevels> levels_;
    DistributedSolver solver_;
    bool is_matrix_free_;
};

/// One phase on all ranks, from when the first starts to when the last ends.
template <typename Body>
void timed(std::vector<Phase>& phases, const Communicator& ranks, const std::string& name,
           const Body& body) {
    log::detail(name);
    const Timer timer;
    body();
    const double seconds = ranks.max(timer.seconds());
    phases.push_back({name, seconds, peak_memory()});
    log::info(fmt::format("{:<14} {:8.2f} s", name, seconds));
}

}  // namespace

template <int d>
LinearStaticResult<d> solve_linear_static(const Communicator& ranks, RefinedGeometry<d>& geometry,
                                          const DistributedSpace<d>& space, const Problem& problem,
                                          const LinearStaticOptions& options) {
    const std::string& name = options.solver.name;
    if (name != "auto" && name != "petsc" && name != "matrix_free") {
        throw InputError(
            "linear = \"{}\" of [solver] works in one process; runs of several ranks take "
            "\"petsc\" (or \"auto\", the same) and \"matrix_free\"",
            name);
    }
    LinearStaticResult<d> result;
    const int nc = n_components<d>(problem);
    const std::vector<std::string> cases = problem.load_cases();
    const auto n_cases = static_cast<Eigen::Index>(cases.size());
    const PieceSpace<d>& pieces = space.pieces;
    const SharedNumbers& numbers = space.numbers;
    const Problem on_pieces = iga::on_pieces(problem, pieces.boxes);
    std::int64_t n_elements = 0;
    for (const ElementBox<d>& box : pieces.boxes) {
        n_elements += box.n_elements();
    }
    result.n_elements = static_cast<int>(ranks.sum(n_elements));
    result.n_unknowns = numbers.n_global() * nc;

    const int n_here = ranks.size_here();
    ranks.together([&] {
        if (name != "matrix_free") {
            require_memory(matrix_memory(*pieces.space, nc), n_here, result.n_unknowns);
        }
    });

    std::optional<Equations<d>> equations;
    MatrixX f(static_cast<Eigen::Index>(numbers.n_local()) * nc, n_cases);
    MatrixX applied(3, n_cases);
    timed(result.phases, ranks, "assembly", [&] {
        ranks.together([&] {
            require_held<d>(geometry.geometry(), problem);
            std::vector<char> is_owner(numbers.n_local(), 0);
            for (const int i : numbers.owned()) {
                is_owner[i] = 1;
            }
            for (Eigen::Index c = 0; c < n_cases; ++c) {
                const MatrixX loads = loads_on(geometry, pieces, is_owner, problem, on_pieces,
                                               cases[c], options.n_gauss_points);
                applied.col(c) = sum_of_components(loads);
                f.col(c) = flatten(loads);
            }
            if (!f.allFinite()) {
                throw InputError(
                    "a load is not finite; check its value or expression over the whole set");
            }
        });
        equations.emplace(ranks, geometry, space, problem, on_pieces, options);
    });
    applied = ranks.sum(applied);
    const Constraints<d>& constraints = equations->share().constraints;
    constraints.to_frames(f);
    MatrixX b = f - equations->share().times(constraints.values);
    timed(result.phases, ranks, "factorization", [&] { equations->factorize(); });
    MatrixX u;
    timed(result.phases, ranks, "solution", [&] { result.solver = equations->solve(b, u); });
    u += constraints.values;
    ranks.together([&] {
        if (!u.allFinite()) {
            throw SolverError(
                "the solution is not finite; check materials and loads for extreme values");
        }
    });

    const MatrixX out_of_balance = equations->share().times(u) - f;
    const SparseMatrix& foundations = equations->share().foundations;
    const auto whole_energy = [&](const CaseResult<d>& one) {
        return ranks.sum(
            strain_energy(on_pieces, one.displacement, one.name, options.n_gauss_points));
    };
    for (Eigen::Index c = 0; c < n_cases; ++c) {
        CaseResult<d> one;
        one.name = cases[c];
        MatrixX u_global = u.col(c);
        constraints.to_global(u_global);
        one.displacement = {pieces.space, unflatten(u_global, nc)};
        const VectorX from_ground =
            foundations.nonZeros() > 0 ? VectorX(foundations * u_global) : VectorX::Zero(u.rows());
        one.foundation_force = -ranks.sum(MatrixX(sum_of_components(unflatten(from_ground, nc))));
        one.energy = whole_energy(one);
        one.applied_force = applied.col(c);
        one.reactions = support_reactions(on_pieces, constraints, VectorX(out_of_balance.col(c)));
        for (auto& [on, force] : one.reactions) {
            force = ranks.sum(MatrixX(force));
        }
        const double load_norm = std::sqrt(ranks.sum(numbers.add(f.col(c), nc).squaredNorm()));
        one.balance = force_balance(problem, one.applied_force, one.reactions, one.foundation_force,
                                    load_norm);
        result.cases.push_back(std::move(one));
    }
    add_combinations<d>(result.cases, problem, whole_energy);
    return result;
}

template <int d>
MatrixX project(const Communicator& ranks, const DistributedSpace<d>& space,
                const MatrixX& integrals) {
    BlockMatrix mass;
    ranks.together([&] { mass = assemble(*space.pieces.space, scalar_form<d>(0.0, 1.0)); });
    SolverOptions options;
    options.petsc_options = "-pc_type bjacobi -sub_pc_type icc";
    DistributedSolver solver(ranks, options);
    solver.factorize({space.numbers, 1, &mass, {}, {}});
    MatrixX result;
    (void)solver.solve(integrals, result);
    return result;
}

#define COUTURE_INSTANTIATE(d)                                                                     \
    template LinearStaticResult<d> solve_linear_static(const Communicator&, RefinedGeometry<d>&,   \
                                                       const DistributedSpace<d>&, const Problem&, \
                                                       const LinearStaticOptions&);                \
    template MatrixX project(const Communicator&, const DistributedSpace<d>&, const MatrixX&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
