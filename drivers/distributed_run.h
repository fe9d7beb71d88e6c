#pragma once

#include "drivers/commands/commands.h"

namespace couture::drivers {

/// `couture solve` on all ranks of `mpirun`: each reads the deck and its geometry, keeps its share
/// of the elements, and writes its piece of the fields; rank 0 reports.
///
/// @throws InputError  for what runs in one process only: pictures, Gauss points, remeshing, a
///                     geometry that is interpolated
int run_distributed(const SolveOptions& options, const CommonOptions& common);

}  // namespace couture::drivers
