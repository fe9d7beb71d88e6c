#include "io/off_surface.h"

#include <limits>

#include "iga/core/error.h"
#include "io/atomic_file.h"

namespace couture::io {

RawSurface read_off(const std::string& file, std::string_view text) {
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
    cursor.integer("the number of edges", 0, std::numeric_limits<int>::max());
    cursor.rest_of_line();
    RawSurface surface;
    for (int i = 0; i < n_points; ++i) {
        surface.points.push_back(read_point(cursor));
        // Colours and normals.
        cursor.rest_of_line();
    }
    std::vector<int> corners;
    for (int i = 0; i < n_faces; ++i) {
        corners.clear();
        const int n_corners =
            cursor.integer("the number of corners of a face", 1, std::numeric_limits<int>::max());
        for (int k = 0; k < n_corners; ++k) {
            corners.push_back(cursor.integer("a point of a face", 0, n_points - 1));
        }
        cursor.rest_of_line();
        surface.add_polygon(corners);
    }
    cursor.expect_end("the faces");
    return surface;
}

void write_off(const std::filesystem::path& path, const meshing::TriangleSoup& soup,
               const std::string& provenance) {
    std::string text = "OFF\n" + (provenance.empty() ? "" : "# " + provenance + "\n");
    text += fmt::format("{} {} 0\n", soup.points.size(), soup.triangles.size());
    for (const Vector3& p : soup.points) {
        text += fmt::format("{} {} {}\n", exact(p.x()), exact(p.y()), exact(p.z()));
    }
    for (const auto& [a, b, c] : soup.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
    write_text(path, text);
}

}  // namespace couture::io
