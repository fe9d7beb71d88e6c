#include "io/surface_reader.h"

#include <limits>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/obj_surface.h"
#include "io/off_surface.h"
#include "io/ply_surface.h"
#include "io/stl_surface.h"
#include "io/vtp_surface.h"
#include "meshing/surface/polygon_triangles.h"
#include "meshing/surface/repair.h"
#include "meshing/surface/soup_sides.h"

namespace couture::io {

namespace {

std::string ending_of(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

RawSurface read_raw(const std::filesystem::path& path, std::string_view bytes,
                    std::string& format) {
    const std::string file = path.string();
    const std::string ending = ending_of(path);
    if (ending == ".stl") {
        format = "STL";
        return read_stl(file, bytes);
    }
    if (ending == ".obj") {
        format = "Wavefront OBJ";
        return read_obj(file, bytes);
    }
    if (ending == ".off") {
        format = "OFF";
        return read_off(file, bytes);
    }
    if (ending == ".ply") {
        format = "PLY";
        return read_ply(file, bytes);
    }
    format = "VTK PolyData";
    return read_vtp(path, bytes);
}

/// What is left of a text behind the mark that some editors put before UTF-8. A binary STL may
/// begin with anything.
std::string_view without_mark(std::string_view bytes, const std::string& ending) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    if (!bytes.starts_with(mark)) return bytes;
    const std::string_view text = bytes.substr(mark.size());
    return ending != ".stl" || text.starts_with("solid") ? text : bytes;
}

/// Volumes of larger coordinates overflow.
void check_size(const std::string& file, const std::vector<Vector3>& points) {
    constexpr double largest = 1e100;
    for (std::size_t v = 0; v < points.size(); ++v) {
        const double size = points[v].cwiseAbs().maxCoeff();
        if (size <= largest) continue;
        throw FileError(
            "{}: a coordinate of point {} is as large as {:.3g}; areas and volumes overflow beyond "
            "{:.0e}: is it a damaged number, or a unit too small?",
            file, v, size, largest);
    }
}

/// Merges equal points and splits polygons.
void make_triangles(const std::string& file, RawSurface raw, SurfaceFile& result) {
    result.n_points_read = static_cast<int>(raw.points.size());
    result.n_polygons_read = static_cast<int>(raw.n_polygons());
    const std::vector<int> first = meshing::first_equal_points(raw.points);
    for (std::size_t v = 0; v < first.size(); ++v) {
        result.n_merged += first[v] == static_cast<int>(v) ? 0 : 1;
    }
    result.soup.points = std::move(raw.points);
    std::vector<int> polygon;
    for (std::size_t i = 0; i < raw.n_polygons(); ++i) {
        polygon.clear();
        for (const int corner : raw.polygon(i)) {
            if (polygon.empty() || first[corner] != polygon.back()) {
                polygon.push_back(first[corner]);
            }
        }
        while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
        if (polygon.size() > meshing::max_polygon_corners) {
            throw FileError("{}: polygon {} has {} corners; those with up to {} can be split", file,
                            i, polygon.size(), meshing::max_polygon_corners);
        }
        if (polygon.size() < 3) {
            ++result.n_degenerate;
            continue;
        }
        if (polygon.size() > 3) ++result.n_split;
        for (const auto& triangle : meshing::split_polygon(result.soup.points, polygon)) {
            const auto [a, b, c] = triangle;
            if (a == b || b == c || c == a) {
                ++result.n_degenerate;
            } else {
                result.soup.triangles.push_back(triangle);
            }
        }
    }
    result.n_unused = meshing::drop_unused_points(result.soup) - result.n_merged;
}

/// The file as it is, in bounds.
///
/// @param what  is expected in it, for messages
RawSurface read_checked(const std::filesystem::path& path, const char* what, std::string& format) {
    const std::string file = path.string();
    if (!is_surface_file(path)) {
        throw FileError(
            "{}: the ending '{}' is not that of a surface; expected '.stl', '.obj', '.off', '.ply' "
            "or '.vtp'",
            file, path.extension().string());
    }
    const std::string bytes = read_text(path);
    if (bytes.empty()) {
        throw FileError("{}: the file is empty; expected {}", file, what);
    }
    // Then points, lines and triangles are numbered by int: each takes a byte at least.
    constexpr int max_int = std::numeric_limits<int>::max();
    if (bytes.size() > static_cast<std::size_t>(max_int)) {
        throw FileError("{}: the file has {} bytes; surfaces of up to {} can be read", file,
                        bytes.size(), max_int);
    }
    RawSurface raw = read_raw(path, without_mark(bytes, ending_of(path)), format);
    check_size(file, raw.points);
    return raw;
}

}  // namespace

bool is_surface_file(const std::filesystem::path& path) {
    const std::string ending = ending_of(path);
    return ending == ".stl" || ending == ".obj" || ending == ".off" || ending == ".ply" ||
           ending == ".vtp";
}

SurfaceFile read_surface_file(const std::filesystem::path& path) {
    SurfaceFile result;
    RawSurface raw = read_checked(path, "triangles", result.format);
    const std::string file = path.string();
    make_triangles(file, std::move(raw), result);
    if (result.soup.triangles.empty()) {
        throw FileError("{}: found no triangles{}; a surface has at least one", file,
                        result.n_degenerate == 0 ? "" : " but such with a point twice");
    }
    return result;
}

RawSurface read_polygons(const std::filesystem::path& path) {
    std::string format;
    RawSurface raw = read_checked(path, "polygons", format);
    if (raw.n_polygons() == 0) {
        throw FileError("{}: found no polygons; a surface has at least one", path.string());
    }
    return raw;
}

meshing::TriangleSoup read_surface(const std::filesystem::path& path) {
    return read_surface_file(path).soup;
}

}  // namespace couture::io
