#pragma once

#include <filesystem>

#include "drivers/deck_check.h"
#include "iga/solve/linear_static.h"
#include "io/deck.h"

namespace couture::drivers {

/// Writes what [output] asks for, per load case: "<name>.vtu" ("<name>_<case>.vtu" for named
/// cases), "<name>_gauss.vtu", "<name>.png".
///
/// @return paths of the files
template <int d>
[[nodiscard]] std::vector<std::filesystem::path> write_result_files(
    const io::Deck& deck, const iga::SpacePtr<d>& space, const iga::LinearStaticResult<d>& result,
    const GeometryCertificate& certificate, const std::filesystem::path& folder);

/// Names of the components of stresses and strains in result files.
[[nodiscard]] const std::vector<std::string>& voigt_names();
/// Von Mises stress and principal stresses of each row of stresses (n x 6).
[[nodiscard]] MatrixX von_mises_rows(const MatrixX& stresses);
[[nodiscard]] MatrixX principal_rows(const MatrixX& stresses);

/// Deck text and hash, program version, signature and certificate, as JSON: what every result file
/// carries.
template <int d>
[[nodiscard]] std::string provenance(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                     const GeometryCertificate& certificate);

}  // namespace couture::drivers
