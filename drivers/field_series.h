#pragma once

#include <filesystem>
#include <vector>

#include "drivers/deck_check.h"
#include "drivers/summary.h"
#include "iga/post/finite_stress.h"
#include "io/deck.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

/// The fields of a run over time: "<name>_0001.vtu", ... and "<name>.pvd", which lists them with
/// their times; the Gauss points likewise as "<name>_gauss_0001.vtu", ...
template <int d>
class FieldSeries {
  public:
    /// @param deck  must outlive this
    /// @param extension  ".pvtu" where the files are written by others, in pieces
    FieldSeries(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                const GeometryCertificate& certificate, std::filesystem::path folder,
                std::string extension = ".vtu");

    /// Removes the files of an earlier run.
    void clear() const;
    /// [output] asks for the fields of this step: each n-th, those at the end of the run and
    /// around remeshings.
    [[nodiscard]] bool is_due(const StepSummary& step) const;
    /// The fields of this step are there.
    [[nodiscard]] bool has(const StepSummary& step) const;
    /// @throws FileError  if it can't be written
    void write(const iga::AcceptedStep<d>& step) const;
    /// Writes the lists of those fields of the history that are there; of a step that a remeshing
    /// follows at the same time, only the latter's.
    void write_lists(const std::vector<StepSummary>& history) const;
    /// Draws a step.
    void draw(const iga::AcceptedStep<d>& step) const;
    /// Paths of the lists and the picture that are asked for.
    [[nodiscard]] std::vector<std::filesystem::path> files() const;

  private:
    [[nodiscard]] iga::FiniteStresses<d> stresses_of(const iga::AcceptedStep<d>& step) const;
    /// Beginnings of the files' names.
    [[nodiscard]] std::vector<std::string> stems() const;
    [[nodiscard]] std::filesystem::path file_of(const std::string& stem, int number,
                                                bool is_remeshing) const;
    /// "NNNN.vtu" or "NNNN_remeshed.vtu" after the stem and a dash.
    [[nodiscard]] bool belongs_to(const std::string& file, const std::string& stem) const;

    const io::Deck& deck_;
    std::filesystem::path folder_;
    std::string name_;
    std::string provenance_;
    std::string extension_;
};

/// What result files show of a body at finite strain.
[[nodiscard]] std::vector<io::PointArray> field_arrays(const MatrixX& displacement,
                                                       const iga::FiniteFields& fields);

}  // namespace couture::drivers
