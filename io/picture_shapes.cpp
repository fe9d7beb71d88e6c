#include "io/picture_shapes.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>

namespace couture::io {

namespace {

constexpr double crease_angle_degrees = 40.0;
constexpr Color missing_color{0.6, 0.6, 0.6};

vtkSmartPointer<vtkPoints> make_points(const MatrixX& rows) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(rows.rows());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        points->SetPoint(i, rows(i, 0), rows(i, 1), rows(i, 2));
    }
    return points;
}

vtkSmartPointer<vtkLookupTable> make_color_table(const std::array<double, 2>& range) {
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

}  // namespace

void add_surface(vtkRenderer& renderer, const SurfacePiece& piece,
                 const std::array<double, 2>& range) {
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
    mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(2.0, 4.0);
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

}  // namespace couture::io
