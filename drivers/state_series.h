#pragma once

#include <filesystem>
#include <vector>

#include "io/state_file.h"

namespace couture::drivers {

/// "0003", or "0003_remeshed" of the remeshing that followed step 3: in names of files.
[[nodiscard]] std::string step_name(int number, bool is_remeshing);

/// The states of a run in a folder of their own, one file for each accepted step and remeshing.
template <int d>
class StateSeries {
  public:
    /// @param undeformed  reference before any remeshing
    StateSeries(std::filesystem::path folder, io::StateOrigin origin,
                iga::ReferencePtr<d> undeformed);

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    /// Removes the states of an earlier run. @return how many
    int clear() const;
    /// All steps until the newest that can be read, in order, without their matrices but for the
    /// last. Unreadable files are named in warnings; newer ones than the last are removed.
    ///
    /// @throws InputError  for states of another deck
    [[nodiscard]] std::vector<iga::AcceptedStep<d>> read_all() const;
    [[nodiscard]] iga::AcceptedStep<d> read(int number, bool is_remeshing) const;
    /// @throws FileError  if it can't be written
    void write(const iga::AcceptedStep<d>& step) const;

  private:
    [[nodiscard]] std::vector<std::filesystem::path> files() const;

    std::filesystem::path folder_;
    io::StateOrigin origin_;
    iga::ReferencePtr<d> undeformed_;
};

}  // namespace couture::drivers
