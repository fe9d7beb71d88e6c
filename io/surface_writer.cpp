#include "io/surface_writer.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/vtk_messages.h"

namespace couture::io {

namespace {

// Rows of an array behind `n_before` rows of NaN, `n_after` more behind them.
void add_array(vtkFieldData& data, const SurfaceArray& array, vtkIdType n_rows, vtkIdType n_before,
               vtkIdType n_after, const char* where) {
    const auto n_columns = static_cast<int>(array.values.cols());
    if (array.values.rows() != n_rows || (n_columns != 1 && n_columns != 3)) {
        throw InputError(
            "write_vtp: array '{}' is {} x {}; there are {} {}, and 1 or 3 components are taken",
            array.name, array.values.rows(), n_columns, n_rows, where);
    }
    vtkNew<vtkDoubleArray> column;
    column->SetName(array.name.c_str());
    column->SetNumberOfComponents(n_columns);
    column->SetNumberOfTuples(n_before + n_rows + n_after);
    column->Fill(std::numeric_limits<double>::quiet_NaN());
    for (vtkIdType i = 0; i < n_rows; ++i) {
        for (int k = 0; k < n_columns; ++k) {
            column->SetTypedComponent(n_before + i, k, array.values(i, k));
        }
    }
    data.AddArray(column);
}

template <int n>
void add_cells(vtkCellArray& cells, const std::vector<std::array<int, n>>& numbers,
               vtkIdType n_points) {
    for (const auto& cell : numbers) {
        const auto [low, high] = std::minmax_element(cell.begin(), cell.end());
        if (*low < 0 || *high >= n_points) {
            throw InputError("write_vtp: a {} has vertex {}; there are {} points",
                             n == 3 ? "triangle" : "quad", *low < 0 ? *low : *high, n_points);
        }
        std::array<vtkIdType, n> ids{};
        std::copy(cell.begin(), cell.end(), ids.begin());
        cells.InsertNextCell(n, ids.data());
    }
}

void write_polydata(const std::filesystem::path& path, vtkPolyData& data,
                    const std::string& provenance) {
    if (!provenance.empty()) {
        vtkNew<vtkStringArray> text;
        text->SetName("provenance");
        text->InsertNextValue(provenance);
        data.GetFieldData()->AddArray(text);
    }
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        // Tried first because VTK does not pass the system's reason on.
        if (!std::ofstream(temporary)) {
            throw FileError("{}: can't be written: {}", path.string(), std::strerror(errno));
        }
        const VtkMessages messages;
        vtkNew<vtkXMLPolyDataWriter> writer;
        writer->SetFileName(temporary.c_str());
        writer->SetInputData(&data);
        writer->SetDataModeToAppended();
        writer->EncodeAppendedDataOff();
        writer->SetCompressorTypeToZLib();
        writer->SetHeaderTypeToUInt64();
        if (writer->Write() == 0 || writer->GetErrorCode() != vtkErrorCode::NoError) {
            throw FileError("{}: can't be written: {}", path.string(), messages.first());
        }
    });
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const meshing::TriangleSoup& surface,
               std::span<const SurfaceArray> on_points, std::span<const SurfaceArray> on_triangles,
               std::span<const SurfaceLine> lines, const std::string& provenance) {
    const auto n_points = static_cast<vtkIdType>(surface.points.size());
    vtkIdType n_line_points = 0;
    for (const SurfaceLine& line : lines) {
        n_line_points += static_cast<vtkIdType>(line.points.size());
    }
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(n_points + n_line_points);
    for (vtkIdType i = 0; i < n_points; ++i) points->SetPoint(i, surface.points[i].data());

    vtkNew<vtkCellArray> triangles;
    add_cells<3>(*triangles, surface.triangles, n_points);

    // Lines come before triangles in PolyData's order of cells.
    const auto n_lines = static_cast<vtkIdType>(lines.size());
    const auto n_triangles = static_cast<vtkIdType>(surface.triangles.size());
    vtkNew<vtkCellArray> polylines;
    vtkNew<vtkIntArray> kind;
    vtkNew<vtkIntArray> number;
    kind->SetName("kind");
    number->SetName("curve");
    vtkIdType next = n_points;
    for (const SurfaceLine& line : lines) {
        std::vector<vtkIdType> ids;
        for (const Vector3& point : line.points) {
            points->SetPoint(next, point.data());
            ids.push_back(next++);
        }
        if (line.is_closed && !ids.empty()) ids.push_back(ids.front());
        polylines->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
        kind->InsertNextValue(line.kind);
        number->InsertNextValue(line.number);
    }

    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(triangles);
    if (n_lines > 0) {
        data->SetLines(polylines);
        for (vtkIdType i = 0; i < n_triangles; ++i) {
            kind->InsertNextValue(-1);
            number->InsertNextValue(-1);
        }
        data->GetCellData()->AddArray(kind);
        data->GetCellData()->AddArray(number);
    }
    for (const SurfaceArray& array : on_points) {
        add_array(*data->GetPointData(), array, n_points, 0, n_line_points, "points");
    }
    for (const SurfaceArray& array : on_triangles) {
        add_array(*data->GetCellData(), array, n_triangles, n_lines, 0, "triangles");
    }
    write_polydata(path, *data, provenance);
}

void write_vtp(const std::filesystem::path& path, const meshing::QuadMesh& quads,
               const std::string& provenance) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Vector3& point : quads.points) points->InsertNextPoint(point.data());
    vtkNew<vtkCellArray> cells;
    add_cells<4>(*cells, quads.quads, points->GetNumberOfPoints());
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);
    write_polydata(path, *data, provenance);
}

void write_vtp(const std::filesystem::path& path, const RawSurface& polygons,
               std::span<const SurfaceArray> on_points, const std::string& provenance) {
    const auto n_points = static_cast<vtkIdType>(polygons.points.size());
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Vector3& point : polygons.points) points->InsertNextPoint(point.data());
    vtkNew<vtkCellArray> cells;
    for (std::size_t i = 0; i < polygons.n_polygons(); ++i) {
        cells->InsertNextCell(static_cast<int>(polygons.polygon(i).size()));
        for (const int vertex : polygons.polygon(i)) {
            if (vertex < 0 || vertex >= n_points) {
                throw InputError("write_vtp: polygon {} has vertex {}; there are {} points", i,
                                 vertex, n_points);
            }
            cells->InsertCellPoint(vertex);
        }
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);
    for (const SurfaceArray& array : on_points) {
        add_array(*data->GetPointData(), array, n_points, 0, 0, "points");
    }
    write_polydata(path, *data, provenance);
}

}  // namespace couture::io
