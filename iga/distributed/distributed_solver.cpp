#include "iga/distributed/distributed_solver.h"

#include "iga/core/error.h"
#include "iga/linalg/petsc_krylov.h"
#include "iga/linalg/petsc_session.h"

namespace couture::iga {

namespace {

/// Frees its matrix.
class PetscMatrix {
  public:
    PetscMatrix() = default;
    ~PetscMatrix() {
        if (petsc_is_alive()) {
            MatDestroy(&A);
        }
    }
    PetscMatrix(const PetscMatrix&) = delete;
    PetscMatrix& operator=(const PetscMatrix&) = delete;
    Mat A = nullptr;
};

VectorX owned_rows(const SharedNumbers& numbers, const VectorX& local, int n) {
    VectorX result(static_cast<Eigen::Index>(numbers.n_owned()) * n);
    for (int i = 0; i < numbers.n_owned(); ++i) {
        result.segment(static_cast<Eigen::Index>(i) * n, n) =
            local.segment(static_cast<Eigen::Index>(numbers.owned()[i]) * n, n);
    }
    return result;
}

VectorX without_fixed(const std::vector<char>& is_fixed, VectorX x) {
    for (std::size_t i = 0; i < is_fixed.size(); ++i) {
        if (is_fixed[i] != 0) {
            x[static_cast<Eigen::Index>(i)] = 0.0;
        }
    }
    return x;
}

/// The matrix by rows of the owned functions from the ranks' shares.
void assemble_rows(const DistributedSystem& system, PetscMatrix& result) {
    const SharedNumbers& numbers = system.numbers;
    const int bs = system.n_components;
    RowMatrix rows = rows_for_petsc(*system.matrix, system.is_fixed);
    if (system.skew != nullptr) {
        rows += RowMatrix(*system.skew);
        rows.makeCompressed();
    }
    ISLocalToGlobalMapping mapping = nullptr;
    check_petsc(ISLocalToGlobalMappingCreate(PETSC_COMM_WORLD, bs, numbers.n_local(),
                                             numbers.numbers().data(), PETSC_COPY_VALUES,
                                             &mapping));
    const int n_owned = numbers.n_owned() * bs;
    const int n_all = numbers.n_global() * bs;
    PetscMatrix shares;
    check_petsc(MatCreateIS(PETSC_COMM_WORLD, bs, n_owned, n_owned, n_all, n_all, mapping, mapping,
                            &shares.A));
    PetscMatrix share;
    const int n = static_cast<int>(rows.rows());
    check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, rows.outerIndexPtr(),
                                          rows.innerIndexPtr(), rows.valuePtr(), &share.A));
    check_petsc(MatSetBlockSize(share.A, bs));
    check_petsc(MatISSetLocalMat(shares.A, share.A));
    check_petsc(MatAssemblyBegin(shares.A, MAT_FINAL_ASSEMBLY));
    check_petsc(MatAssemblyEnd(shares.A, MAT_FINAL_ASSEMBLY));
    check_petsc(MatConvert(shares.A, MATAIJ, MAT_INITIAL_MATRIX, &result.A));
    check_petsc(ISLocalToGlobalMappingDestroy(&mapping));
    check_petsc(MatSetBlockSize(result.A, bs));
    if (system.skew == nullptr) {
        check_petsc(MatSetOption(result.A, MAT_SPD, PETSC_TRUE));
    }
    MatrixX motions(n_owned, system.near_null_space.cols());
    for (Eigen::Index k = 0; k < motions.cols(); ++k) {
        motions.col(k) = owned_rows(numbers, system.near_null_space.col(k), bs);
    }
    set_near_null_space(result.A, motions);
}

/// What the callbacks of the operator and the prolongation work with.
struct Context {
    const SharedNumbers* fine;
    const SharedNumbers* coarse;
    int n_components;
    const std::vector<char>* is_fixed;
    const std::vector<char>* coarse_is_fixed;
    const MatrixFreeLevels* levels;
    /// 1 / ranks that have the function, by local unknown.
    VectorX share;
    VectorX diagonal;
};

VectorX array_of(Vec x) {
    PetscInt n = 0;
    VecGetLocalSize(x, &n);
    const double* array = nullptr;
    VecGetArrayRead(x, &array);
    VectorX result = Eigen::Map<const VectorX>(array, n);
    VecRestoreArrayRead(x, &array);
    return result;
}

void set_array(Vec y, const VectorX& values) {
    double* array = nullptr;
    VecGetArrayWrite(y, &array);
    std::copy(values.data(), values.data() + values.size(), array);
    VecRestoreArrayWrite(y, &array);
}

Context& context_of(Mat A) {
    void* context = nullptr;
    MatShellGetContext(A, &context);
    return *static_cast<Context*>(context);
}

PetscErrorCode multiply(Mat A, Vec x, Vec y) {
    const Context& c = context_of(A);
    const VectorX owned = array_of(x);
    const VectorX local = without_fixed(*c.is_fixed, c.fine->spread(owned, c.n_components));
    VectorX result =
        c.fine->add(without_fixed(*c.is_fixed, c.levels->multiply(local)), c.n_components);
    // Fixed unknowns: the diagonal times the unknown.
    for (int i = 0; i < c.fine->n_owned(); ++i) {
        for (int a = 0; a < c.n_components; ++a) {
            const Eigen::Index at = static_cast<Eigen::Index>(i) * c.n_components + a;
            const std::size_t unknown =
                static_cast<std::size_t>(c.fine->owned()[i]) * c.n_components + a;
            if (!c.is_fixed->empty() && (*c.is_fixed)[unknown] != 0) {
                result[at] = c.diagonal[at] * owned[at];
            }
        }
    }
    set_array(y, result);
    return 0;
}

PetscErrorCode get_diagonal(Mat A, Vec diagonal) {
    set_array(diagonal, context_of(A).diagonal);
    return 0;
}

/// Fine from coarse: the ranks' own values, their mean where several have the function.
PetscErrorCode prolong(Mat P, Vec x, Vec y) {
    const Context& c = context_of(P);
    const VectorX local =
        without_fixed(*c.coarse_is_fixed, c.coarse->spread(array_of(x), c.n_components));
    const VectorX fine = c.share.cwiseProduct(c.levels->prolong(local));
    set_array(y, c.fine->add(without_fixed(*c.is_fixed, fine), c.n_components));
    return 0;
}

PetscErrorCode restrict(Mat P, Vec x, Vec y) {
    const Context& c = context_of(P);
    const VectorX local = without_fixed(*c.is_fixed, c.fine->spread(array_of(x), c.n_components));
    const VectorX coarse = c.levels->restrict(c.share.cwiseProduct(local));
    set_array(y, c.coarse->add(without_fixed(*c.coarse_is_fixed, coarse), c.n_components));
    return 0;
}

}  // namespace

struct DistributedSolver::Parts {
    Communicator ranks;
    PetscKrylov krylov;
    PetscMatrix A;
    PetscMatrix coarse;
    PetscMatrix prolongation;
    Context context;
    const SharedNumbers* numbers = nullptr;
    int n_components = 1;
    std::vector<char> is_fixed;
    std::vector<char> coarse_is_fixed;
    std::string name = "petsc";
};

DistributedSolver::DistributedSolver(const Communicator& ranks, const SolverOptions& options)
    : parts_(new Parts{.ranks = ranks,
                       .krylov = PetscKrylov(options),
                       .A = {},
                       .coarse = {},
                       .prolongation = {},
                       .context = {},
                       .is_fixed = {},
                       .coarse_is_fixed = {}}) {}

DistributedSolver::~DistributedSolver() = default;

void DistributedSolver::factorize(const DistributedSystem& system) {
    parts_->numbers = &system.numbers;
    parts_->n_components = system.n_components;
    parts_->is_fixed = system.is_fixed;
    const PetscSession session(parts_->krylov.petsc_options());
    MatDestroy(&parts_->A.A);
    assemble_rows(system, parts_->A);
    parts_->krylov.set_up(parts_->A.A, system.skew == nullptr);
}

void DistributedSolver::prepare(const DistributedSystem& system, const MatrixFreeLevels& levels) {
    Parts& p = *parts_;
    p.numbers = &system.numbers;
    p.n_components = system.n_components;
    p.is_fixed = system.is_fixed;
    p.coarse_is_fixed = levels.coarse.is_fixed;
    p.name = "matrix_free";
    const int n = system.n_components;
    const SharedNumbers& fine = system.numbers;
    const SharedNumbers& coarse = levels.coarse.numbers;
    p.context = {&fine, &coarse, n, &p.is_fixed, &p.coarse_is_fixed, &levels, {}, {}};
    p.context.share.resize(static_cast<Eigen::Index>(fine.n_local()) * n);
    for (int i = 0; i < fine.n_local(); ++i) {
        p.context.share.segment(static_cast<Eigen::Index>(i) * n, n)
            .setConstant(1.0 / fine.multiplicities()[i]);
    }
    p.context.diagonal = fine.add(levels.diagonal, n);

    const PetscSession session(p.krylov.petsc_options());
    const auto shell = [&](const SharedNumbers& rows, const SharedNumbers& columns,
                           PetscMatrix& A) {
        check_petsc(MatCreateShell(PETSC_COMM_WORLD, rows.n_owned() * n, columns.n_owned() * n,
                                   rows.n_global() * n, columns.n_global() * n, &p.context, &A.A));
        check_petsc(MatSetBlockSizes(A.A, n, n));
    };
    const auto operation = [](auto* function) { return reinterpret_cast<void (*)()>(function); };
    shell(fine, fine, p.A);
    check_petsc(MatShellSetOperation(p.A.A, MATOP_MULT, operation(multiply)));
    check_petsc(MatShellSetOperation(p.A.A, MATOP_GET_DIAGONAL, operation(get_diagonal)));
    check_petsc(MatSetOption(p.A.A, MAT_SPD, PETSC_TRUE));
    shell(fine, coarse, p.prolongation);
    check_petsc(MatShellSetOperation(p.prolongation.A, MATOP_MULT, operation(prolong)));
    check_petsc(MatShellSetOperation(p.prolongation.A, MATOP_MULT_TRANSPOSE, operation(restrict)));
    assemble_rows(levels.coarse, p.coarse);

    p.krylov.set_up(p.A.A, true, [&](KSP ksp) {
        PC pc = nullptr;
        check_petsc(KSPGetPC(ksp, &pc));
        check_petsc(PCSetType(pc, PCMG));
        check_petsc(PCMGSetLevels(pc, 2, nullptr));
        check_petsc(PCMGSetInterpolation(pc, 1, p.prolongation.A));
        check_petsc(PCMGSetGalerkin(pc, PC_MG_GALERKIN_NONE));
        KSP smoother = nullptr;
        check_petsc(PCMGGetSmoother(pc, 1, &smoother));
        check_petsc(KSPSetType(smoother, KSPCHEBYSHEV));
        check_petsc(KSPSetOperators(smoother, p.A.A, p.A.A));
        PC smoother_pc = nullptr;
        check_petsc(KSPGetPC(smoother, &smoother_pc));
        check_petsc(PCSetType(smoother_pc, PCJACOBI));
        constexpr int n_smoothing_steps = 2;
        check_petsc(PCMGSetNumberSmooth(pc, n_smoothing_steps));
        KSP coarse_solver = nullptr;
        check_petsc(PCMGGetCoarseSolve(pc, &coarse_solver));
        check_petsc(KSPSetType(coarse_solver, KSPPREONLY));
        check_petsc(KSPSetOperators(coarse_solver, p.coarse.A, p.coarse.A));
        PC coarse_pc = nullptr;
        check_petsc(KSPGetPC(coarse_solver, &coarse_pc));
        check_petsc(PCSetType(coarse_pc, PCGAMG));
    });
}

SolveReport DistributedSolver::solve(const MatrixX& b, MatrixX& x) {
    SolveReport report;
    report.solver = parts_->name;
    const SharedNumbers& numbers = *parts_->numbers;
    const int n = parts_->n_components;
    std::vector<char> owned_is_fixed;
    for (const int function : numbers.owned()) {
        for (int a = 0; a < n && !parts_->is_fixed.empty(); ++a) {
            owned_is_fixed.push_back(parts_->is_fixed[static_cast<std::size_t>(function) * n + a]);
        }
    }
    x = MatrixX::Zero(b.rows(), b.cols());
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
        const VectorX owned_b = numbers.add(without_fixed(parts_->is_fixed, b.col(k)), n);
        const VectorX owned_x = parts_->krylov.solve(owned_b, owned_is_fixed, report);
        x.col(k) = numbers.spread(owned_x, n);
    }
    return report;
}

}  // namespace couture::iga
