#pragma once

#include "iga/topology/jacobian_certificate.h"
#include "iga/topology/multipatch.h"

namespace couture::meshing {

/// The volume half way between two members of a family: the mean of their control points.
///
/// @throws InputError  if their signatures differ, or a patch has weights
///
/// Source: [Maquart19] Fig. 5.1.
[[nodiscard]] iga::MultiPatch<3> midpoint(const iga::MultiPatch<3>& first,
                                          const iga::MultiPatch<3>& second);

/// The worst of all patches' certificates.
[[nodiscard]] iga::Validity certified(const iga::MultiPatch<3>& volume);

}  // namespace couture::meshing
