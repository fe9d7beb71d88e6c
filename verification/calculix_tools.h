#pragma once

#include "iga/topology/field.h"
#include "io/calculix.h"
#include "io/calculix_run.h"
#include "verification/verification.h"

namespace couture::verification {

/// Runs CalculiX in a folder that is removed afterwards.
///
/// @throws FileError, SolverError  as `io::run_calculix`
[[nodiscard]] io::CalculixResult run_calculix(const io::CalculixModel& model);

/// Positions in the undeformed body and Cauchy stresses (Voigt) of a displacement of a hyperelastic
/// solid at the 2 x 2 x 2 integration points of the mesh's elements, in CalculiX's order: that of
/// the local axes, the first fastest.
struct BrickStresses {
    MatrixX points;
    MatrixX stresses;
};
[[nodiscard]] BrickStresses brick_stresses(const io::HexMesh& mesh, const iga::Field<3>& u,
                                           const iga::Hyperelastic& material);

/// A case that needs CalculiX: records why it is skipped where the program is not installed.
[[nodiscard]] Case calculix_case(const std::string& name, bool is_long,
                                 std::function<void(Recorder&)> run);

}  // namespace couture::verification
