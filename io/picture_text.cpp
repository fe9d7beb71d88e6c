#include "io/picture_text.h"

#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <numbers>

namespace couture::io {

namespace {

constexpr Color text_color{0.13, 0.15, 0.18};

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

}  // namespace

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

void add_text(vtkRenderer& renderer, const std::string& text, double size, double x, double y) {
    const vtkSmartPointer<vtkTextActor> actor = make_text(text, size);
    actor->GetTextProperty()->SetVerticalJustificationToCentered();
    actor->SetPosition(x, y);
    renderer.AddActor2D(actor);
}

void add_legend(vtkRenderer& renderer, const Scene& scene, const std::array<double, 2>& range,
                int width, int height, double scale) {
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

}  // namespace couture::io
