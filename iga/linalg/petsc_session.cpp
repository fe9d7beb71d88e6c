#include "iga/linalg/petsc_session.h"

#include <fmt/ranges.h>

#include <cstdlib>
#include <type_traits>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

static_assert(std::is_same_v<PetscInt, int> && std::is_same_v<PetscScalar, double>,
              "PETSc must be built with 32-bit integers and real double scalars");

/// What the innermost session has pushed; null: nothing.
PetscOptions current_options = nullptr;

/// First message of the error that is being passed up through PETSc.
std::string error_message;

PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
    if (type == PETSC_ERROR_INITIAL) {
        error_message = fmt::format("{} (in {})", message, function);
    }
    return code;
}

void finalize_at_exit() {
    int mpi_is_finalized = 0;
    MPI_Finalized(&mpi_is_finalized);
    if (petsc_is_alive() && mpi_is_finalized == 0) {
        PetscFinalize();
    }
}

}  // namespace

void start_petsc() {
    PetscBool is_initialized = PETSC_FALSE;
    PetscInitialized(&is_initialized);
    if (is_initialized == PETSC_TRUE) {
        return;
    }
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
    PetscOptionsSetValue(nullptr, "-skip_petscrc", "true");
    check_petsc(PetscInitializeNoArguments());
    std::atexit(finalize_at_exit);
}

bool petsc_is_alive() {
    PetscBool is_finalized = PETSC_FALSE;
    PetscFinalized(&is_finalized);
    return is_finalized == PETSC_FALSE;
}

void check_petsc(PetscErrorCode code) {
    if (code != 0) {
        const std::string message =
            error_message.empty() ? fmt::format("error code {}", code) : error_message;
        error_message.clear();
        throw SolverError("petsc: {}", message);
    }
}

PetscOptions read_petsc_options(const std::string& text) {
    PetscOptions options = nullptr;
    check_petsc(PetscPushErrorHandler(keep_message, nullptr));
    PetscErrorCode code = PetscOptionsCreate(&options);
    if (code == 0) {
        code = PetscOptionsInsertString(options, text.c_str());
    }
    PetscPopErrorHandler();
    check_petsc(code);
    return options;
}

void check_unused_petsc_options(PetscOptions options) {
    PetscInt n_left = 0;
    char** names = nullptr;
    char** values = nullptr;
    check_petsc(PetscOptionsLeftGet(options, &n_left, &names, &values));
    std::vector<std::string> unused;
    for (int i = 0; i < n_left; ++i) {
        const std::string name = names[i];
        const bool is_about_printing = name.find("view") != std::string::npos ||
                                       name.find("reason") != std::string::npos ||
                                       name.find("monitor") != std::string::npos;
        if (!is_about_printing) {
            unused.push_back("-" + name);
        }
    }
    check_petsc(PetscOptionsLeftRestore(options, &n_left, &names, &values));
    if (!unused.empty()) {
        throw InputError(
            "petsc: nothing reads the option {}; check its spelling and that the chosen "
            "solver and preconditioner have it",
            fmt::join(unused, ", "));
    }
}

PetscSession::PetscSession(PetscOptions options) : before_(current_options) {
    check_petsc(PetscPushErrorHandler(keep_message, nullptr));
    // PETSc would lose its way if the same were pushed twice.
    if (options != current_options) {
        const PetscErrorCode code = PetscOptionsPush(options);
        if (code != 0) {
            PetscPopErrorHandler();
            check_petsc(code);
        }
        current_options = options;
    }
}

PetscSession::~PetscSession() {
    if (before_ != current_options) {
        PetscOptionsPop();
        current_options = before_;
    }
    PetscPopErrorHandler();
}

}  // namespace couture::iga
