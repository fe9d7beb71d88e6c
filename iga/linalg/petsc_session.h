#pragma once

#include <petscsys.h>

#include <string>
#include <vector>

namespace couture::iga {

/// Starts PETSc (and MPI) at the first call; it is ended when the program ends. No signals are
/// caught and no files of options are read.
void start_petsc();

/// False once PETSc was ended: objects that live longer have nothing left to free.
[[nodiscard]] bool petsc_is_alive();

/// @throws SolverError  with PETSc's message, if `code` is one of an error
void check_petsc(PetscErrorCode code);

/// Options as on PETSc's command line, for `PetscSession`; to be destroyed by
/// PetscOptionsDestroy.
///
/// @throws SolverError  if they can't be read
[[nodiscard]] PetscOptions read_petsc_options(const std::string& text);

/// @throws InputError  naming options that nothing has read; those about printing are read late
void check_unused_petsc_options(PetscOptions options);

/// While it lives, PETSc reads these options and its errors are kept instead of printed. May be
/// made while another of the same options lives.
class PetscSession {
  public:
    explicit PetscSession(PetscOptions options);
    ~PetscSession();
    PetscSession(const PetscSession&) = delete;
    PetscSession& operator=(const PetscSession&) = delete;

  private:
    PetscOptions before_;
};

}  // namespace couture::iga
