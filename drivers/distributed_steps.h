#pragma once

#include "drivers/distributed_job.h"
#include "drivers/summary.h"

namespace couture::drivers {

/// Follows a hyperelastic deck in time on all ranks. Each accepted step writes its fields in pieces
/// and each rank its state ("states/rank_0000/0001.h5", ...).
///
/// @param resume  goes on from the newest state that all ranks have
/// @param summary  filled: steps, probes, cases, solver, files
/// @throws InputError  what runs in one process only, states of another deck or number of ranks
template <int d>
void follow_on_ranks(const DistributedJob<d>& job, bool resume, Summary& summary);

}  // namespace couture::drivers
