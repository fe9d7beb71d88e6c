#include "io/surface_reader.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::io;
using meshing::TriangleSoup;

namespace {

TriangleSoup read(const std::string& name, const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder / name, text);
    return read_surface(folder / name);
}

/// What is said of the file, behind its folder.
std::string message(const std::string& name, const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder / name, text);
    try {
        static_cast<void>(read_surface(folder / name));
    } catch (const FileError& error) {
        const std::string what = error.what();
        const std::string prefix = (folder / "").string();
        REQUIRE(what.substr(0, prefix.size()) == prefix);
        return what.substr(prefix.size());
    }
    return "nothing";
}

std::string little_endian(std::uint32_t value) {
    std::string result;
    for (int i = 0; i < 4; ++i) {
        result += static_cast<char>(value >> (8 * i) & 0xffU);
    }
    return result;
}

/// Binary STL: nine coordinates per triangle.
std::string binary_stl(const std::vector<float>& coordinates, std::uint32_t count) {
    std::string result = "solid of some program";
    result.resize(80, ' ');
    result += little_endian(count);
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        result += i % 9 == 0 ? std::string(12, '\0') : "";
        result += little_endian(std::bit_cast<std::uint32_t>(coordinates[i]));
        result += i % 9 == 8 ? std::string(2, '\0') : "";
    }
    return result;
}

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal nan 0 0\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " +
           c + "\n endloop\nendfacet\n";
}

/// The unit square as two triangles with a common diagonal.
void check_square(const TriangleSoup& soup) {
    CHECK(soup.points ==
          std::vector<Vector3>{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}});
    CHECK(soup.triangles == std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}});
}

const std::string obj_points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string off_points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

}  // namespace

TEST_CASE("read_surface: STL in text", "[io]") {
    const std::string one = facet("0 0 0", "1 0 0", "1 1 0");
    const std::string two = facet("-0 0.0 0", "1 1e0 +0", "0 1 0");
    check_square(read("a.stl", "solid a b\n" + one + two + "endsolid a b\n"));
    check_square(read(
        "a.STL", "SOLID\r\nFACET" + one.substr(5) + "endsolid\nsolid b\n" + two + "endsolid b"));
    // A triangle with a point twice goes, and the points that only it had.
    check_square(
        read("a.stl", "solid\n" + facet("7 7 7", "7 7 7", "0 0 0") + one + two + "endsolid"));

    CHECK(message("a.stl", "hello world\n") ==
          "a.stl:1: found 'hello'; an STL file begins with 'solid', or is binary");
    CHECK(message("a.stl", " \n") == "a.stl:2: the file ends here; expected 'solid'");
    CHECK(message("a.stl", "solid a\n" + one) ==
          "a.stl:9: the file ends here; expected 'facet' or 'endsolid'");
    CHECK(message("a.stl", "solid a\nfaced normal") ==
          "a.stl:2: found 'faced'; expected 'facet' or 'endsolid'");
    CHECK(message("a.stl", "solid a\nfacet normal 0 0 1\nouter hoop") ==
          "a.stl:3: found 'hoop'; expected 'loop'");
    CHECK(message("a.stl", "solid a\nfacet normal 0 0") ==
          "a.stl:2: the file ends here; expected a normal");
    CHECK(message("a.stl", "solid\n" + facet("0 nan 0", "1 0 0", "1 1 0")) ==
          "a.stl:4: found 'nan'; expected a finite number: y of a point");
    CHECK(message("a.stl", "solid\n" + facet("0 0 0", "1 0 x", "1 1 0")) ==
          "a.stl:5: found 'x'; expected a number: z of a point");
    CHECK(message("a.stl", "solid\n" + one + "endsolid\nrest") ==
          "a.stl:10: found 'rest'; expected 'solid'");
    CHECK(message("a.stl", "solid\nendsolid") ==
          "a.stl: found no triangles; a surface has at least one");
    CHECK(message("a.stl", "solid\n" + facet("0 0 0", "0 0 0", "1 0 0") + "endsolid") ==
          "a.stl: found no triangles but such with a point twice; a surface has at least one");
}

TEST_CASE("read_surface: binary STL", "[io]") {
    std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, -0.0F, 0, 0, 1, 1, 0, 0, 1, 0};
    const std::string whole = binary_stl(square, 2);
    check_square(read("a.stl", whole));
    std::string titled = whole;
    titled.replace(0, 5, "title");
    check_square(read("a.stl", titled));

    CHECK(message("a.stl", whole.substr(0, 183)) ==
          "a.stl: byte 80: found 2 triangles, which take 184 bytes, but the file has 183; it is "
          "cut short");
    CHECK(message("a.stl", whole + "x") ==
          "a.stl: byte 80: found 2 triangles, which take 184 bytes, but the file has 185; it is "
          "longer than it says");
    CHECK(message("a.stl", binary_stl(square, 4294967295U)) ==
          "a.stl: byte 80: found 4294967295 triangles, which take 214748364834 bytes, but the file "
          "has 184; it is cut short");
    CHECK(message("a.stl", whole.substr(0, 82)) ==
          "a.stl: byte 82: the file ends in the header; a binary STL has 84 bytes there");
    CHECK(message("a.stl", binary_stl({}, 0)) ==
          "a.stl: found no triangles; a surface has at least one");
    square[10] = std::numeric_limits<float>::infinity();
    CHECK(message("a.stl", binary_stl(square, 2)) ==
          "a.stl: byte 150: found 'inf' in triangle 1; expected a finite number");
    square[10] = std::numeric_limits<float>::quiet_NaN();
    CHECK(message("a.stl", binary_stl(square, 2)) ==
          "a.stl: byte 150: found 'nan' in triangle 1; expected a finite number");
}

TEST_CASE("read_surface: OBJ", "[io]") {
    check_square(read("a.obj", "# made by hand\no a\n" + obj_points + "s off\nf 1 2 3 4 # all"));
    check_square(read("a.obj", obj_points + "vn 0 0 1\nvt 0 0\nf 1/1 2/1/1 3//1\r\nf 1 3 4\r\n"));
    check_square(read("a.obj", obj_points + "f -4//-1 -3 -2 -1\nv 9 9 9\n"));
    // Faces may stand before their points; equal points are one; a colour is passed over.
    check_square(read("a.obj", "f 1 2 3\nf 5 3 4\n" + obj_points + "v 0 -0 0 0.5 0.5 0.5\n"));

    const std::string rule = "; expected the number of a point, from 1 to 4 or from -4 to -1";
    for (const char* word : {"5", "0", "-5", "x", "2x/1", "/1", "99999999999999999999"}) {
        CHECK(message("a.obj", obj_points + "f 1 2 " + word) ==
              "a.obj:5: found '" + std::string(word) + "'" + rule);
    }
    CHECK(message("a.obj", "v 0 0 0\nf -2 1 1\nv 1 0 0") ==
          "a.obj:2: found '-2'; expected the number of a point, from 1 to 2 or from -1 to -1");
    CHECK(message("a.obj", obj_points + "f 1 2") ==
          "a.obj:5: found 'f 1 2'; a face has three corners or more");
    CHECK(message("a.obj", "\nv 1 2\nv 0 0 0") ==
          "a.obj:2: found 'v 1 2'; expected three numbers after 'v'");
    CHECK(message("a.obj", "v 1 inf 0") ==
          "a.obj:1: found 'inf'; expected a finite number: a coordinate of a point");
    CHECK(message("a.obj", "v 1 1,5 0") ==
          "a.obj:1: found '1,5'; expected a number: a coordinate of a point");
    CHECK(message("a.obj", obj_points) == "a.obj: found no triangles; a surface has at least one");
}

TEST_CASE("read_surface: OFF", "[io]") {
    check_square(read("a.off", "OFF\n# a square\n4 1 0 # counts\n\n" + off_points + "4 0 1 2 3\n"));
    check_square(read("a.off", "OFF 4 2 5\n" + off_points + "3 0 1 2 255 0 0\n3 0 2 3"));
    check_square(read("a.off",
                      "COFF\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 1 0 0 1\n"
                      "0 1 0 0 0 0 1\n4 0 1 2 3 0.5 0.5 0.5\n2 0 1\n"));
    check_square(read("a.off",
                      "NOFF\n5 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n"
                      "0 0 0 0 0 1\n3 0 1 2\n3 4 2 3\n"));

    CHECK(message("a.off", "PLY\n") ==
          "a.off:1: found 'PLY'; expected 'OFF', 'COFF', 'NOFF' or 'CNOFF'");
    CHECK(message("a.off", "# nothing") == "a.off:1: the file ends here; expected 'OFF'");
    CHECK(message("a.off", "OFF BINARY\n") ==
          "a.off:1: found 'BINARY'; only OFF files in text can be read");
    CHECK(message("a.off", "OFF\n2000000000 1 0\n") ==
          "a.off:2: found 2000000000 points; a file of 19 bytes holds 3 at most");
    CHECK(message("a.off", "OFF\n1 2000000000 0\n") ==
          "a.off:2: found 2000000000 faces; a file of 19 bytes holds 6 at most");
    CHECK(message("a.off", "OFF\n-1 1 0\n") ==
          "a.off:2: found '-1'; expected the number of points, a whole number from 0 to "
          "2147483647");
    CHECK(message("a.off", "OFF\n4 2 0\n" + off_points + "3 0 1 2\n") ==
          "a.off:8: the file ends here; expected the number of corners of a face");
    CHECK(message("a.off", "OFF\n4 1 0\n" + off_points + "3 0 1 2\n3 0 2 3\n") ==
          "a.off:8: found '3' after the last of the faces; expected nothing more");
    CHECK(message("a.off", "OFF\n4 1 0\n" + off_points + "3 0 1 4\n") ==
          "a.off:7: found '4'; expected a point of a face, a whole number from 0 to 3");
    CHECK(message("a.off", "OFF\n4 1 0\n" + off_points + "2000000000 0 1 2\n") ==
          "a.off:8: the file ends here; expected a point of a face");
    CHECK(message("a.off", "OFF\n1 1 0\n0 0 nan\n3 0 0 0\n") ==
          "a.off:3: found 'nan'; expected a finite number: z of a point");
    CHECK(message("a.off", "OFF\n4 0 0\n" + off_points) ==
          "a.off: found no triangles; a surface has at least one");
}

TEST_CASE("read_surface: files that can't be read", "[io]") {
    for (const char* name : {"a.stl", "a.obj", "a.off"}) {
        CHECK(message(name, "") == std::string(name) + ": the file is empty; expected triangles");
    }
    CHECK(message("a.step", "x") ==
          "a.step: the ending '.step' is not that of a surface; expected '.stl', '.obj' or '.off'");
    CHECK(message("a", "x") ==
          "a: the ending '' is not that of a surface; expected '.stl', '.obj' or '.off'");
    const TemporaryFolder folder;
    const std::string missing = (folder / "a.stl").string();
    CHECK_THROWS_WITH(read_surface(missing),
                      missing + ": can't be read: No such file or directory");
}
