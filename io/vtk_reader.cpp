#include "io/vtk_reader.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkStringOutputWindow.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "iga/core/error.h"
#include "io/atomic_file.h"

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

/// Takes what VTK would print of errors while it lives; several of its objects report no other way.
class CapturedMessages {
  public:
    CapturedMessages() : previous_(vtkOutputWindow::GetInstance()) {
        vtkOutputWindow::SetInstance(window_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    }
    ~CapturedMessages() {
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
        vtkOutputWindow::SetInstance(previous_);
    }
    CapturedMessages(const CapturedMessages&) = delete;
    CapturedMessages& operator=(const CapturedMessages&) = delete;

    [[nodiscard]] std::string text() { return window_->GetOutput(); }

  private:
    vtkSmartPointer<vtkOutputWindow> previous_;
    vtkNew<vtkStringOutputWindow> window_;
};

/// The first message without the place in VTK's sources: "ERROR: In F, line N\nCLASS (ADDRESS):
/// ...".
std::string first_sentence(const std::string& messages) {
    const std::size_t start = messages.find("): ");
    if (start == std::string::npos) {
        return "nothing";
    }
    const std::string text = messages.substr(start + 3, messages.find("\n\n", start) - start - 3);
    return text.substr(0, text.find_last_not_of(" \n\t.") + 1);
}

}  // namespace

VtuMesh read_vtu(const std::filesystem::path& path) {
    const std::string beginning = read_text(path).substr(0, 4096);
    if (beginning.find("<VTKFile") == std::string::npos ||
        beginning.find("UnstructuredGrid") == std::string::npos) {
        throw FileError("{}: not a VTK XML file of an unstructured grid (.vtu)", path.string());
    }
    CapturedMessages messages;
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    if (!messages.text().empty() || reader->GetErrorCode() != 0) {
        throw FileError("{}: can't be read as VTK XML, perhaps it was cut off; VTK says: {}",
                        path.string(), first_sentence(messages.text()));
    }

    vtkUnstructuredGrid& grid = *reader->GetOutput();
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
