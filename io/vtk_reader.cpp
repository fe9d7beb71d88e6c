#include "io/vtk_reader.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <fstream>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/vtk_messages.h"

namespace couture::io {

namespace {

MatrixX rows_of(vtkDataArray& array) {
    MatrixX rows(array.GetNumberOfTuples(), array.GetNumberOfComponents());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        for (Eigen::Index j = 0; j < rows.cols(); ++j) {
            rows(i, j) = array.GetComponent(i, static_cast<int>(j));
        }
    }
    return rows;
}

std::vector<NamedRows> arrays_of(vtkFieldData& data) {
    std::vector<NamedRows> arrays;
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
        if (vtkDataArray* array = data.GetArray(i); array != nullptr) {
            const char* name = array->GetName();
            arrays.push_back({name == nullptr ? "" : name, rows_of(*array)});
        }
    }
    return arrays;
}

template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& path) {
    VtkMessages messages;
    vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    if (messages.has_any() || reader->GetErrorCode() != 0) {
        throw FileError("{}: can't be read as VTK XML, perhaps it was cut off; VTK says: {}",
                        path.string(), messages.first());
    }
    return reader->GetOutput();
}

/// Enough to know the file's kind.
std::string read_beginning(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) {
        return read_text(path);  // says why it can't be read
    }
    std::string text(4096, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

}  // namespace

VtuMesh read_vtu(const std::filesystem::path& path) {
    const std::string beginning = read_beginning(path);
    if (beginning.find("<VTKFile") == std::string::npos ||
        beginning.find("UnstructuredGrid") == std::string::npos) {
        throw FileError("{}: not a VTK XML file of an unstructured grid (.vtu)", path.string());
    }
    const bool is_in_pieces = beginning.find("PUnstructuredGrid") != std::string::npos;
    const vtkSmartPointer<vtkUnstructuredGrid> output =
        is_in_pieces ? read_grid<vtkXMLPUnstructuredGridReader>(path)
                     : read_grid<vtkXMLUnstructuredGridReader>(path);
    vtkUnstructuredGrid& grid = *output;
    VtuMesh mesh;
    if (grid.GetNumberOfPoints() > 0) {
        mesh.points = rows_of(*grid.GetPoints()->GetData());
    }
    vtkNew<vtkIdList> ids;
    for (vtkIdType i = 0; i < grid.GetNumberOfCells(); ++i) {
        grid.GetCellPoints(i, ids);
        mesh.cell_types.push_back(grid.GetCellType(i));
        mesh.cells.emplace_back(ids->begin(), ids->end());
    }
    mesh.point_arrays = arrays_of(*grid.GetPointData());
    mesh.cell_arrays = arrays_of(*grid.GetCellData());
    vtkFieldData& field_data = *grid.GetFieldData();
    if (auto* text = vtkStringArray::SafeDownCast(field_data.GetAbstractArray("provenance"));
        text != nullptr && text->GetNumberOfValues() > 0) {
        mesh.provenance = text->GetValue(0);
    }
    return mesh;
}

}  // namespace couture::io
