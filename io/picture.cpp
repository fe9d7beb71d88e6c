#include "io/picture.h"

#include <vtkCamera.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/picture_check.h"
#include "io/picture_shapes.h"
#include "io/picture_text.h"
#include "io/virtual_display.h"

namespace couture::io {

namespace {

/// Everything is drawn this much larger and averaged down: smooth lines on any driver.
constexpr int oversampling = 2;
/// Height of the title at 900 pixels of picture height.
constexpr double title_size = 26.0;
/// Room around the shape, relative to it.
constexpr double margin = 1.06;

using Range = std::array<double, 2>;
/// Values that differ by less, relative to their size, are shown as one.
constexpr double uniform = 1e-6;

bool has_values(const Scene& scene) {
    return std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                       [](const SurfacePiece& piece) { return piece.values.size() > 0; });
}

Range value_range(const Scene& scene) {
    if (scene.range) {
        return *scene.range;
    }
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const SurfacePiece& piece : scene.surfaces) {
        for (const double value : piece.values) {
            if (std::isfinite(value)) {
                range[0] = std::min(range[0], value);
                range[1] = std::max(range[1], value);
            }
        }
    }
    if (!(range[0] <= range[1])) {
        return {0.0, 0.0};
    }
    // Rounding is not drawn as if it were a field.
    const double size = std::max(std::abs(range[0]), std::abs(range[1]));
    const double middle = 0.5 * (range[0] + range[1]);
    return range[1] - range[0] > uniform * size ? range : Range{middle, middle};
}

/// Lower and upper corner of all pieces in the camera's axes: 3 x 2.
Eigen::Matrix<double, 3, 2> view_box(const Scene& scene, const Matrix<3>& axes) {
    Eigen::Matrix<double, 3, 2> box;
    box.col(0).setConstant(std::numeric_limits<double>::infinity());
    box.col(1).setConstant(-std::numeric_limits<double>::infinity());
    const auto add = [&](const MatrixX& points) {
        const MatrixX seen = points * axes;
        box.col(0) = box.col(0).cwiseMin(seen.colwise().minCoeff().transpose());
        box.col(1) = box.col(1).cwiseMax(seen.colwise().maxCoeff().transpose());
    };
    for (const SurfacePiece& piece : scene.surfaces) {
        add(piece.vertices);
    }
    for (const CurvePiece& piece : scene.curves) {
        add(piece.points);
    }
    return box;
}

/// `look`: camera axes; shows the box [centre - half, centre + half] in height.
void aim(vtkRenderer& renderer, const Matrix<3>& look, const Vector3& center, double half_height,
         double depth) {
    vtkCamera& camera = *renderer.GetActiveCamera();
    const Vector3 from = center + (depth + half_height) * look.col(2);
    camera.ParallelProjectionOn();
    camera.SetFocalPoint(center.data());
    camera.SetPosition(from.data());
    camera.SetViewUp(look(0, 1), look(1, 1), look(2, 1));
    camera.SetParallelScale(half_height);
    camera.SetClippingRange(0.5 * half_height, 2.0 * depth + 2.0 * half_height);
}

/// The directions x, y, z in the lower left corner.
void add_axes(vtkRenderWindow& window, const Matrix<3>& look, double scale) {
    constexpr double side = 120.0;
    constexpr std::array<Color, 3> colors{
        {{0.80, 0.22, 0.20}, {0.20, 0.55, 0.25}, {0.18, 0.35, 0.75}}};
    constexpr std::array<const char*, 3> names{"x", "y", "z"};
    vtkNew<vtkRenderer> renderer;
    const int* size = window.GetSize();
    renderer->SetViewport(0.0, 0.0, side * scale / size[0], side * scale / size[1]);
    renderer->SetLayer(2);
    renderer->InteractiveOff();
    for (int k = 0; k < 3; ++k) {
        CurvePiece line;
        line.points = MatrixX::Zero(2, 3);
        line.points(1, k) = 1.0;
        line.color = colors[k];
        line.width = 2.5;
        // An axis seen end on has no name.
        if (line.points.row(1).dot(look.col(2).transpose()) < 0.98 &&
            line.points.row(1).dot(look.col(2).transpose()) > -0.98) {
            add_curve(*renderer, line, scale);
            add_label(*renderer, {1.28 * Vector3::Unit(k), names[k]}, 0.9 * text_size * scale);
        }
    }
    aim(*renderer, look, Vector3::Zero(), 1.6, 2.0);
    window.AddRenderer(renderer);
}

void add_pieces(vtkRenderWindow& window, const Scene& scene, const Range& range,
                const Matrix<3>& look, double scale) {
    vtkNew<vtkRenderer> renderer;
    const double visible_width = has_values(scene) ? 1.0 - legend_width : 1.0;
    const double visible_height = scene.title.empty() ? 1.0 : 0.92;
    renderer->SetViewport(0.0, 0.0, visible_width, visible_height);
    renderer->SetLayer(1);
    for (const SurfacePiece& piece : scene.surfaces) {
        add_surface(*renderer, piece, range);
        if (piece.opacity < 1.0) {
            renderer->UseDepthPeelingOn();
            renderer->SetMaximumNumberOfPeels(16);
            renderer->SetOcclusionRatio(0.0);
        }
    }
    for (const CurvePiece& piece : scene.curves) {
        add_curve(*renderer, piece, scale);
    }
    for (const Label& label : scene.labels) {
        add_label(*renderer, label, text_size * scale);
    }
    vtkNew<vtkLightKit> lights;
    lights->SetKeyLightIntensity(0.92);
    lights->SetKeyToFillRatio(1.8);
    lights->SetKeyToBackRatio(3.0);
    lights->SetKeyLightWarmth(0.5);
    lights->SetFillLightWarmth(0.5);
    lights->SetBackLightWarmth(0.5);
    lights->SetHeadLightWarmth(0.5);
    lights->AddLightsToRenderer(renderer);

    const Eigen::Matrix<double, 3, 2> box = view_box(scene, look);
    const Vector3 extent = box.col(1) - box.col(0);
    const double aspect = visible_width * scene.width / (visible_height * scene.height);
    const double smallest = std::max(1e-6 * extent.norm(), std::numeric_limits<double>::min());
    Vector3 center = 0.5 * (box.col(0) + box.col(1));
    double half = 0.5 * margin * std::max({extent[1], extent[0] / aspect, smallest});
    if (scene.frame) {
        center.head<2>() = scene.frame->center;
        half = 0.5 * scene.frame->height;
    }
    aim(*renderer, look, look * center, half, std::max(extent[2], smallest));
    window.AddRenderer(renderer);
}

void add_background(vtkRenderWindow& window, const Scene& scene, const Range& range, double scale) {
    vtkNew<vtkRenderer> renderer;
    renderer->SetLayer(0);
    renderer->SetBackground(scene.background[0], scene.background[1], scene.background[2]);
    const int* size = window.GetSize();
    if (has_values(scene)) {
        add_legend(*renderer, scene, range, size[0], size[1], scale);
    }
    if (!scene.title.empty()) {
        add_text(*renderer, scene.title, title_size * scale, 24.0 * scale,
                 size[1] - 1.4 * title_size * scale);
    }
    window.AddRenderer(renderer);
}

/// Means of blocks of oversampling^2 pixels.
vtkSmartPointer<vtkImageData> shrink(vtkImageData& large) {
    constexpr int n = oversampling;
    const int* size = large.GetDimensions();
    vtkNew<vtkImageData> small;
    small->SetDimensions(size[0] / n, size[1] / n, 1);
    small->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    const auto* from = static_cast<const unsigned char*>(large.GetScalarPointer());
    auto* to = static_cast<unsigned char*>(small->GetScalarPointer());
    for (int y = 0; y < size[1] / n; ++y) {
        for (int x = 0; x < size[0] / n; ++x) {
            for (int c = 0; c < 3; ++c) {
                int sum = 0;
                for (int i = 0; i < n * n; ++i) {
                    const std::size_t pixel =
                        static_cast<std::size_t>(y * n + i / n) * size[0] + x * n + i % n;
                    sum += from[3 * pixel + c];
                }
                *to++ = static_cast<unsigned char>((sum + n * n / 2) / (n * n));
            }
        }
    }
    return small;
}

void write_png(const std::filesystem::path& path, vtkImageData& image) {
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        // Tried first because VTK does not pass the system's reason on.
        if (!std::ofstream(temporary)) {
            throw FileError("{}: can't be written: {}", path.string(), std::strerror(errno));
        }
        vtkNew<vtkPNGWriter> writer;
        writer->SetFileName(temporary.c_str());
        writer->SetInputData(&image);
        writer->Write();
        if (writer->GetErrorCode() != vtkErrorCode::NoError) {
            throw FileError("{}: can't be written: {}", path.string(),
                            vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
        }
    });
}

/// As large as the scene asks for; there must be a display.
vtkSmartPointer<vtkImageData> draw(const Scene& scene) {
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetAlphaBitPlanes(1);
    window->SetNumberOfLayers(3);
    window->SetSize(oversampling * scene.width, oversampling * scene.height);
    const double scale = oversampling * scene.text_scale.value_or(
                                            std::min(scene.width / 1200.0, scene.height / 900.0));
    const Range range = value_range(scene);
    const Matrix<3> look = view_axes(scene);
    add_background(*window, scene, range, scale);
    add_pieces(*window, scene, range, look, scale);
    if (scene.show_axes) {
        add_axes(*window, look, scale);
    }
    window->Render();
    vtkNew<vtkWindowToImageFilter> picture;
    picture->SetInput(window);
    picture->SetInputBufferTypeToRGB();
    picture->ReadFrontBufferOff();
    picture->ShouldRerenderOff();
    picture->Update();
    return shrink(*picture->GetOutput());
}

int row_width(const std::vector<Scene>& row) {
    int width = 0;
    for (const Scene& scene : row) {
        width += scene.width;
    }
    return width;
}

int row_height(const std::vector<Scene>& row) {
    int height = 0;
    for (const Scene& scene : row) {
        height = std::max(height, scene.height);
    }
    return height;
}

/// Copies a picture into a larger one with its lower left pixel at (left, bottom).
void paste(vtkImageData& picture, vtkImageData& canvas, int left, int bottom) {
    const int* size = picture.GetDimensions();
    for (int y = 0; y < size[1]; ++y) {
        std::memcpy(canvas.GetScalarPointer(left, bottom + y, 0), picture.GetScalarPointer(0, y, 0),
                    static_cast<std::size_t>(3) * size[0]);
    }
}

}  // namespace

std::optional<std::string> missing_for_pictures() {
    try {
        const VirtualDisplay display;
    } catch (const FileError& error) {
        return error.what();
    }
    return std::nullopt;
}

Matrix<3> view_axes(const Scene& scene) {
    Matrix<3> axes;
    axes.col(2) = -scene.view_direction.normalized();
    axes.col(0) = scene.up.cross(axes.col(2)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

Vector2 label_size(const std::string& text) {
    // Most letters of the font are narrower.
    constexpr double letter = 0.56;
    return {letter * text_size * static_cast<double>(text.size()), 1.2 * text_size};
}

void render_png(const std::filesystem::path& path, const Scene& scene) {
    check_scene(scene);
    const VirtualDisplay display;
    write_png(path, *draw(scene));
}

void render_png(const std::filesystem::path& path, const std::vector<std::vector<Scene>>& rows) {
    int width = 0;
    int height = 0;
    for (const std::vector<Scene>& row : rows) {
        std::for_each(row.begin(), row.end(), check_scene);
        width = std::max(width, row_width(row));
        height += row_height(row);
    }
    if (width == 0) {
        throw InputError("render_png: {} rows without a scene; nothing to show", rows.size());
    }
    const VirtualDisplay display;
    vtkNew<vtkImageData> canvas;
    canvas->SetDimensions(width, height, 1);
    canvas->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    std::memset(canvas->GetScalarPointer(), 255, static_cast<std::size_t>(3) * width * height);
    int top = height;
    for (const std::vector<Scene>& row : rows) {
        int left = (width - row_width(row)) / 2;
        for (const Scene& scene : row) {
            const int bottom = top - (row_height(row) + scene.height) / 2;
            paste(*draw(scene), *canvas, left, bottom);
            left += scene.width;
        }
        top -= row_height(row);
    }
    write_png(path, *canvas);
}

}  // namespace couture::io
