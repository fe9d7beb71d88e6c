#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "io/color_map.h"

namespace couture::io {

/// Triangles, shaded smoothly up to creases of 40 degrees.
struct SurfacePiece {
    /// n x 3.
    MatrixX vertices;
    /// m x 3 vertex numbers.
    Eigen::MatrixXi triangles;
    /// n numbers shown by the colour map, or empty: `color` is taken. NaN is shown grey.
    VectorX values;
    Color color{0.70, 0.76, 0.82};
    double opacity = 1.0;
};

struct CurvePiece {
    /// n x 3.
    MatrixX points;
    bool is_closed = false;
    Color color{0.12, 0.14, 0.17};
    /// Pixels.
    double width = 2.2;
};

/// Text centred at a point, always in front.
struct Label {
    Vector3 position = Vector3::Zero();
    std::string text;
    /// Radians, counter-clockwise in the picture.
    double angle = 0.0;
    /// Hides what is behind the text.
    bool has_background = false;
};

/// The part of the picture's plane that is shown.
struct ViewFrame {
    /// Lengths from the origin to the right and upwards.
    Vector2 center = Vector2::Zero();
    double height = 1.0;
};

/// What a picture shows and from where, in parallel projection.
struct Scene {
    std::vector<SurfacePiece> surfaces;
    std::vector<CurvePiece> curves;
    std::vector<Label> labels;
    std::string title;
    /// Quantity and unit above the colour bar, which is there if any surface has values.
    std::string legend;
    /// Values at the ends of the colour map; nothing: those of all surfaces.
    std::optional<std::array<double, 2>> range;
    /// Where the viewer looks, and what is up in the picture.
    Vector3 view_direction{-1.0, 1.5, -1.0};
    Vector3 up{0.0, 0.0, 1.0};
    /// Nothing: fitted to the pieces.
    std::optional<ViewFrame> frame;
    bool show_axes = true;
    Color background{1.0, 1.0, 1.0};
    int width = 1200;
    int height = 900;
    /// Size of text, and width of lines, relative to those of 1200 x 900 pixels; nothing: as large
    /// as the picture is.
    std::optional<double> text_scale;
};

/// The picture's directions as columns: to the right, upwards, towards the viewer.
[[nodiscard]] Matrix<3> view_axes(const Scene& scene);

/// Pixels that a label takes across and up before it is turned, about; its letters are those of
/// `text_scale` 1.
[[nodiscard]] Vector2 label_size(const std::string& text);

/// What is missing for pictures on this machine, with the way out; nothing if all is there.
[[nodiscard]] std::optional<std::string> missing_for_pictures();

/// Draws the scene into a PNG file of width x height pixels, without a screen. It appears whole or
/// not at all.
///
/// @throws InputError  if a piece is inconsistent (a vertex number, a size, a coordinate that is
///                     not finite), the view or the size is unusable or there is nothing to show
/// @throws FileError   if the file can't be written or pictures can't be made here
void render_png(const std::filesystem::path& path, const Scene& scene);

/// Several scenes in one picture, in rows from the top, each as large as it asks for; centred in
/// its row, and rows in the picture.
///
/// @throws  as `render_png`; InputError  if there is no scene
void render_png(const std::filesystem::path& path, const std::vector<std::vector<Scene>>& rows);

}  // namespace couture::io
