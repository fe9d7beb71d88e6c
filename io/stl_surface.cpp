#include "io/stl_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <tuple>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "meshing/surface/repair.h"

namespace couture::io {

namespace {

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        result |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    }
    return result;
}

// Binary STL: 80 bytes of title, the number of triangles, 50 bytes for each.
constexpr std::size_t title_size = 80;
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

RawSurface read_binary_stl(const std::string& file, std::string_view bytes) {
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
    RawSurface surface;
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
        surface.add_triangle(corners);
    }
    return surface;
}

void expect_words(TextCursor& cursor, std::initializer_list<std::string_view> keywords) {
    for (const std::string_view keyword : keywords) {
        const std::string_view found = cursor.word(fmt::format("'{}'", keyword));
        if (lower_case(found) != keyword) {
            cursor.fail("found {}; expected '{}'", in_quotes(found), keyword);
        }
    }
}

RawSurface read_text_stl(const std::string& file, std::string_view text) {
    TextCursor cursor(file, text, 0);
    RawSurface surface;
    while (!cursor.at_end()) {
        expect_words(cursor, {"solid"});
        cursor.rest_of_line();
        while (true) {
            const std::string_view found = cursor.word("'facet' or 'endsolid'");
            if (lower_case(found) == "endsolid") {
                cursor.rest_of_line();
                break;
            }
            if (lower_case(found) != "facet") {
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
            surface.add_triangle(corners);
        }
    }
    return surface;
}

}  // namespace

RawSurface read_stl(const std::string& file, std::string_view bytes) {
    if (is_whole_binary_stl(bytes) || !is_text(bytes)) {
        return read_binary_stl(file, bytes);
    }
    TextCursor cursor(file, bytes, 0);
    if (lower_case(cursor.peek()) != "solid") {
        const std::string_view found = cursor.word("'solid'");
        cursor.fail("found {}; an STL file begins with 'solid', or is binary", in_quotes(found));
    }
    return read_text_stl(file, bytes);
}

std::vector<std::string> write_stl(const std::filesystem::path& path,
                                   const meshing::TriangleSoup& soup,
                                   const std::string& provenance) {
    std::vector<Vector3> rounded;
    for (const Vector3& point : soup.points) {
        const Eigen::Vector3f single = point.cast<float>();
        if (!single.allFinite()) {
            throw InputError(
                "{}: the point ({}, {}, {}) is beyond the single precision of STL; write .obj, "
                ".off, .ply or .vtp",
                path.string(), point.x(), point.y(), point.z());
        }
        rounded.emplace_back(single.cast<double>());
    }
    std::vector<std::string> warnings;
    const auto count_different = [](const std::vector<Vector3>& points) {
        const std::vector<int> first = meshing::first_equal_points(points);
        int n = 0;
        for (std::size_t v = 0; v < first.size(); ++v) n += first[v] == static_cast<int>(v) ? 1 : 0;
        return n;
    };
    const int n_merged = count_different(soup.points) - count_different(rounded);
    if (n_merged > 0) {
        warnings.push_back(fmt::format(
            "{}: {} points become equal to others in the single precision of STL and will be "
            "merged when it is read; .obj, .off, .ply and .vtp keep all digits",
            path.string(), n_merged));
    }
    std::string bytes = provenance.substr(0, title_size);
    bytes.resize(title_size, ' ');
    const auto append = [&](std::uint32_t value) {
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
    };
    append(static_cast<std::uint32_t>(soup.triangles.size()));
    for (const auto& [a, b, c] : soup.triangles) {
        Vector3 normal = (soup.points[b] - soup.points[a]).cross(soup.points[c] - soup.points[a]);
        const double length = normal.norm();
        normal = length > 0.0 ? Vector3(normal / length) : Vector3::Zero();
        for (const Vector3& vector : {normal, soup.points[a], soup.points[b], soup.points[c]}) {
            for (const double x : vector) {
                append(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
            }
        }
        bytes.append(2, '\0');
    }
    write_text(path, bytes);
    return warnings;
}

}  // namespace couture::io
