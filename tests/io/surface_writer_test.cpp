#include "io/surface_writer.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "iga/core/error.h"
#include "io/obj_surface.h"

using namespace couture;

namespace {

const meshing::TriangleSoup square{
    .points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}},
    .triangles = {{0, 1, 2}, {0, 2, 3}}};

std::filesystem::path temporary_file() {
    return std::filesystem::temp_directory_path() / "couture_surface_writer_test.vtp";
}

}  // namespace

TEST_CASE("write_vtp: surface, arrays and curves can be read again", "[io]") {
    const auto path = temporary_file();
    const std::vector<io::SurfaceArray> on_points{{"height", VectorX::LinSpaced(4, 0.1, 0.4)}};
    const std::vector<io::SurfaceArray> on_triangles{{"patch", VectorX::LinSpaced(2, 5.0, 6.0)}};
    const std::vector<io::SurfaceLine> lines{
        {.points = {square.points[0], square.points[2]}, .kind = 1, .number = 7},
        {.points = {square.points[0], square.points[1], square.points[2]},
         .is_closed = true,
         .kind = 2,
         .number = 8}};
    io::write_vtp(path, square, on_points, on_triangles, lines, "from a test");
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    vtkPolyData& data = *reader->GetOutput();
    CHECK(data.GetNumberOfPolys() == 2);
    CHECK(data.GetNumberOfLines() == 2);
    CHECK(data.GetNumberOfPoints() == 4 + 2 + 3);
    CHECK(data.GetPointData()->GetArray("height")->GetComponent(3, 0) == 0.4);
    CHECK(std::isnan(data.GetPointData()->GetArray("height")->GetComponent(4, 0)));
    // Cells: lines, then triangles.
    vtkDataArray& patch = *data.GetCellData()->GetArray("patch");
    CHECK(std::isnan(patch.GetComponent(1, 0)));
    CHECK(patch.GetComponent(2, 0) == 5.0);
    CHECK(patch.GetComponent(3, 0) == 6.0);
    vtkDataArray& curve = *data.GetCellData()->GetArray("curve");
    CHECK(curve.GetComponent(0, 0) == 7.0);
    CHECK(curve.GetComponent(1, 0) == 8.0);
    CHECK(curve.GetComponent(2, 0) == -1.0);
    CHECK(data.GetCell(1)->GetNumberOfPoints() == 4);
    std::filesystem::remove(path);
}

TEST_CASE("write_vtp: what does not fit is refused", "[io]") {
    const auto path = temporary_file();
    const std::vector<io::SurfaceArray> short_array{{"height", VectorX::Zero(3)}};
    CHECK_THROWS_WITH(io::write_vtp(path, square, short_array),
                      Catch::Contains("'height' is 3 x 1") && Catch::Contains("4 points"));
    CHECK_THROWS_WITH(io::write_vtp(path, square, {}, short_array), Catch::Contains("2 triangles"));
    meshing::TriangleSoup broken = square;
    broken.triangles[1][2] = 9;
    CHECK_THROWS_WITH(io::write_vtp(path, broken), Catch::Contains("vertex 9"));
    CHECK_THROWS_AS(io::write_vtp("/dev/null/x.vtp", square), FileError);
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("write_vtp and write_obj: quads can be read again", "[io]") {
    const meshing::QuadMesh quads{.points = square.points, .quads = {{0, 1, 2, 3}}};
    const std::filesystem::path path = temporary_file();
    io::write_vtp(path, quads, "from a test");
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    REQUIRE(reader->GetOutput()->GetNumberOfPolys() == 1);
    CHECK(reader->GetOutput()->GetCell(0)->GetNumberOfPoints() == 4);
    CHECK(reader->GetOutput()->GetCell(0)->GetPointId(2) == 2);
    std::filesystem::remove(path);

    const std::filesystem::path obj = path.parent_path() / "couture_surface_writer_test.obj";
    io::write_obj(obj, quads, "from a test");
    std::ifstream stream(obj);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    CHECK(text.find("f 1 2 3 4\n") != std::string::npos);
    std::filesystem::remove(obj);
    CHECK_THROWS_AS(io::write_vtp(path, meshing::QuadMesh{square.points, {{0, 1, 2, 4}}}),
                    InputError);
}
