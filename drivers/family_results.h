#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/family_members.h"
#include "meshing/pipeline/homology.h"
#include "meshing/volume/layout_volume.h"

namespace couture::drivers {

/// What became of a member of a family.
struct MemberResult {
    io::FamilyMember member;
    /// Why it failed; empty if it did not.
    std::string failure;
    double seconds = 0.0;
    /// Of its volume; the next six only if there is one.
    std::string signature;
    std::string certificate;
    double min_scaled_jacobian = 0.0;
    double mean_scaled_jacobian = 0.0;
    double max_distance = 0.0;
    /// See meshing::VolumeDistance.
    double hausdorff = 0.0;
    double hausdorff_features = 0.0;
    /// Of parts.
    std::optional<meshing::HomologyReport> homology;
    /// Certificates half way to the reference, and to the member before that is done.
    std::string to_reference;
    std::string to_previous;

    [[nodiscard]] bool has_certified_midpoints() const;
};

/// What a run of a family leaves.
struct FamilySummary {
    std::string title;
    /// The reference first.
    std::vector<MemberResult> results;
    double seconds = 0.0;
    std::vector<std::filesystem::path> files;

    [[nodiscard]] int n_failed() const;
    /// Members with a midpoint that is not certified.
    [[nodiscard]] int n_folded() const;
    [[nodiscard]] bool is_done() const { return n_failed() == 0 && n_folded() == 0; }
};

/// As mesh_family_schema.md says.
[[nodiscard]] std::string family_json(const FamilySummary& summary);
/// A table with a line for each member.
void print_family(const FamilySummary& summary, const std::filesystem::path& folder);

/// Writes the members so far, for read_family_progress.
///
/// @param job  what they were made by
/// @throws FileError  if it can't be written
void write_family_progress(const std::filesystem::path& path, const std::string& job,
                           const std::vector<MemberResult>& results);

/// The members of an earlier run that are done; none if there is no such file.
///
/// @throws FileError   if it is no such file
/// @throws InputError  if another job wrote it
[[nodiscard]] std::vector<MemberResult> read_family_progress(const std::filesystem::path& path,
                                                             const std::string& job);

}  // namespace couture::drivers
