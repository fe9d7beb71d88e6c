#include "io/surface_reader.h"

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/surface_file.h"
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

TEST_CASE("read_surface: the mark of UTF-8 before a text, and lines of OBJ that go on", "[io]") {
    const std::string mark = "\xEF\xBB\xBF";
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n 2 \\\r\n 3\n";
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const std::string stl =
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid\n";
    for (const auto& [name, text] : {std::pair{"a.off", off}, std::pair{"a.obj", obj},
                                     std::pair{"a.ply", ply}, std::pair{"a.stl", stl}}) {
        CAPTURE(name);
        const TriangleSoup marked = read(name, mark + text);
        CHECK(marked.points.size() == 3);
        CHECK(marked.triangles == std::vector<std::array<int, 3>>{{0, 1, 2}});
    }
    // Lines are counted as they stand in the file.
    CHECK_THAT(message("a.obj", "v 0 0 0\nf 1 \\\n 1 \\\n 1\nv 0 x 0\n"),
               Catch::StartsWith("a.obj:5: "));
    CHECK_THAT(message("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1e160 0\n3 0 1 2\n"),
               Catch::Contains("point 2 is as large as 1e+160; areas and volumes overflow"));
}

TEST_CASE("read_surface: files that can't be read", "[io]") {
    for (const char* name : {"a.stl", "a.obj", "a.off", "a.ply", "a.vtp"}) {
        CHECK(message(name, "") == std::string(name) + ": the file is empty; expected triangles");
    }
    CHECK(message("a.step", "x") ==
          "a.step: the ending '.step' is not that of a surface; expected '.stl', '.obj', "
          "'.off', '.ply' or '.vtp'");
    CHECK(message("a", "x") ==
          "a: the ending '' is not that of a surface; expected '.stl', '.obj', "
          "'.off', '.ply' or '.vtp'");
    const TemporaryFolder folder;
    const std::string missing = (folder / "a.stl").string();
    CHECK_THROWS_WITH(read_surface(missing),
                      missing + ": can't be read: No such file or directory");
}

namespace {

const std::string ply_header =
    "element vertex 4\ncomment by hand\nproperty float x\nproperty uchar red\nproperty double y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty short "
    "label\nelement edge 1\nproperty int a\nend_header\n";
const std::string ascii_ply = "ply\nformat ascii 1.0\n" + ply_header +
                              "0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0\n3 0 1 2 7\n3 0 2 3 7\n5\n";

template <typename T>
void append(std::string& text, T value, bool is_big) {
    std::string bytes(sizeof(T), ' ');
    std::memcpy(bytes.data(), &value, sizeof(T));
    text += is_big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

std::string binary_ply(bool is_big) {
    std::string text = "ply\nformat binary_" + std::string(is_big ? "big" : "little") +
                       "_endian 1.0\n" + ply_header;
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
        append(text, static_cast<float>(x), is_big);
        text += '\x09';
        append(text, static_cast<double>(y), is_big);
        append(text, 0.0F, is_big);
    }
    for (const std::array<std::int32_t, 3>& corners : {std::array{0, 1, 2}, {0, 2, 3}}) {
        text += '\x03';
        for (const std::int32_t corner : corners) append(text, corner, is_big);
        append(text, std::int16_t{7}, is_big);
    }
    append(text, std::int32_t{5}, is_big);
    return text;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
}

/// The message of the text file above with one passage replaced.
std::string ply_message(const std::string& from, const std::string& to) {
    std::string text = ascii_ply;
    replace(text, from, to);
    return message("a.ply", text);
}

}  // namespace

TEST_CASE("read_surface: PLY in text and binary", "[io]") {
    check_square(read("a.ply", ascii_ply));
    check_square(read("a.PLY", binary_ply(false)));
    check_square(read("a.ply", binary_ply(true)));

    CHECK(ply_message("ply\n", "plx\n") == "a.ply:1: found 'plx'; expected 'ply'");
    CHECK(ply_message("ascii", "text") ==
          "a.ply:2: found 'text'; expected 'ascii', 'binary_little_endian' or 'binary_big_endian'");
    CHECK(ply_message("format ascii 1.0\n", "") ==
          "a.ply:13: the header ends without 'format'; expected it on line 2");
    CHECK(ply_message("vertex 4", "vertex 2000000000") ==
          "a.ply:3: found 2000000000 elements 'vertex'; a file of 304 bytes holds 304 at most");
    CHECK(ply_message("float x", "real x") ==
          "a.ply:5: found 'real'; expected a type: char, uchar, short, ushort, int, uint, float or "
          "double");
    CHECK(ply_message("list uchar", "list float") ==
          "a.ply:10: the length of a list is a whole number; expected such a type");
    CHECK(ply_message("property double y", "property double w") ==
          "a.ply: the header lists no x, y and z of element 'vertex'");
    CHECK(ply_message("vertex_indices", "corners") ==
          "a.ply: the header lists no list 'vertex_indices' of element 'face'");
    CHECK(ply_message("element face", "element facet") ==
          "a.ply: the header lists no element 'face'; a surface has 'vertex' and 'face'");
    CHECK(ply_message("1 9 1 0", "1 9 nan 0") ==
          "a.ply:17: found 'nan' as y of point 2; expected a finite number");
    CHECK(ply_message("1 9 1 0", "1 9 x 0") == "a.ply:17: found 'x'; expected a number: y");
    CHECK(ply_message("3 0 2 3", "3 0 2 4") ==
          "a.ply:20: found '4' in face 1; expected the number of a point, from 0 to 3");
    CHECK(ply_message("3 0 2 3", "-3 0 2 3") ==
          "a.ply:20: found -3; expected the length of the list 'vertex_indices', at most 296 in "
          "this file");
    CHECK(ply_message("7\n5\n", "7\n") == "a.ply:21: the file ends here; expected a");
    CHECK(ply_message("7\n5\n", "7\n5 5\n") ==
          "a.ply:21: found '5' after the last of the elements; expected nothing more");
    CHECK(message("a.ply", "ply\nformat ascii 1.0\n") ==
          "a.ply:3: the file ends here; expected 'end_header'");
    const std::string whole = binary_ply(false);
    CHECK(message("a.ply", whole.substr(0, whole.size() - 1)) ==
          "a.ply: byte " + std::to_string(whole.size() - 4) + ": the file ends here; expected a");
    CHECK(message("a.ply", whole + "xy") ==
          "a.ply: byte " + std::to_string(whole.size()) +
              ": 2 bytes follow the last of the elements; expected nothing more");
}

TEST_CASE("read_surface: VTP", "[io]") {
    const auto vtp = [](const std::string& counts, const std::string& cells) {
        return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
               "byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"4\" " +
               counts +
               "><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
               "0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>" +
               cells + "</Piece></PolyData></VTKFile>\n";
    };
    const auto cells = [](const std::string& name, const std::string& corners,
                          const std::string& ends) {
        return "<" + name + "><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
               corners +
               "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" + ends +
               "</DataArray></" + name + ">";
    };
    check_square(read("a.vtp", vtp("NumberOfPolys=\"1\"", cells("Polys", "0 1 2 3", "4"))));
    check_square(
        read("a.VTP", vtp("NumberOfPolys=\"2\" NumberOfLines=\"1\"",
                          cells("Lines", "0 1", "2") + cells("Polys", "0 1 2 0 2 3", "3 6"))));
    const TriangleSoup strip =
        read("a.vtp", vtp("NumberOfStrips=\"1\"", cells("Strips", "0 1 3 2", "4")));
    CHECK(strip.triangles == std::vector<std::array<int, 3>>{{0, 1, 3}, {1, 2, 3}});
    CHECK(message("a.vtp", vtp("NumberOfPolys=\"1\"", cells("Polys", "0 1 2 4", "4"))) ==
          "a.vtp: polygon 0 has point 4; expected from 0 to 3");
    CHECK_THAT(message("a.vtp", vtp("NumberOfPolys=\"2000000000\"", "")),
               Catch::Contains("found NumberOfPolys 2000000000; a file of "));
    CHECK(message("a.vtp", "a letter") ==
          "a.vtp: found no 'VTKFile'; expected a VTK XML file of PolyData");
    const std::string whole = vtp("NumberOfPolys=\"1\"", cells("Polys", "0 1 2 3", "4"));
    CHECK_THAT(message("a.vtp", whole.substr(0, whole.size() / 2)),
               Catch::Contains("VTK can't read it: "));
}

TEST_CASE("read_surface_file: what was done is counted", "[io]") {
    const TemporaryFolder folder;
    write_text(folder / "a.off", "OFF\n7 4 0\n" + off_points +
                                     "2 0.5 0\n0 0 0\n9 9 9\n4 0 1 2 3\n5 1 4 2 2 1\n"
                                     "3 0 5 1\n2 0 1\n");
    const SurfaceFile file = read_surface_file(folder / "a.off");
    CHECK(file.format == "OFF");
    CHECK(file.n_points_read == 7);
    CHECK(file.n_polygons_read == 4);
    CHECK(file.n_merged == 1);
    CHECK(file.n_split == 1);
    CHECK(file.n_degenerate == 2);
    CHECK(file.n_unused == 1);
    CHECK(file.soup.triangles.size() == 3);
    CHECK(is_surface_file("x.StL"));
    CHECK_FALSE(is_surface_file("x.xml"));
}

TEST_CASE("read_surface: damaged files are read or refused, never worse", "[io]") {
    const std::string name = GENERATE("a.ply", "b.ply", "a.vtp", "a.off", "a.obj");
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / name;
    if (name == "b.ply") {
        write_text(path, ascii_ply);
    } else {
        write_surface(path, read("a.ply", ascii_ply));
    }
    const std::string whole = read_text(path);
    std::mt19937 random(11);
    constexpr int n_trials = 60;
    for (int i = 0; i < n_trials; ++i) {
        std::string text = whole;
        if (i % 3 == 0) text.resize(whole.size() * static_cast<std::size_t>(i) / n_trials);
        for (int k = 0; k < i % 5 && !text.empty(); ++k) {
            const std::size_t at = random() % text.size();
            if (random() % 4 == 0) {
                text.insert(at, std::to_string(random()));
            } else {
                text[at] = static_cast<char>(random() % 256);
            }
        }
        write_text(path, text);
        bool is_handled = true;
        try {
            static_cast<void>(read_surface(path));
        } catch (const Error&) {
            is_handled = true;
        } catch (...) {
            is_handled = false;
        }
        CAPTURE(i);
        CHECK(is_handled);
    }
}

TEST_CASE("write_surface: every format is read again as it was", "[io]") {
    const std::string ending = GENERATE(".stl", ".obj", ".off", ".ply", ".vtp", ".PLY");
    const TriangleSoup soup{
        .points = {{0.1, -1e-7 / 3.0, 1e6 / 7.0}, {1.0 / 3.0, 0, 0}, {0, 1, 0}, {0, 0, 1e20}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const TemporaryFolder folder;
    CHECK(write_surface(folder / ("sub/a" + ending), soup, "from a test").empty());
    const TriangleSoup again = read_surface(folder / ("sub/a" + ending));
    if (ending == ".stl") {
        // The order of first use.
        REQUIRE(again.points.size() == 4);
        CHECK(again.points[0] == Vector3(soup.points[0].cast<float>().cast<double>()));
        CHECK(again.triangles ==
              std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}});
    } else {
        CHECK(again.points == soup.points);
        CHECK(again.triangles == soup.triangles);
    }
}

TEST_CASE("write_surface: what a format can't keep", "[io]") {
    const TemporaryFolder folder;
    TriangleSoup soup{.points = {{1, 0, 0}, {1.0 + 1e-12, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                      .triangles = {{0, 1, 2}, {1, 2, 3}}};
    const auto warnings = write_surface(folder / "a.stl", soup);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Catch::Contains("a.stl: 1 points become equal to others"));
    soup.points[0].x() = 1e300;
    CHECK_THROWS_WITH(write_surface(folder / "a.stl", soup),
                      Catch::Contains("beyond the single precision of STL"));
    CHECK_THROWS_WITH(write_surface(folder / "a.step", soup),
                      Catch::Contains("the ending '.step' is not that of a surface"));
}
