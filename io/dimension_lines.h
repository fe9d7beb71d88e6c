#pragma once

#include <string>
#include <vector>

#include "io/picture.h"

namespace couture::io {

/// A size to be shown in a picture.
struct DimensionLine {
    Vector3 from = Vector3::Zero();
    Vector3 to = Vector3::Zero();
    /// Unit direction that is measured along, in the picture's plane.
    Vector3 along = Vector3::UnitX();
    /// Unit direction, to the right, left, top or bottom of the picture, where the line lies
    /// outside of all pieces and ends; zero: it goes through both ends, and on to its text.
    Vector3 offset = Vector3::Zero();
    /// There is an arrow head at `to` only.
    bool is_one_sided = false;
    std::string text;
};

/// Draws sizes into a scene as engineers do: dimension lines with arrow heads and texts, in rows
/// outside of the pieces, the shorter ones nearer, and extension lines from the ends to them.
/// Everything lies in front of the pieces. Sets frame, width and height of the scene so that all of
/// it is seen, labels too.
///
/// @param pixels_per_unit  scale of the picture
/// @throws InputError  if the scene has no piece, the scale is not positive, or a direction is none
///                     of the allowed ones; names the text
void add_dimension_lines(Scene& scene, const std::vector<DimensionLine>& lines,
                         double pixels_per_unit);

}  // namespace couture::io
