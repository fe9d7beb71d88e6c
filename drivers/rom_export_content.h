#pragma once

#include "drivers/rom_model.h"
#include "io/export_content.h"

namespace couture::drivers {

/// What a page shows of a model: its outer sides with as many points per element as fit into
/// `most_points` (at least the ends of elements), its deck's title and units, and its materials.
/// Materials are those of linear elasticity; moduli that are parameters must be Young's modulus or
/// Poisson's ratio of an isotropic material. Where that does not hold, `no_stress` says why.
[[nodiscard]] io::ExportContent page_content(const TrainedModel& trained, int most_points = 12'000);

/// The same with the ends of all elements, the points of `couture rom eval`.
[[nodiscard]] io::ExportContent volume_content(const TrainedModel& trained);

}  // namespace couture::drivers
