#pragma once

#include "io/picture.h"

namespace couture::io {

/// @throws InputError  for what can't be drawn, see render_png
void check_scene(const Scene& scene);

}  // namespace couture::io
