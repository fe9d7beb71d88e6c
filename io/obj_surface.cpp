#include "io/obj_surface.h"

#include <algorithm>
#include <charconv>

#include "iga/core/error.h"
#include "io/atomic_file.h"

namespace couture::io {

namespace {

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

/// The text with the lines in one that end with a backslash and go on in the next; the line ends
/// that this takes away stand behind, so that the numbers of further lines stay.
std::string joined_lines(std::string_view text) {
    std::string joined;
    joined.reserve(text.size());
    std::size_t n_taken = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\') {
            const std::size_t end = text.find_first_not_of(" \t\r", i + 1);
            if (end != std::string_view::npos && text[end] == '\n') {
                joined += ' ';
                ++n_taken;
                i = end;
                continue;
            }
        }
        joined += text[i];
        if (text[i] != '\n') continue;
        joined.append(n_taken, '\n');
        n_taken = 0;
    }
    return joined;
}

}  // namespace

RawSurface read_obj(const std::string& file, std::string_view bytes) {
    const std::string joined = joined_lines(bytes);
    std::string_view text = joined;
    RawSurface surface;
    std::vector<ObjFace> faces;
    int line = 0;
    while (!text.empty()) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        TextCursor cursor(file, text.substr(0, length), '#', {}, ++line);
        const std::string_view keyword = cursor.peek();
        if (keyword == "v") {
            cursor.word("'v'");
            surface.points.emplace_back();
            for (double& x : surface.points.back()) {
                if (cursor.at_end()) {
                    cursor.fail("found {}; expected three numbers after 'v'",
                                in_quotes(text.substr(0, length)));
                }
                x = cursor.number("a coordinate of a point");
            }
        } else if (keyword == "f") {
            faces.push_back(
                {text.substr(0, length), line, static_cast<int>(surface.points.size())});
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
            corners.push_back(
                obj_corner(cursor, word, face, static_cast<int>(surface.points.size())));
        }
        if (corners.size() < 3) {
            cursor.fail("found {}; a face has three corners or more", in_quotes(face.text));
        }
        surface.add_polygon(corners);
    }
    return surface;
}

namespace {

template <std::size_t n>
std::string obj_text(const std::vector<Vector3>& points,
                     const std::vector<std::array<int, n>>& faces, const std::string& provenance) {
    std::string text = provenance.empty() ? "" : "# " + provenance + "\n";
    for (const Vector3& p : points) {
        text += fmt::format("v {} {} {}\n", exact(p.x()), exact(p.y()), exact(p.z()));
    }
    for (const auto& face : faces) {
        text += "f";
        for (const int vertex : face) text += fmt::format(" {}", vertex + 1);
        text += "\n";
    }
    return text;
}

}  // namespace

void write_obj(const std::filesystem::path& path, const meshing::TriangleSoup& soup,
               const std::string& provenance) {
    write_text(path, obj_text(soup.points, soup.triangles, provenance));
}

void write_obj(const std::filesystem::path& path, const meshing::QuadMesh& quads,
               const std::string& provenance) {
    write_text(path, obj_text(quads.points, quads.quads, provenance));
}

}  // namespace couture::io
