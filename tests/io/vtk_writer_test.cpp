#include "io/vtk_writer.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "tests/iga/topology/test_patches.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::iga;
using namespace couture::io;
using Catch::Matchers::Contains;

namespace {

/// Rounding of a few hundred operations on numbers of size 1 to 10.
constexpr double exactness = 1e-10;
constexpr int n_random_points = 4;

vtkSmartPointer<vtkUnstructuredGrid> read_vtu(const std::filesystem::path& path) {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    return reader->GetOutput();
}

template <int d>
TensorSpace<d> make_tensor_space(const std::array<int, d>& degrees, int n_elements) {
    const auto knots = [&](int k) { return KnotVector::uniform(degrees[k], n_elements); };
    if constexpr (d == 2) {
        return {{knots(0), knots(1)}};
    } else {
        return {{knots(0), knots(1), knots(2)}};
    }
}

/// Unit box with moved control points, weights about 1 and, if asked for, mirrored in x.
template <int d>
Patch<d> make_bent_patch(const TensorSpace<d>& space, bool is_rational, bool is_mirrored = false) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.05, 0.05);
    const auto bent = make_mapped_patch<d>(space, [&](const Vector<d>& xi) {
        VectorX x = xi;
        for (double& coordinate : x) {
            coordinate += shift(random);
        }
        x[0] *= is_mirrored ? -1.0 : 1.0;
        return x;
    });
    VectorX weights;
    if (is_rational) {
        weights = VectorX::NullaryExpr(space.n_basis(),
                                       [&](Eigen::Index) { return 1.0 + 4.0 * shift(random); });
    }
    return {space, bent.control_points(), weights};
}

template <int d>
MatrixX random_coefficients(const Space<d>& space, int n_components) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    return MatrixX::NullaryExpr(space.n_dofs(), n_components,
                                [&](Eigen::Index, Eigen::Index) { return value(random); });
}

/// What VTK makes of a cell at parametric coordinates.
struct CellValue {
    Vector3 position;
    VectorX field;
};

CellValue evaluate(vtkUnstructuredGrid& mesh, vtkCell& cell, const Vector3& t) {
    int sub_cell = 0;
    std::vector<double> shape(cell.GetNumberOfPoints());
    CellValue value;
    cell.EvaluateLocation(sub_cell, t.data(), value.position.data(), shape.data());
    vtkDataArray& field = *mesh.GetPointData()->GetArray("field");
    value.field = VectorX::Zero(field.GetNumberOfComponents());
    for (std::size_t i = 0; i < shape.size(); ++i) {
        for (int c = 0; c < field.GetNumberOfComponents(); ++c) {
            value.field[c] +=
                shape[i] * field.GetComponent(cell.GetPointId(static_cast<int>(i)), c);
        }
    }
    return value;
}

template <int d>
VectorX field_at(const Space<d>& space, int i_patch, const MatrixX& coefficients,
                 const Vector<d>& xi) {
    const auto basis = evaluate_basis<d>(space.tensor(i_patch), space.weights(i_patch), xi);
    VectorX value = VectorX::Zero(coefficients.cols());
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        value +=
            basis.values[i] * coefficients.row(space.dofs(i_patch)[basis.functions[i]]).transpose();
    }
    return value;
}

/// Determinant of VTK's parametric map at the middle of a cell, from central differences.
template <int d>
double orientation(vtkUnstructuredGrid& mesh, vtkCell& cell) {
    constexpr double step = 1e-3;
    Matrix<d> J;
    for (int k = 0; k < d; ++k) {
        Vector3 center(0.5, 0.5, d == 3 ? 0.5 : 0.0);
        const Vector3 ahead = evaluate(mesh, cell, center + step * Vector3::Unit(k)).position;
        const Vector3 behind = evaluate(mesh, cell, center - step * Vector3::Unit(k)).position;
        J.col(k) = ((ahead - behind) / (2.0 * step)).template head<d>();
    }
    return J.determinant();
}

/// Writes, reads back with VTK, and compares every cell at random points with the spline.
template <int d>
void check_exact(const Space<d>& space, const std::vector<bool>& is_left_handed) {
    const TemporaryFolder folder;
    const std::vector<PointArray> arrays{{"field", random_coefficients(space, 3), {}}};
    write_vtu<d>(folder / "exact.vtu", space, arrays);
    const auto mesh = read_vtu(folder / "exact.vtu");

    std::mt19937 random(3);
    std::uniform_real_distribution<double> parameter(0.0, 1.0);
    vtkIdType i_cell = 0;
    double largest_error = 0.0;
    for (int i_patch = 0; i_patch < space.n_patches(); ++i_patch) {
        const TensorSpace<d>& tensor = space.tensor(i_patch);
        int n_cells = 1;
        for (const int n : tensor.n_elements()) {
            n_cells *= n;
        }
        for (int e = 0; e < n_cells; ++e, ++i_cell) {
            vtkCell& cell = *mesh->GetCell(i_cell);
            REQUIRE(cell.GetCellType() ==
                    (d == 3 ? VTK_BEZIER_HEXAHEDRON : VTK_BEZIER_QUADRILATERAL));
            REQUIRE(mesh->GetCellData()->GetArray("patch")->GetTuple1(i_cell) == i_patch);
            REQUIRE(orientation<d>(*mesh, cell) > 0.0);
            for (int i = 0; i < n_random_points; ++i) {
                Vector3 t = Vector3::Zero();
                Vector<d> xi;
                for (int k = 0, rest = e; k < d; rest /= tensor.knots[k].n_elements(), ++k) {
                    t[k] = parameter(random);
                    const double s = k == 0 && is_left_handed[i_patch] ? 1.0 - t[k] : t[k];
                    const auto& breakpoints = tensor.knots[k].breakpoints();
                    const int element = rest % tensor.knots[k].n_elements();
                    xi[k] = (1.0 - s) * breakpoints[element] + s * breakpoints[element + 1];
                }
                const CellValue value = evaluate(*mesh, cell, t);
                Vector3 x = Vector3::Zero();
                x.template head<d>() = space.geometry().patches[i_patch].point(xi);
                largest_error = std::max(
                    {largest_error, (value.position - x).norm(),
                     (value.field - field_at<d>(space, i_patch, arrays[0].coefficients, xi))
                         .norm()});
            }
        }
    }
    CHECK(i_cell == mesh->GetNumberOfCells());
    CHECK(largest_error < exactness);
}

template <int d>
Space<d> make_single_space(const std::array<int, d>& degrees, bool is_rational,
                           bool is_mirrored = false) {
    MultiPatch<d> geometry;
    geometry.patches.push_back(
        make_bent_patch<d>(make_tensor_space<d>(degrees, 2), is_rational, is_mirrored));
    return Space<d>(geometry);
}

/// Two boxes side by side in x; the second one read backwards in y, thus left-handed.
template <int d>
Space<d> make_two_patch_space() {
    MultiPatch<d> geometry;
    std::array<int, d> axis;
    std::array<bool, d> reversed{};
    for (int k = 0; k < d; ++k) {
        axis[k] = k;
    }
    reversed[1] = true;
    geometry.patches = {make_unit_box<d>(2, 2),
                        reoriented<d>(make_unit_box<d>(2, 2, Vector<d>::Unit(0)), axis, reversed)};
    SideMap<d> map = SideMap<d>::identity();
    map.reversed[0] = true;
    geometry.interfaces = {{0, 1, 1, 0, map}};
    return Space<d>(geometry);
}

}  // namespace

TEST_CASE("write_vtu: cells are the spline for each degree, rational or not", "[io]") {
    for (int degree = 1; degree <= 4; ++degree) {
        for (const bool is_rational : {false, true}) {
            CAPTURE(degree, is_rational);
            check_exact<2>(make_single_space<2>({degree, degree}, is_rational), {false});
            check_exact<3>(make_single_space<3>({degree, degree, degree}, is_rational), {false});
        }
    }
}

TEST_CASE("write_vtu: degrees may differ between directions", "[io]") {
    for (const bool is_rational : {false, true}) {
        CAPTURE(is_rational);
        check_exact<3>(make_single_space<3>({1, 2, 3}, is_rational), {false});
        check_exact<3>(make_single_space<3>({4, 3, 2}, is_rational), {false});
        check_exact<2>(make_single_space<2>({3, 1}, is_rational), {false});
        check_exact<2>(make_single_space<2>({2, 4}, is_rational), {false});
    }
}

TEST_CASE("write_vtu: left-handed patches are turned to right-handed cells", "[io]") {
    check_exact<2>(make_single_space<2>({2, 3}, true, true), {true});
    check_exact<3>(make_single_space<3>({3, 1, 2}, true, true), {true});
}

TEST_CASE("write_vtu: several patches share fields, each keeps its hand", "[io]") {
    check_exact<2>(make_two_patch_space<2>(), {false, true});
    check_exact<3>(make_two_patch_space<3>(), {false, true});
}

TEST_CASE("write_vtu: fields finer or lower in degree than the geometry are exact", "[io]") {
    MultiPatch<2> curved;
    curved.patches.push_back(make_bent_patch<2>(make_tensor_space<2>({2, 2}, 1), true));
    check_exact<2>(Space<2>(curved, {make_tensor_space<2>({3, 4}, 3)}), {false});
    MultiPatch<2> polynomial;
    polynomial.patches.push_back(make_bent_patch<2>(make_tensor_space<2>({3, 2}, 2), false));
    check_exact<2>(Space<2>(polynomial, {make_tensor_space<2>({1, 4}, 4)}), {false});
}

TEST_CASE("write_vtu: exact cells refuse fields that can't share a patch's weights", "[io]") {
    MultiPatch<2> geometry;
    geometry.patches.push_back(make_bent_patch<2>(make_tensor_space<2>({2, 2}, 1), true));
    const Space<2> space(geometry, {make_tensor_space<2>({1, 1}, 1)});
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(
        write_vtu<2>(folder / "a.vtu", space, {}),
        "write_vtu: the space of patch 0 does not contain the functions of its rational geometry, "
        "exact cells can't hold both; use a refinement of the geometry or linear cells");
    VtuOptions linear;
    linear.linear = true;
    CHECK_NOTHROW(write_vtu<2>(folder / "a.vtu", space, {}, {}, linear));
}

TEST_CASE("write_vtu: linear cells pass through points of the spline", "[io]") {
    const auto space = make_single_space<3>({2, 2, 2}, true, true);
    const TemporaryFolder folder;
    const std::vector<PointArray> arrays{{"field", random_coefficients(space, 1), {}}};
    VtuOptions options;
    options.linear = true;
    options.samples = 3;
    write_vtu<3>(folder / "linear.vtu", space, arrays, {}, options);
    const auto mesh = read_vtu(folder / "linear.vtu");
    constexpr int n = 2 * 3;
    REQUIRE(mesh->GetNumberOfCells() == n * n * n);
    REQUIRE(mesh->GetNumberOfPoints() == (n + 1) * (n + 1) * (n + 1));
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
        const Vector3 xi =
            Vector3(static_cast<double>(i % (n + 1)), static_cast<double>(i / (n + 1) % (n + 1)),
                    static_cast<double>(i / ((n + 1) * (n + 1)))) /
            n;
        const Vector3 x(mesh->GetPoint(i));
        CHECK((x - space.geometry().patches[0].point(xi)).norm() < exactness);
        CHECK(mesh->GetPointData()->GetArray("field")->GetTuple1(i) ==
              Approx(field_at<3>(space, 0, arrays[0].coefficients, xi)[0]).margin(exactness));
    }
    for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
        REQUIRE(mesh->GetCell(i)->GetCellType() == VTK_HEXAHEDRON);
        REQUIRE(orientation<3>(*mesh, *mesh->GetCell(i)) > 0.0);
    }
}

TEST_CASE("write_vtu: names, patch values and provenance come back", "[io]") {
    const auto space = make_two_patch_space<2>();
    const TemporaryFolder folder;
    const std::vector<PointArray> points{
        {"displacement", random_coefficients(space, 2), {}},
        {"stress", random_coefficients(space, 3), {"11", "22", "12"}}};
    const std::vector<CellArray> cells{{"quality", Vector2(0.25, 0.75)}};
    VtuOptions options;
    options.provenance = "deck = \"pipe\" <&>\nversion 1";
    write_vtu<2>(folder / "new/results.vtu", space, points, cells, options);
    const auto mesh = read_vtu(folder / "new/results.vtu");
    CHECK(mesh->GetPointData()->GetArray("displacement")->GetNumberOfComponents() == 3);
    CHECK(mesh->GetPointData()->GetArray("displacement")->GetComponent(5, 2) == 0.0);
    CHECK(std::string(mesh->GetPointData()->GetArray("stress")->GetComponentName(2)) == "12");
    for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
        CHECK(mesh->GetCellData()->GetArray("quality")->GetTuple1(i) == (i < 4 ? 0.25 : 0.75));
    }
    const auto* text =
        vtkStringArray::SafeDownCast(mesh->GetFieldData()->GetAbstractArray("provenance"));
    REQUIRE(text != nullptr);
    CHECK(const_cast<vtkStringArray*>(text)->GetValue(0) == options.provenance);
}

TEST_CASE("write_points_vtu: points and their values come back", "[io]") {
    const TemporaryFolder folder;
    const MatrixX positions = MatrixX::Random(5, 2);
    const std::vector<PointArray> arrays{{"stress", MatrixX::Random(5, 6), {}}};
    write_points_vtu(folder / "gauss.vtu", positions, arrays, "run 1");
    const auto mesh = read_vtu(folder / "gauss.vtu");
    REQUIRE(mesh->GetNumberOfCells() == 5);
    for (int i = 0; i < 5; ++i) {
        CHECK(mesh->GetCellType(i) == VTK_VERTEX);
        CHECK(mesh->GetPoint(i)[1] == positions(i, 1));
        CHECK(mesh->GetPoint(i)[2] == 0.0);
        CHECK(mesh->GetPointData()->GetArray("stress")->GetComponent(i, 5) ==
              arrays[0].coefficients(i, 5));
    }
    CHECK_THROWS_WITH(write_points_vtu(folder / "a.vtu", MatrixX::Zero(2, 4), {}),
                      "write_points_vtu: points have 4 coordinates; 2 or 3 are taken");
}

TEST_CASE("write_vtu: wrong arrays are named", "[io]") {
    const auto space = make_single_space<2>({1, 1}, false);
    const TemporaryFolder folder;
    const auto write = [&](std::vector<PointArray> points, std::vector<CellArray> cells = {},
                           VtuOptions options = {}) {
        write_vtu<2>(folder / "a.vtu", space, points, cells, options);
    };
    const MatrixX values = MatrixX::Zero(9, 1);
    CHECK_THROWS_WITH(write({{"u", MatrixX::Zero(4, 1), {}}}),
                      "write_vtu: array 'u' is 4 x 1; expected 9 rows, one per function of the "
                      "space, and at least one column");
    CHECK_THROWS_WITH(write({{"u", values, {"x", "y"}}}),
                      "write_vtu: array 'u' has 1 columns but 2 component names");
    CHECK_THROWS_WITH(write({{"", values, {}}}), "write_vtu: an array has no name");
    CHECK_THROWS_WITH(write({{"u", values, {}}, {"u", values, {}}}),
                      "write_vtu: the array name 'u' is taken or reserved; choose another");
    CHECK_THROWS_WITH(write({}, {{"patch", VectorX::Zero(1)}}), Contains("'patch' is taken"));
    CHECK_THROWS_WITH(write({}, {{"q", VectorX::Zero(2)}}),
                      "write_vtu: cell array 'q' has 2 values for 1 patches; one each");
    VtuOptions options;
    options.linear = true;
    options.samples = 0;
    CHECK_THROWS_WITH(write({}, {}, options), "write_vtu: samples = 0; must be at least 1");
    CHECK(folder.is_empty());
}

TEST_CASE("write_vtu: a path that can't be written is named and nothing is left", "[io]") {
    const auto space = make_single_space<2>({1, 1}, false);
    const TemporaryFolder folder;
    write_text(folder / "file", "text");
    CHECK_THROWS_AS(write_vtu<2>(folder / "file/a.vtu", space, {}), FileError);
    CHECK_THROWS_WITH(write_vtu<2>(folder / "file/a.vtu", space, {}),
                      Contains("file") && Contains("can't be made"));
    // No system takes a name of 255 letters plus what the temporary name adds.
    const auto too_long = folder / (std::string(251, 'a') + ".vtu");
    CHECK_THROWS_WITH(write_vtu<2>(too_long, space, {}), Contains("can't be written"));
    std::filesystem::remove(folder / "file");
    CHECK(folder.is_empty());
}

TEST_CASE("write_points_vtu: cells join the points", "[io]") {
    const TemporaryFolder folder;
    MatrixX positions(6, 2);
    positions << 0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1;
    const std::vector<PointArray> arrays{{"stress", MatrixX::Random(6, 6), {}}};
    const std::vector<std::vector<int>> cells{{0, 1, 4, 3}, {1, 2, 5, 4}};
    write_points_vtu(folder / "gauss.vtu", positions, arrays, "", cells);
    const auto mesh = read_vtu(folder / "gauss.vtu");
    REQUIRE(mesh->GetNumberOfCells() == 2);
    CHECK(mesh->GetCellType(1) == VTK_QUAD);
    CHECK(mesh->GetCell(1)->GetPointId(2) == 5);
    const std::vector<std::vector<int>> wrong{{0, 1, 4, 6}};
    CHECK_THROWS_WITH(write_points_vtu(folder / "a.vtu", positions, arrays, "", wrong),
                      "write_points_vtu: a cell has the points 0, 1, 4, 6; all need 4, or all 8, "
                      "of 0 to 5");
}
