#pragma once

#include <filesystem>
#include <optional>

#include "drivers/deck_check.h"
#include "iga/solve/linear_static.h"
#include "io/deck.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

/// Writes what [output] asks for, per load case: "<name>.vtu" ("<name>_<case>.vtu" for named
/// cases), "<name>_gauss.vtu", "<name>.png".
///
/// Stresses are those of the displacements: of hyperelastic bodies Cauchy's at finite strain.
///
/// @param stress  coefficients, n_dofs x 6, that are written in place of these
/// @return paths of the files
template <int d>
[[nodiscard]] std::vector<std::filesystem::path> write_result_files(
    const io::Deck& deck, const iga::SpacePtr<d>& space, const iga::LinearStaticResult<d>& result,
    const GeometryCertificate& certificate, const std::filesystem::path& folder,
    const std::optional<MatrixX>& stress = {});

/// The stress of a displacement as a smooth field by L2 projection, n_dofs x 6: Cauchy's at finite
/// strain where the deck's material is hyperelastic.
///
/// @throws what iga::project_stress and iga::FiniteStresses throw
template <int d>
[[nodiscard]] MatrixX smooth_stress(const io::Deck& deck, const iga::CaseResult<d>& result);

/// Names of the components of stresses and strains in result files.
[[nodiscard]] const std::vector<std::string>& voigt_names();
/// Von Mises stress and principal stresses of each row of stresses (n x 6).
[[nodiscard]] MatrixX von_mises_rows(const MatrixX& stresses);
[[nodiscard]] MatrixX principal_rows(const MatrixX& stresses);

/// What result files show of a case: displacement, stresses and what follows from them.
///
/// @param stress  n_dofs x 6
template <int d>
[[nodiscard]] std::vector<io::PointArray> field_arrays(const iga::Problem& problem,
                                                       const iga::CaseResult<d>& result,
                                                       const MatrixX& stress);

/// Deck text and hash, program version, signature and certificate, as JSON: what every result file
/// carries.
template <int d>
[[nodiscard]] std::string provenance(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                     const GeometryCertificate& certificate);

}  // namespace couture::drivers
