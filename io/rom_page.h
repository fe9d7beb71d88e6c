#pragma once

#include <string>

#include "io/export_content.h"

namespace couture::io {

/// A page (HTML, one file) that evaluates a reduced model in a browser: geometry, displacement and
/// von Mises stress at the points of grids, by the formulas of ReducedModel and FieldSampler.
///
/// It holds only nodes that the grids see. Modes are rounded so that the field changes by no more
/// than 1e-7 of its largest mode's share: to 8 or 16 bits the weak ones, to single precision the
/// others. All else is in double precision.
///
/// @throws InputError  for a grid that is no side: with more than one parameter in all directions
[[nodiscard]] std::string make_rom_page(const rom::ReducedModel& model,
                                        const ExportContent& content);

}  // namespace couture::io
