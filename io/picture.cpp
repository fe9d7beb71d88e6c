#include "io/picture.h"

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkLightKit.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/virtual_display.h"

namespace couture::io {

namespace {

/// Everything is drawn this much larger and averaged down: smooth lines on any driver.
constexpr int oversampling = 2;
constexpr int n_colors = 256;
constexpr double crease_angle_degrees = 40.0;
/// Heights of text at 900 pixels of picture height.
constexpr double title_size = 26.0;
constexpr double text_size = 19.0;
/// Part of the width that the colour bar takes.
constexpr double legend_width = 0.16;
/// Room around the shape, relative to it.
constexpr double margin = 1.06;
constexpr Color text_color{0.13, 0.15, 0.18};
constexpr Color missing_color{0.6, 0.6, 0.6};

using Range = std::array<double, 2>;
/// Values that differ by less, relative to their size, are shown as one.
constexpr double uniform = 1e-6;

void check_piece(const char* kind, std::size_t i, const MatrixX& points) {
    if (points.rows() == 0 || points.cols() != 3 || !points.allFinite()) {
        throw InputError(
            "render_png: the points of {} {} are {} x {}; expected n x 3 finite coordinates", kind,
            i, points.rows(), points.cols());
    }
}

void check_input(const Scene& scene) {
    if (scene.surfaces.empty() && scene.curves.empty()) {
        throw InputError("render_png: the scene has no surface and no curve; nothing to show");
    }
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        const SurfacePiece& piece = scene.surfaces[i];
        check_piece("surface", i, piece.vertices);
        const Eigen::Index n = piece.vertices.rows();
        if (piece.triangles.size() > 0 &&
            (piece.triangles.cols() != 3 || piece.triangles.minCoeff() < 0 ||
             piece.triangles.maxCoeff() >= n)) {
            throw InputError(
                "render_png: the triangles of surface {} are m x {} with vertices {} to {}; "
                "expected m x 3 and 0 to {}",
                i, piece.triangles.cols(), piece.triangles.minCoeff(), piece.triangles.maxCoeff(),
                n - 1);
        }
        if (piece.values.size() != 0 && piece.values.size() != n) {
            throw InputError("render_png: surface {} has {} values for {} vertices", i,
                             piece.values.size(), n);
        }
    }
    for (std::size_t i = 0; i < scene.curves.size(); ++i) {
        check_piece("curve", i, scene.curves[i].points);
    }
    if (!(scene.view_direction.cross(scene.up).norm() >
          1e-6 * scene.view_direction.norm() * scene.up.norm())) {
        throw InputError(
            "render_png: view direction ({}, {}, {}) and up ({}, {}, {}) must be independent",
            scene.view_direction[0], scene.view_direction[1], scene.view_direction[2], scene.up[0],
            scene.up[1], scene.up[2]);
    }
    if (scene.frame && !(scene.frame->center.allFinite() && scene.frame->height > 0.0 &&
                         std::isfinite(scene.frame->height))) {
        throw InputError(
            "render_png: the frame has its centre at ({}, {}) and is {} high; the centre must be "
            "finite and the height positive",
            scene.frame->center[0], scene.frame->center[1], scene.frame->height);
    }
    if (scene.text_scale && !(*scene.text_scale > 0.0 && *scene.text_scale < 100.0)) {
        throw InputError("render_png: text_scale = {}; must be positive and below 100",
                         *scene.text_scale);
    }
    constexpr int largest = 8192;
    if (std::min(scene.width, scene.height) < 16 || std::max(scene.width, scene.height) > largest) {
        throw InputError("render_png: size {} x {}; each must be from 16 to {} pixels", scene.width,
                         scene.height, largest);
    }
}

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

vtkSmartPointer<vtkPoints> make_points(const MatrixX& rows) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(rows.rows());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        points->SetPoint(i, rows(i, 0), rows(i, 1), rows(i, 2));
    }
    return points;
}

vtkSmartPointer<vtkLookupTable> make_color_table(const Range& range) {
    vtkNew<vtkLookupTable> table;
    table->SetNumberOfTableValues(n_colors);
    for (int i = 0; i < n_colors; ++i) {
        const Color color = viridis(i / (n_colors - 1.0));
        table->SetTableValue(i, color[0], color[1], color[2]);
    }
    table->SetNanColor(missing_color[0], missing_color[1], missing_color[2], 1.0);
    // A constant field takes the colour of the middle.
    const double half = range[0] == range[1] ? std::max(std::abs(range[0]), 1.0) : 0.0;
    table->SetTableRange(range[0] - half, range[1] + half);
    return table;
}

void add_surface(vtkRenderer& renderer, const SurfacePiece& piece, const Range& range) {
    vtkNew<vtkPolyData> mesh;
    mesh->SetPoints(make_points(piece.vertices));
    vtkNew<vtkCellArray> triangles;
    for (Eigen::Index i = 0; i < piece.triangles.rows(); ++i) {
        const std::array<vtkIdType, 3> ids{piece.triangles(i, 0), piece.triangles(i, 1),
                                           piece.triangles(i, 2)};
        triangles->InsertNextCell(3, ids.data());
    }
    mesh->SetPolys(triangles);
    if (piece.values.size() > 0) {
        vtkNew<vtkDoubleArray> values;
        values->SetNumberOfTuples(piece.values.size());
        std::copy(piece.values.begin(), piece.values.end(), values->GetPointer(0));
        mesh->GetPointData()->SetScalars(values);
    }
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(mesh);
    normals->SetFeatureAngle(crease_angle_degrees);
    normals->ConsistencyOff();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(normals->GetOutputPort());
    mapper->SetScalarVisibility(piece.values.size() > 0);
    mapper->SetLookupTable(make_color_table(range));
    mapper->UseLookupTableScalarRangeOn();
    mapper->InterpolateScalarsBeforeMappingOn();
    // Lines lie on surfaces: these step back a little.
    mapper->SetResolveCoincidentTopologyToPolygonOffset();
    mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkProperty& look = *actor->GetProperty();
    look.SetColor(piece.color[0], piece.color[1], piece.color[2]);
    look.SetOpacity(piece.opacity);
    look.SetInterpolationToPhong();
    look.SetAmbient(0.42);
    look.SetDiffuse(0.62);
    look.SetSpecular(0.10);
    look.SetSpecularPower(25.0);
    renderer.AddActor(actor);
}

void add_curve(vtkRenderer& renderer, const CurvePiece& piece, double scale) {
    vtkNew<vtkPolyData> mesh;
    mesh->SetPoints(make_points(piece.points));
    vtkNew<vtkCellArray> lines;
    const vtkIdType n = piece.points.rows();
    lines->InsertNextCell(static_cast<int>(piece.is_closed ? n + 1 : n));
    for (vtkIdType i = 0; i < (piece.is_closed ? n + 1 : n); ++i) {
        lines->InsertCellPoint(i % n);
    }
    mesh->SetLines(lines);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(mesh);
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkNew<vtkProperty> look;
    look->SetColor(piece.color[0], piece.color[1], piece.color[2]);
    look->SetLineWidth(static_cast<float>(piece.width * scale));
    look->LightingOff();
    actor->SetProperty(look);
    renderer.AddActor(actor);
}

vtkSmartPointer<vtkTextActor> make_text(const std::string& text, double size) {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    actor->SetTextScaleModeToNone();
    vtkTextProperty& look = *actor->GetTextProperty();
    look.SetFontFamilyToArial();
    look.SetLineSpacing(1.25);
    look.SetFontSize(static_cast<int>(std::lround(size)));
    look.SetColor(text_color[0], text_color[1], text_color[2]);
    return actor;
}

void add_label(vtkRenderer& renderer, const Label& label, double size) {
    const vtkSmartPointer<vtkTextActor> actor = make_text(label.text, size);
    actor->GetPositionCoordinate()->SetCoordinateSystemToWorld();
    actor->GetPositionCoordinate()->SetValue(label.position[0], label.position[1],
                                             label.position[2]);
    vtkTextProperty& look = *actor->GetTextProperty();
    look.SetJustificationToCentered();
    look.SetVerticalJustificationToCentered();
    look.SetOrientation(label.angle * 180.0 / std::numbers::pi);
    if (label.has_background) {
        look.SetBackgroundColor(1.0, 1.0, 1.0);
        look.SetBackgroundOpacity(1.0);
    }
    renderer.AddActor2D(actor);
}

/// A filled rectangle strip of `colors` from bottom to top, in pixels.
void add_color_bar(vtkRenderer& renderer, double left, double bottom, double width, double height) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> quads;
    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetNumberOfComponents(3);
    for (int i = 0; i <= n_colors; ++i) {
        const double y = bottom + height * i / n_colors;
        points->InsertNextPoint(left, y, 0.0);
        points->InsertNextPoint(left + width, y, 0.0);
        if (i < n_colors) {
            const std::array<vtkIdType, 4> ids{2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2};
            quads->InsertNextCell(4, ids.data());
            const Color color = viridis(i / (n_colors - 1.0));
            colors->InsertNextTuple3(255 * color[0], 255 * color[1], 255 * color[2]);
        }
    }
    vtkNew<vtkPolyData> mesh;
    mesh->SetPoints(points);
    mesh->SetPolys(quads);
    mesh->GetCellData()->SetScalars(colors);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(mesh);
    vtkNew<vtkActor2D> actor;
    actor->SetMapper(mapper);
    renderer.AddActor2D(actor);
}

void add_tick(vtkRenderer& renderer, double left, double right, double y, double width) {
    vtkNew<vtkPoints> points;
    points->InsertNextPoint(left, y, 0.0);
    points->InsertNextPoint(right, y, 0.0);
    vtkNew<vtkCellArray> lines;
    const std::array<vtkIdType, 2> ids{0, 1};
    lines->InsertNextCell(2, ids.data());
    vtkNew<vtkPolyData> mesh;
    mesh->SetPoints(points);
    mesh->SetLines(lines);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(mesh);
    vtkNew<vtkActor2D> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(text_color[0], text_color[1], text_color[2]);
    actor->GetProperty()->SetLineWidth(static_cast<float>(width));
    renderer.AddActor2D(actor);
}

/// Puts text at pixel (x, y); vertically centred there.
void add_text(vtkRenderer& renderer, const std::string& text, double size, double x, double y) {
    const vtkSmartPointer<vtkTextActor> actor = make_text(text, size);
    actor->GetTextProperty()->SetVerticalJustificationToCentered();
    actor->SetPosition(x, y);
    renderer.AddActor2D(actor);
}

/// `scale`: pixels per pixel of a picture 900 high.
void add_legend(vtkRenderer& renderer, const Scene& scene, const Range& range, int width,
                int height, double scale) {
    const double left = (1.0 - legend_width) * width;
    const double bottom = 0.2 * height;
    const double bar_width = 24.0 * scale;
    const double bar_height = 0.6 * height;
    add_color_bar(renderer, left, bottom, bar_width, bar_height);
    for (const double value : round_ticks(range[0], range[1])) {
        const double t = range[0] == range[1] ? 0.5 : (value - range[0]) / (range[1] - range[0]);
        const double y = bottom + t * bar_height;
        add_tick(renderer, left + bar_width, left + bar_width + 6.0 * scale, y, 1.5 * scale);
        add_text(renderer, fmt::format("{:.6g}", value), text_size * scale,
                 left + bar_width + 12.0 * scale, y);
    }
    add_text(renderer, scene.legend, text_size * scale, left,
             bottom + bar_height + 1.6 * text_size * scale);
    if (range[0] != range[1]) {
        add_text(renderer, fmt::format("max {:.4g}\nmin {:.4g}", range[1], range[0]),
                 0.85 * text_size * scale, left, bottom - 2.0 * text_size * scale);
    }
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

Color viridis(double t) {
    constexpr std::array<std::array<int, 3>, 11> stops{{{68, 1, 84},
                                                        {72, 36, 117},
                                                        {65, 68, 135},
                                                        {53, 95, 141},
                                                        {42, 120, 142},
                                                        {33, 145, 140},
                                                        {34, 168, 132},
                                                        {68, 191, 112},
                                                        {122, 209, 81},
                                                        {189, 223, 38},
                                                        {253, 231, 37}}};
    const double x = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), stops.size() - 2);
    const double part = x - static_cast<double>(i);
    Color color{};
    for (int c = 0; c < 3; ++c) {
        color[c] = ((1.0 - part) * stops[i][c] + part * stops[i + 1][c]) / 255.0;
    }
    return color;
}

Color part_color(int i) {
    constexpr std::array<Color, 8> colors{{{0.62, 0.74, 0.85},
                                           {0.94, 0.78, 0.58},
                                           {0.67, 0.81, 0.64},
                                           {0.86, 0.67, 0.68},
                                           {0.76, 0.70, 0.85},
                                           {0.93, 0.88, 0.62},
                                           {0.62, 0.82, 0.80},
                                           {0.80, 0.76, 0.71}}};
    return colors[static_cast<std::size_t>(i) % colors.size()];
}

std::vector<double> round_ticks(double low, double high) {
    if (!(high > low)) {
        return {low};
    }
    constexpr double wanted = 6.0;
    const double power = std::pow(10.0, std::floor(std::log10((high - low) / wanted)));
    double step = 10.0 * power;
    for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
        if ((high - low) / (factor * power) <= wanted) {
            step = factor * power;
            break;
        }
    }
    // Ends count although rounding may put them just outside.
    const double slack = 1e-9 * (high - low) / step;
    std::vector<double> ticks;
    for (double i = std::ceil(low / step - slack); i <= high / step + slack; i += 1.0) {
        ticks.push_back(i == 0.0 ? 0.0 : i * step);
    }
    return ticks;
}

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
    check_input(scene);
    const VirtualDisplay display;
    write_png(path, *draw(scene));
}

void render_png(const std::filesystem::path& path, const std::vector<std::vector<Scene>>& rows) {
    int width = 0;
    int height = 0;
    for (const std::vector<Scene>& row : rows) {
        std::for_each(row.begin(), row.end(), check_input);
        width = std::max(width, row_width(row));
        height += row_height(row);
    }
    if (width == 0) {
        throw InputError("render_png: {} rows without a scene; nothing to show", rows.size());
    }
    const VirtualDisplay display;
    // The display ends with its last window: this one outlives those of the scenes.
    vtkNew<vtkRenderWindow> first;
    first->SetOffScreenRendering(1);
    first->SetSize(1, 1);
    first->Render();
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
