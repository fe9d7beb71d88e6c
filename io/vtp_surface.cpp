#include "io/vtp_surface.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <charconv>
#include <exception>

#include "iga/core/error.h"
#include "io/vtk_messages.h"

namespace couture::io {

namespace {

/// VTK makes room for what the file announces.
void check_counts(const std::string& file, std::string_view bytes) {
    // The best that compression can do is about 1000 : 1.
    const double most = 1100.0 * static_cast<double>(bytes.size());
    for (const std::string_view name : {"NumberOfPoints", "NumberOfVerts", "NumberOfLines",
                                        "NumberOfStrips", "NumberOfPolys", "NumberOfTuples"}) {
        for (std::size_t at = bytes.find(name); at != std::string_view::npos;
             at = bytes.find(name, at + 1)) {
            const std::size_t digits = bytes.find_first_not_of("= \t\r\n\"'", at + name.size());
            if (digits == std::string_view::npos) return;
            double count = 0.0;
            std::from_chars(bytes.data() + digits, bytes.data() + bytes.size(), count);
            if (count > most || count < 0.0) {
                throw FileError("{}: byte {}: found {} {}; a file of {} bytes cannot hold so many",
                                file, at, name, count, bytes.size());
            }
        }
    }
}

/// The cells of an array whose numbers are checked.
std::vector<std::vector<int>> read_cells(const std::string& file, vtkCellArray& cells,
                                         const char* what, vtkIdType n_points) {
    std::vector<std::vector<int>> result;
    vtkDataArray& offsets = *cells.GetOffsetsArray();
    vtkDataArray& corners = *cells.GetConnectivityArray();
    const vtkIdType n_corners = corners.GetNumberOfValues();
    double begin = 0.0;
    for (vtkIdType i = 0; i < offsets.GetNumberOfValues(); ++i) {
        const double end = offsets.GetComponent(i, 0);
        if (end < begin || end > static_cast<double>(n_corners)) {
            throw FileError("{}: {} {} ends at corner {}; expected from {} to {}", file, what,
                            i - 1, end, begin, n_corners);
        }
        if (i > 0) {
            std::vector<int>& cell = result.emplace_back();
            for (auto k = static_cast<vtkIdType>(begin); k < static_cast<vtkIdType>(end); ++k) {
                const double number = corners.GetComponent(k, 0);
                if (number < 0.0 || number >= static_cast<double>(n_points)) {
                    throw FileError("{}: {} {} has point {}; expected from 0 to {}", file, what,
                                    i - 1, number, n_points - 1);
                }
                cell.push_back(static_cast<int>(number));
            }
        }
        begin = end;
    }
    return result;
}

}  // namespace

RawSurface read_vtp(const std::filesystem::path& path, std::string_view bytes) {
    const std::string file = path.string();
    if (bytes.substr(0, std::min<std::size_t>(bytes.size(), 4096)).find("VTKFile") ==
        std::string_view::npos) {
        throw FileError("{}: found no 'VTKFile'; expected a VTK XML file of PolyData", file);
    }
    check_counts(file, bytes);
    const VtkMessages messages;
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    try {
        reader->Update();
    } catch (const std::exception& error) {
        throw FileError("{}: can't be read: {}", file, error.what());
    }
    if (messages.has_any() || reader->GetErrorCode() != vtkErrorCode::NoError) {
        throw FileError("{}: VTK can't read it: {}", file, messages.first());
    }
    vtkPolyData& data = *reader->GetOutput();
    RawSurface surface;
    const vtkIdType n_points = data.GetNumberOfPoints();
    for (vtkIdType i = 0; i < n_points; ++i) {
        Vector3& point = surface.points.emplace_back();
        data.GetPoints()->GetPoint(i, point.data());
        if (!point.allFinite()) {
            throw FileError("{}: point {} is ({}, {}, {}); expected finite numbers", file, i,
                            point.x(), point.y(), point.z());
        }
    }
    for (const auto& polygon : read_cells(file, *data.GetPolys(), "polygon", n_points)) {
        surface.add_polygon(polygon);
    }
    for (const auto& strip : read_cells(file, *data.GetStrips(), "strip", n_points)) {
        for (std::size_t k = 2; k < strip.size(); ++k) {
            const bool is_odd = k % 2 == 1;
            surface.add_polygon(
                std::array{strip[k - 2], strip[is_odd ? k : k - 1], strip[is_odd ? k - 1 : k]});
        }
    }
    return surface;
}

}  // namespace couture::io
