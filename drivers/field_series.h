#pragma once

#include <filesystem>
#include <vector>

#include "drivers/deck_check.h"
#include "drivers/summary.h"
#include "iga/solve/load_stepping.h"
#include "io/deck.h"

namespace couture::drivers {

/// The fields of a run over time: "<name>_0001.vtu", ... and "<name>.pvd", which lists them with
/// their times; the Gauss points likewise as "<name>_gauss_0001.vtu", ...
template <int d>
class FieldSeries {
  public:
    FieldSeries(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                const GeometryCertificate& certificate, std::filesystem::path folder);

    /// Removes the files of an earlier run.
    void clear() const;
    /// [output] asks for the fields of this step: each n-th, those at the end of the run and
    /// around remeshings.
    [[nodiscard]] bool is_due(const StepSummary& step) const;
    /// The fields of this step are there.
    [[nodiscard]] bool has(const StepSummary& step) const;
    /// @throws FileError  if it can't be written
    void write(const iga::AcceptedStep<d>& step) const;
    /// Writes the lists of those fields of the history that are there.
    void write_lists(const std::vector<StepSummary>& history) const;
    /// Draws a step.
    void draw(const iga::AcceptedStep<d>& step) const;
    /// Paths of the lists and the picture that are asked for.
    [[nodiscard]] std::vector<std::filesystem::path> files() const;

  private:
    /// Beginnings of the files' names.
    [[nodiscard]] std::vector<std::string> stems() const;
    [[nodiscard]] std::filesystem::path file_of(const std::string& stem, int number,
                                                bool is_remeshing) const;

    const io::Deck& deck_;
    std::filesystem::path folder_;
    std::string name_;
    std::string provenance_;
};

}  // namespace couture::drivers
