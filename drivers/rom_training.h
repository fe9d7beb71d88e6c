#pragma once

#include "drivers/rom_samples.h"
#include "iga/core/timer.h"
#include "io/snapshot_store.h"
#include "rom/snapshots.h"

namespace couture::drivers {

/// A sample that is left out, and why.
struct RefusedSample {
    int i_geometry = 0;
    /// -1: no material and load of that geometry.
    int i_material = -1;
    /// The parameters, "R1 = 11, ...".
    std::string point;
    std::string reason;
};

/// How far a store is filled.
struct StoreProgress {
    int n_geometries = 0;
    /// Of all loads with one geometry and material.
    int n_solutions = 0;
    int n_refused = 0;
    /// Solutions that are neither there nor refused, and those of them that are not projected.
    int n_missing = 0;
    int n_unsolved = 0;
};

/// Says how far a store is, and how long the rest may take.
class Progress {
  public:
    Progress(const RomPlan& plan, const io::SnapshotStore& store);
    /// Prints a line if something was added since the last one.
    void report() const;

  private:
    const RomPlan& plan_;
    const io::SnapshotStore& store_;
    StoreProgress before_;
    mutable StoreProgress last_;
    Timer timer_;
};

[[nodiscard]] StoreProgress progress_of(const RomPlan& plan, const io::SnapshotStore& store);
[[nodiscard]] std::vector<RefusedSample> refused_samples(const RomPlan& plan,
                                                         const io::SnapshotStore& store);

/// All that a store holds of the plan; what is refused or missing is NaN.
///
/// @throws InputError  if nothing is left, and as SnapshotStore
[[nodiscard]] rom::SnapshotSet read_snapshots(const RomSamples& samples,
                                              const iga::Space<3>& reference,
                                              const io::SnapshotStore& store);

/// Makes what a store lacks of the geometries `i_first`, `i_first + stride`, ...: those that can't
/// be meshed or solved are noted there as refused, and the others go on. Displacements that are
/// projected are made by another call, when all those that are solved are there.
///
/// @param reference  the space of the reference member
/// @throws FileError  if a result can't be written: all before it is kept
void fill_store(RomSamples& samples, const iga::Space<3>& reference, io::SnapshotStore& store,
                int i_first, int stride);

}  // namespace couture::drivers
