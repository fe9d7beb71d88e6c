#pragma once

#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/text_cursor.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::io {

/// Points and polygons as a file has them.
struct RawSurface {
    std::vector<Vector3> points;
    /// Numbers of points, polygon by polygon.
    std::vector<int> corners;
    /// Where each polygon begins in `corners`; one more at the end.
    std::vector<int> first{0};

    [[nodiscard]] std::size_t n_polygons() const { return first.size() - 1; }
    [[nodiscard]] std::span<const int> polygon(std::size_t i) const {
        return std::span(corners).subspan(first[i], first[i + 1] - first[i]);
    }
    void add_polygon(std::span<const int> numbers) {
        corners.insert(corners.end(), numbers.begin(), numbers.end());
        first.push_back(static_cast<int>(corners.size()));
    }
    /// A triangle with points of its own.
    void add_triangle(const std::array<Vector3, 3>& triangle) {
        const int next = static_cast<int>(points.size());
        points.insert(points.end(), triangle.begin(), triangle.end());
        add_polygon(std::array{next, next + 1, next + 2});
    }
};

/// With small letters.
[[nodiscard]] inline std::string lower_case(std::string_view word) {
    std::string result(word);
    for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return result;
}

/// Takes three finite numbers.
[[nodiscard]] inline Vector3 read_point(TextCursor& cursor) {
    const double x = cursor.number("x of a point");
    const double y = cursor.number("y of a point");
    const double z = cursor.number("z of a point");
    return {x, y, z};
}

/// Takes a number of things that take so many bytes each at least.
///
/// @throws FileError  if a file of that size cannot hold so many
[[nodiscard]] inline int read_count(TextCursor& cursor, const std::string& what,
                                    std::size_t n_bytes, std::size_t file_size) {
    const int count = cursor.integer("the number of " + what, 0, std::numeric_limits<int>::max());
    if (static_cast<std::size_t>(count) > file_size / n_bytes) {
        cursor.fail("found {} {}; a file of {} bytes holds {} at most", count, what, file_size,
                    file_size / n_bytes);
    }
    return count;
}

}  // namespace couture::io
