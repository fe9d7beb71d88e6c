#include "io/vtk_writer.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkHigherOrderHexahedron.h>
#include <vtkHigherOrderQuadrilateral.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <Eigen/LU>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "io/atomic_file.h"
#include "io/sample_matrix.h"
#include "io/vtk_messages.h"

namespace couture::io {

using iga::KnotVector;
using iga::Patch;
using iga::Space;

namespace {

/// Points of one patch: a grid of n_elements * order + 1 nodes per direction, of which each cell
/// takes order + 1. Nodes are Bezier control points (order: the degree) or samples (order 1).
template <int d>
struct NodeGrid {
    std::array<int, d> order;
    std::array<int, d> n_cells;
    /// From homogeneous coefficients on the geometry's and on the space's functions to the nodes.
    std::array<SparseMatrix, d> from_geometry;
    std::array<SparseMatrix, d> from_space;

    [[nodiscard]] vtkIdType n_nodes() const {
        vtkIdType n = 1;
        for (int k = 0; k < d; ++k) {
            n *= n_cells[k] * order[k] + 1;
        }
        return n;
    }
    [[nodiscard]] vtkIdType count_cells() const {
        vtkIdType n = 1;
        for (int k = 0; k < d; ++k) {
            n *= n_cells[k];
        }
        return n;
    }
};

/// The functions of each element by itself: all breakpoints repeated `degree` times.
KnotVector bezier_knots(const std::vector<double>& breakpoints, int degree) {
    std::vector<double> knots(1, breakpoints.front());
    for (const double xi : breakpoints) {
        knots.insert(knots.end(), degree, xi);
    }
    knots.push_back(breakpoints.back());
    return {degree, std::move(knots)};
}

template <int d>
NodeGrid<d> make_node_grid(const Space<d>& space, int i_patch, const VtuOptions& options) {
    const Patch<d>& patch = space.geometry().patches[i_patch];
    NodeGrid<d> grid;
    for (int k = 0; k < d; ++k) {
        const KnotVector& field_knots = space.tensor(i_patch).knots[k];
        const KnotVector& patch_knots = patch.knots(k);
        const std::vector<double>& breakpoints = field_knots.breakpoints();
        if (options.linear) {
            const std::vector<double> xi = sample_parameters(breakpoints, options.samples);
            grid.order[k] = 1;
            grid.n_cells[k] = static_cast<int>(xi.size()) - 1;
            grid.from_geometry[k] = sample_matrix(patch_knots, xi);
            grid.from_space[k] = sample_matrix(field_knots, xi);
        } else {
            grid.order[k] = std::max(patch_knots.degree(), field_knots.degree());
            grid.n_cells[k] = field_knots.n_elements();
            const KnotVector bezier = bezier_knots(breakpoints, grid.order[k]);
            grid.from_geometry[k] = iga::prolongation_to(patch_knots, bezier).prolongation;
            grid.from_space[k] = iga::prolongation_to(field_knots, bezier).prolongation;
        }
    }
    return grid;
}

/// True if det J is negative on the whole (the mean over a few points); surfaces in space have no
/// hand.
template <int d>
bool is_left_handed(const Patch<d>& patch) {
    if (patch.dimension() != d) {
        return false;
    }
    constexpr int n_points = 3;
    const int n_all = d == 3 ? n_points * n_points * n_points : n_points * n_points;
    double sum = 0.0;
    for (int i = 0; i < n_all; ++i) {
        Vector<d> xi;
        int rest = i;
        for (int k = 0; k < d; ++k) {
            const double t = (rest % n_points + 0.5) / n_points;
            xi[k] = (1.0 - t) * patch.knots(k).front() + t * patch.knots(k).back();
            rest /= n_points;
        }
        const Matrix<d> J = patch.jacobian(xi);
        sum += J.determinant();
    }
    return sum < 0.0;
}

int cell_type(int d, bool linear) {
    if (d == 2) {
        return linear ? VTK_QUAD : VTK_BEZIER_QUADRILATERAL;
    }
    return linear ? VTK_HEXAHEDRON : VTK_BEZIER_HEXAHEDRON;
}

/// Place in VTK's cell (corners, edges, faces, interior) of each node of a cell, which are numbered
/// with the first direction fastest.
template <int d>
std::vector<int> cell_node_order(const std::array<int, d>& order) {
    std::vector<int> places;
    for (int k = 0; k <= (d == 3 ? order[d - 1] : 0); ++k) {
        for (int j = 0; j <= order[1]; ++j) {
            for (int i = 0; i <= order[0]; ++i) {
                places.push_back(
                    d == 3 ? vtkHigherOrderHexahedron::PointIndexFromIJK(i, j, k, order.data())
                           : vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, order.data()));
            }
        }
    }
    return places;
}

/// Adds the cells of one patch, whose nodes start at `first_node`.
template <int d>
void append_cells(const NodeGrid<d>& grid, vtkIdType first_node, bool is_reversed,
                  vtkCellArray& cells) {
    const std::vector<int> places = cell_node_order<d>(grid.order);
    std::vector<vtkIdType> ids(places.size());
    for (vtkIdType i_cell = 0; i_cell < grid.count_cells(); ++i_cell) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            vtkIdType node = 0;
            vtkIdType stride = 1;
            vtkIdType rest_cell = i_cell;
            int rest = static_cast<int>(i);
            for (int k = 0; k < d; ++k) {
                const int n = grid.order[k] + 1;
                int local = rest % n;
                if (k == 0 && is_reversed) {
                    local = grid.order[k] - local;
                }
                node += stride * (rest_cell % grid.n_cells[k] * grid.order[k] + local);
                stride *= grid.n_cells[k] * grid.order[k] + 1;
                rest /= n;
                rest_cell /= grid.n_cells[k];
            }
            ids[places[i]] = first_node + node;
        }
        cells.InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    }
}

/// Adds an array with room for `n_tuples` rows; 2 components become 3, unset ones are 0.
vtkDoubleArray& add_array(vtkFieldData& data, const PointArray& array, vtkIdType n_tuples) {
    vtkNew<vtkDoubleArray> values;
    const int n_components = static_cast<int>(array.coefficients.cols());
    values->SetName(array.name.c_str());
    values->SetNumberOfComponents(n_components == 2 ? 3 : n_components);
    values->SetNumberOfTuples(n_tuples);
    values->Fill(0.0);
    for (std::size_t i = 0; i < array.components.size(); ++i) {
        values->SetComponentName(static_cast<vtkIdType>(i), array.components[i].c_str());
    }
    data.AddArray(values);
    return *values;
}

void set_rows(vtkDoubleArray& array, vtkIdType first, const MatrixX& rows) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        for (Eigen::Index j = 0; j < rows.cols(); ++j) {
            array.SetComponent(first + i, static_cast<int>(j), rows(i, j));
        }
    }
}

void check_name(const std::string& name, std::set<std::string>& taken) {
    if (name.empty()) {
        throw InputError("write_vtu: an array has no name");
    }
    if (!taken.insert(name).second) {
        throw InputError("write_vtu: the array name '{}' is taken or reserved; choose another",
                         name);
    }
}

void check_point_arrays(std::span<const PointArray> arrays, Eigen::Index n_rows, const char* unit,
                        std::set<std::string>& taken) {
    for (const PointArray& array : arrays) {
        check_name(array.name, taken);
        const MatrixX& rows = array.coefficients;
        if (rows.rows() != n_rows || rows.cols() == 0) {
            throw InputError(
                "write_vtu: array '{}' is {} x {}; expected {} rows, one per {}, and at least one "
                "column",
                array.name, rows.rows(), rows.cols(), n_rows, unit);
        }
        if (!array.components.empty() &&
            static_cast<Eigen::Index>(array.components.size()) != rows.cols()) {
            throw InputError("write_vtu: array '{}' has {} columns but {} component names",
                             array.name, rows.cols(), array.components.size());
        }
    }
}

template <int d>
void check_input(const Space<d>& space, std::span<const PointArray> points,
                 std::span<const CellArray> cells, const VtuOptions& options) {
    std::set<std::string> taken{vtu_patch_array, vtu_weights_array, vtu_degrees_array};
    check_point_arrays(points, space.n_dofs(), "function of the space", taken);
    for (const CellArray& array : cells) {
        check_name(array.name, taken);
        if (array.values.size() != space.n_patches()) {
            throw InputError("write_vtu: cell array '{}' has {} values for {} patches; one each",
                             array.name, array.values.size(), space.n_patches());
        }
    }
    if (options.linear && options.samples < 1) {
        throw InputError("write_vtu: samples = {}; must be at least 1", options.samples);
    }
    for (int i = 0; i < space.n_patches() && !options.linear; ++i) {
        if (space.geometry().patches[i].is_rational() && space.weights(i).size() == 0) {
            throw InputError(
                "write_vtu: the space of patch {} does not contain the functions of its rational "
                "geometry, exact cells can't hold both; use a refinement of the geometry or "
                "linear cells",
                i);
        }
    }
}

void save(const std::filesystem::path& path, vtkUnstructuredGrid& grid,
          const std::string& provenance) {
    if (!provenance.empty()) {
        vtkNew<vtkStringArray> text;
        text->SetName("provenance");
        text->InsertNextValue(provenance);
        grid.GetFieldData()->AddArray(text);
    }
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        // Tried first because VTK does not pass the system's reason on.
        if (!std::ofstream(temporary)) {
            throw FileError("{}: can't be written: {}", path.string(), std::strerror(errno));
        }
        const VtkMessages messages;
        vtkNew<vtkXMLUnstructuredGridWriter> writer;
        writer->SetFileName(temporary.c_str());
        writer->SetInputData(&grid);
        writer->SetDataModeToAppended();
        writer->EncodeAppendedDataOff();
        writer->SetCompressorTypeToZLib();
        writer->SetHeaderTypeToUInt64();
        if (writer->Write() == 0 || writer->GetErrorCode() != vtkErrorCode::NoError) {
            const unsigned long code = writer->GetErrorCode();
            throw FileError("{}: can't be written: {}", path.string(),
                            code != vtkErrorCode::NoError
                                ? vtkErrorCode::GetStringFromErrorCode(code)
                                : messages.first());
        }
    });
}

/// Rows of the patch's functions, multiplied by their weights.
template <int d>
MatrixX homogeneous_rows(const Space<d>& space, int i_patch, const MatrixX& coefficients) {
    MatrixX rows = coefficients(space.dofs(i_patch), Eigen::all);
    if (space.weights(i_patch).size() > 0) {
        rows = space.weights(i_patch).asDiagonal() * rows;
    }
    return rows;
}

}  // namespace

template <int d>
void write_vtu(const std::filesystem::path& path, const Space<d>& space,
               std::span<const PointArray> points, std::span<const CellArray> cells,
               const VtuOptions& options) {
    check_input(space, points, cells, options);
    std::vector<NodeGrid<d>> grids;
    vtkIdType n_nodes = 0;
    vtkIdType n_cells = 0;
    for (int i = 0; i < space.n_patches(); ++i) {
        grids.push_back(make_node_grid(space, i, options));
        n_nodes += grids.back().n_nodes();
        n_cells += grids.back().count_cells();
    }

    vtkNew<vtkUnstructuredGrid> mesh;
    vtkNew<vtkPoints> positions;
    positions->SetDataTypeToDouble();
    positions->SetNumberOfPoints(n_nodes);
    vtkDoubleArray& x = *vtkDoubleArray::SafeDownCast(positions->GetData());
    x.Fill(0.0);
    std::vector<vtkDoubleArray*> fields;
    for (const PointArray& array : points) {
        fields.push_back(&add_array(*mesh->GetPointData(), array, n_nodes));
    }
    vtkNew<vtkDoubleArray> weights;
    weights->SetName(vtu_weights_array);
    weights->SetNumberOfTuples(n_nodes);
    weights->Fill(1.0);
    vtkNew<vtkDoubleArray> degrees;
    degrees->SetName(vtu_degrees_array);
    degrees->SetNumberOfComponents(3);
    vtkNew<vtkIntArray> patch_numbers;
    patch_numbers->SetName(vtu_patch_array);
    vtkNew<vtkCellArray> connectivity;
    std::vector<int> patch_of_cell;

    vtkIdType first_node = 0;
    bool is_rational = options.always_weights;
    for (int i = 0; i < space.n_patches(); ++i) {
        const NodeGrid<d>& grid = grids[i];
        const Patch<d>& patch = space.geometry().patches[i];
        const MatrixX nodes = iga::apply_kronecker<d>(grid.from_geometry, patch.homogeneous());
        const VectorX node_weights = nodes.col(patch.dimension());
        set_rows(x, first_node,
                 node_weights.cwiseInverse().asDiagonal() * nodes.leftCols(patch.dimension()));
        set_rows(*weights, first_node, node_weights);
        is_rational = is_rational || patch.is_rational();

        VectorX denominators = VectorX::Ones(nodes.rows());
        if (space.weights(i).size() > 0) {
            denominators = iga::apply_kronecker<d>(grid.from_space, space.weights(i));
        }
        for (std::size_t f = 0; f < fields.size(); ++f) {
            const MatrixX rows = iga::apply_kronecker<d>(
                grid.from_space, homogeneous_rows(space, i, points[f].coefficients));
            set_rows(*fields[f], first_node, denominators.cwiseInverse().asDiagonal() * rows);
        }

        append_cells(grid, first_node, is_left_handed(patch), *connectivity);
        for (vtkIdType c = 0; c < grid.count_cells(); ++c) {
            patch_of_cell.push_back(i);
            patch_numbers->InsertNextValue(
                options.patch_numbers.empty() ? i : options.patch_numbers[i]);
            degrees->InsertNextTuple3(grid.order[0], grid.order[1], d == 3 ? grid.order[d - 1] : 1);
        }
        first_node += grid.n_nodes();
    }
    mesh->SetPoints(positions);
    mesh->SetCells(cell_type(d, options.linear), connectivity);
    mesh->GetCellData()->AddArray(patch_numbers);
    for (const CellArray& array : cells) {
        PointArray per_cell{array.name, MatrixX(1, 1), {}};
        vtkDoubleArray& values = add_array(*mesh->GetCellData(), per_cell, n_cells);
        for (vtkIdType c = 0; c < n_cells; ++c) {
            values.SetValue(c, array.values[patch_of_cell[c]]);
        }
    }
    if (!options.linear) {
        mesh->GetCellData()->SetHigherOrderDegrees(degrees);
        if (is_rational) {
            mesh->GetPointData()->SetRationalWeights(weights);
        }
    }
    save(path, *mesh, options.provenance);
}

void write_points_vtu(const std::filesystem::path& path, const MatrixX& positions,
                      std::span<const PointArray> arrays, const std::string& provenance,
                      std::span<const std::vector<int>> cells) {
    if (positions.cols() != 2 && positions.cols() != 3) {
        throw InputError("write_points_vtu: points have {} coordinates; 2 or 3 are taken",
                         positions.cols());
    }
    const std::size_t n_corners = cells.empty() ? 4 : cells.front().size();
    for (const std::vector<int>& cell : cells) {
        const bool is_inside = std::all_of(cell.begin(), cell.end(), [&](int point) {
            return point >= 0 && point < positions.rows();
        });
        if ((n_corners != 4 && n_corners != 8) || cell.size() != n_corners || !is_inside) {
            throw InputError(
                "write_points_vtu: a cell has the points {}; all need 4, or all 8, of 0 to {}",
                fmt::join(cell, ", "), positions.rows() - 1);
        }
    }
    std::set<std::string> taken;
    check_point_arrays(arrays, positions.rows(), "point", taken);
    vtkNew<vtkUnstructuredGrid> mesh;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(positions.rows());
    vtkDoubleArray& x = *vtkDoubleArray::SafeDownCast(points->GetData());
    x.Fill(0.0);
    set_rows(x, 0, positions);
    vtkNew<vtkCellArray> list;
    for (vtkIdType i = 0; i < positions.rows() && cells.empty(); ++i) {
        list->InsertNextCell(1, &i);
    }
    for (const std::vector<int>& cell : cells) {
        const std::vector<vtkIdType> ids(cell.begin(), cell.end());
        list->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    }
    mesh->SetPoints(points);
    mesh->SetCells(cells.empty()               ? VTK_VERTEX
                   : cells.front().size() == 4 ? VTK_QUAD
                                               : VTK_HEXAHEDRON,
                   list);
    for (const PointArray& array : arrays) {
        set_rows(add_array(*mesh->GetPointData(), array, positions.rows()), 0, array.coefficients);
    }
    save(path, *mesh, provenance);
}

template void write_vtu<2>(const std::filesystem::path&, const Space<2>&,
                           std::span<const PointArray>, std::span<const CellArray>,
                           const VtuOptions&);
template void write_vtu<3>(const std::filesystem::path&, const Space<3>&,
                           std::span<const PointArray>, std::span<const CellArray>,
                           const VtuOptions&);

}  // namespace couture::io
