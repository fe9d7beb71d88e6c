#include "io/surface_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/text_cursor.h"

namespace couture::io {

using meshing::TriangleSoup;

namespace {

constexpr int max_int = std::numeric_limits<int>::max();

std::string lower(std::string_view word) {
    std::string result(word);
    for (char& c : result) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return result;
}

Vector3 read_point(TextCursor& cursor) {
    const double x = cursor.number("x of a point");
    const double y = cursor.number("y of a point");
    const double z = cursor.number("z of a point");
    return {x, y, z};
}

void add_fan(const std::vector<int>& corners, TriangleSoup& soup) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
        soup.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
}

/// Appends a triangle with points of its own.
void add_triangle(const std::array<Vector3, 3>& corners, TriangleSoup& soup) {
    const int first = static_cast<int>(soup.points.size());
    soup.points.insert(soup.points.end(), corners.begin(), corners.end());
    soup.triangles.push_back({first, first + 1, first + 2});
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        result |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    }
    return result;
}

// Binary STL: 80 bytes of title, the number of triangles, 50 bytes for each.
constexpr std::size_t stl_header = 84;
constexpr std::size_t stl_triangle = 50;

/// As many bytes as the number of triangles asks for.
bool is_whole_binary_stl(std::string_view bytes) {
    return bytes.size() >= stl_header &&
           bytes.size() == stl_header + stl_triangle * std::size_t{little_endian(bytes, 80)};
}

bool is_text(std::string_view bytes) {
    return std::none_of(bytes.begin(), bytes.end(), [](char c) {
        return (c >= 0 && c < ' ' && !(c >= '\t' && c <= '\r')) || c == '\x7f';
    });
}

TriangleSoup read_binary_stl(const std::string& file, std::string_view bytes) {
    if (bytes.size() < stl_header) {
        throw FileError("{}: byte {}: the file ends in the header; a binary STL has {} bytes there",
                        file, bytes.size(), stl_header);
    }
    const std::size_t count = little_endian(bytes, 80);
    const std::size_t expected = stl_header + stl_triangle * count;
    if (bytes.size() != expected) {
        throw FileError(
            "{}: byte 80: found {} triangles, which take {} bytes, but the file has {}; it is {}",
            file, count, expected, bytes.size(),
            bytes.size() < expected ? "cut short" : "longer than it says");
    }
    TriangleSoup soup;
    for (std::size_t t = 0; t < count; ++t) {
        std::array<Vector3, 3> corners;
        for (std::size_t i = 0; i < 9; ++i) {
            // Behind the normal.
            const std::size_t at = stl_header + stl_triangle * t + 12 + 4 * i;
            const auto value = std::bit_cast<float>(little_endian(bytes, at));
            if (!std::isfinite(value)) {
                throw FileError("{}: byte {}: found '{}' in triangle {}; expected a finite number",
                                file, at, value, t);
            }
            corners[i / 3][static_cast<int>(i % 3)] = double{value};
        }
        add_triangle(corners, soup);
    }
    return soup;
}

void expect_words(TextCursor& cursor, std::initializer_list<std::string_view> keywords) {
    for (const std::string_view keyword : keywords) {
        const std::string_view found = cursor.word(fmt::format("'{}'", keyword));
        if (lower(found) != keyword) {
            cursor.fail("found {}; expected '{}'", in_quotes(found), keyword);
        }
    }
}

TriangleSoup read_text_stl(const std::string& file, std::string_view text) {
    TextCursor cursor(file, text, 0);
    TriangleSoup soup;
    while (!cursor.at_end()) {
        expect_words(cursor, {"solid"});
        cursor.rest_of_line();
        while (true) {
            const std::string_view found = cursor.word("'facet' or 'endsolid'");
            if (lower(found) == "endsolid") {
                cursor.rest_of_line();
                break;
            }
            if (lower(found) != "facet") {
                cursor.fail("found {}; expected 'facet' or 'endsolid'", in_quotes(found));
            }
            expect_words(cursor, {"normal"});
            // Not used; not finite in some files where the triangle has no area.
            for (int i = 0; i < 3; ++i) {
                cursor.word("a normal");
            }
            expect_words(cursor, {"outer", "loop"});
            std::array<Vector3, 3> corners;
            for (Vector3& corner : corners) {
                expect_words(cursor, {"vertex"});
                corner = read_point(cursor);
            }
            expect_words(cursor, {"endloop", "endfacet"});
            add_triangle(corners, soup);
        }
    }
    return soup;
}

TriangleSoup read_stl(const std::string& file, std::string_view bytes) {
    if (is_whole_binary_stl(bytes) || !is_text(bytes)) {
        return read_binary_stl(file, bytes);
    }
    TextCursor cursor(file, bytes, 0);
    if (lower(cursor.peek()) != "solid") {
        const std::string_view found = cursor.word("'solid'");
        cursor.fail("found {}; an STL file begins with 'solid', or is binary", in_quotes(found));
    }
    return read_text_stl(file, bytes);
}

/// A line of an OBJ file that begins with f.
struct ObjFace {
    std::string_view text;
    int line = 0;
    /// How many points stand above it.
    int n_points = 0;
};

/// The point of "7", "7/1", "7//3" or "-1/2/3", counted from 0.
int obj_corner(const TextCursor& cursor, std::string_view word, const ObjFace& face, int n_points) {
    const std::string_view digits = word.substr(0, word.find('/'));
    int number = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool is_number = code == std::errc() && end == digits.data() + digits.size();
    if (!is_number || number == 0 || number > n_points || number < -face.n_points) {
        cursor.fail("found {}; expected the number of a point, from 1 to {} or from -{} to -1",
                    in_quotes(word), n_points, face.n_points);
    }
    return number > 0 ? number - 1 : face.n_points + number;
}

TriangleSoup read_obj(const std::string& file, std::string_view text) {
    TriangleSoup soup;
    std::vector<ObjFace> faces;
    int line = 0;
    while (!text.empty()) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        TextCursor cursor(file, text.substr(0, length), '#', {}, ++line);
        const std::string_view keyword = cursor.peek();
        if (keyword == "v") {
            cursor.word("'v'");
            soup.points.emplace_back();
            for (double& x : soup.points.back()) {
                if (cursor.at_end()) {
                    cursor.fail("found {}; expected three numbers after 'v'",
                                in_quotes(text.substr(0, length)));
                }
                x = cursor.number("a coordinate of a point");
            }
        } else if (keyword == "f") {
            faces.push_back({text.substr(0, length), line, static_cast<int>(soup.points.size())});
        }
        text.remove_prefix(std::min(length + 1, text.size()));
    }
    std::vector<int> corners;
    for (const ObjFace& face : faces) {
        TextCursor cursor(file, face.text, '#', {}, face.line);
        cursor.word("'f'");
        corners.clear();
        while (!cursor.at_end()) {
            const std::string_view word = cursor.word("a corner");
            corners.push_back(obj_corner(cursor, word, face, static_cast<int>(soup.points.size())));
        }
        if (corners.size() < 3) {
            cursor.fail("found {}; a face has three corners or more", in_quotes(face.text));
        }
        add_fan(corners, soup);
    }
    return soup;
}

/// A number of things that take so many bytes each at least.
int read_count(TextCursor& cursor, const std::string& what, std::size_t n_bytes,
               std::size_t file_size) {
    const int count = cursor.integer("the number of " + what, 0, max_int);
    if (static_cast<std::size_t>(count) > file_size / n_bytes) {
        cursor.fail("found {} {}; a file of {} bytes holds {} at most", count, what, file_size,
                    file_size / n_bytes);
    }
    return count;
}

TriangleSoup read_off(const std::string& file, std::string_view text) {
    TextCursor cursor(file, text);
    const std::string_view header = cursor.word("'OFF'");
    if (header != "OFF" && header != "COFF" && header != "NOFF" && header != "CNOFF") {
        cursor.fail("found {}; expected 'OFF', 'COFF', 'NOFF' or 'CNOFF'", in_quotes(header));
    }
    if (cursor.peek() == "BINARY") {
        cursor.fail("found 'BINARY'; only OFF files in text can be read");
    }
    const int n_points = read_count(cursor, "points", 5, text.size());
    const int n_faces = read_count(cursor, "faces", 3, text.size());
    cursor.integer("the number of edges", 0, max_int);
    cursor.rest_of_line();
    TriangleSoup soup;
    for (int i = 0; i < n_points; ++i) {
        soup.points.push_back(read_point(cursor));
        // Colours and normals.
        cursor.rest_of_line();
    }
    std::vector<int> corners;
    for (int i = 0; i < n_faces; ++i) {
        corners.clear();
        const int n_corners = cursor.integer("the number of corners of a face", 1, max_int);
        for (int k = 0; k < n_corners; ++k) {
            corners.push_back(cursor.integer("a point of a face", 0, n_points - 1));
        }
        cursor.rest_of_line();
        add_fan(corners, soup);
    }
    cursor.expect_end("the faces");
    return soup;
}

/// For each point the first one that is equal to it.
std::vector<int> first_equals(const std::vector<Vector3>& points) {
    const auto key = [&](int i) {
        const Vector3& p = points[static_cast<std::size_t>(i)];
        return std::make_tuple(p.x(), p.y(), p.z());
    };
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return std::tuple_cat(key(a), std::make_tuple(a)) <
               std::tuple_cat(key(b), std::make_tuple(b));
    });
    std::vector<int> result(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_equal = i > 0 && key(order[i]) == key(order[i - 1]);
        result[static_cast<std::size_t>(order[i])] =
            is_equal ? result[static_cast<std::size_t>(order[i - 1])] : order[i];
    }
    return result;
}

/// Welds equal points, drops triangles with a point twice and points of no triangle.
TriangleSoup tidied(const TriangleSoup& soup) {
    const std::vector<int> first = first_equals(soup.points);
    TriangleSoup result;
    std::vector<int> numbers(soup.points.size(), -1);
    for (std::array<int, 3> triangle : soup.triangles) {
        for (int& vertex : triangle) {
            vertex = first[static_cast<std::size_t>(vertex)];
        }
        const auto [a, b, c] = triangle;
        if (a != b && b != c && c != a) {
            result.triangles.push_back(triangle);
            for (const int vertex : triangle) {
                numbers[static_cast<std::size_t>(vertex)] = 0;
            }
        }
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] == 0) {
            numbers[i] = static_cast<int>(result.points.size());
            result.points.push_back(soup.points[i]);
        }
    }
    for (std::array<int, 3>& triangle : result.triangles) {
        for (int& vertex : triangle) {
            vertex = numbers[static_cast<std::size_t>(vertex)];
        }
    }
    return result;
}

}  // namespace

TriangleSoup read_surface(const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::string ending = lower(path.extension().string());
    if (ending != ".stl" && ending != ".obj" && ending != ".off") {
        throw FileError(
            "{}: the ending '{}' is not that of a surface; expected '.stl', '.obj' or "
            "'.off'",
            file, path.extension().string());
    }
    const std::string bytes = read_text(path);
    if (bytes.empty()) {
        throw FileError("{}: the file is empty; expected triangles", file);
    }
    // Then points, lines and triangles are numbered by int: each takes a byte at least.
    if (bytes.size() > static_cast<std::size_t>(max_int)) {
        throw FileError("{}: the file has {} bytes; surfaces of up to {} can be read", file,
                        bytes.size(), max_int);
    }
    const TriangleSoup read = ending == ".stl"   ? read_stl(file, bytes)
                              : ending == ".obj" ? read_obj(file, bytes)
                                                 : read_off(file, bytes);
    TriangleSoup result = tidied(read);
    if (result.triangles.empty()) {
        throw FileError("{}: found no triangles{}; a surface has at least one", file,
                        read.triangles.empty() ? "" : " but such with a point twice");
    }
    return result;
}

}  // namespace couture::io
