#include "io/volumetric_layout_file.h"

#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <optional>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/raw_surface.h"
#include "meshing/layout/layout_validity.h"

namespace couture::io {

namespace {

using meshing::PlacedLayout;
using Hexahedron = std::array<int, 8>;

/// Corners in the order of Medit and VTK: those of one end in a circle, then of the other.
Hexahedron read_corners(TextCursor& cursor, int lowest, int n_points) {
    constexpr std::array<int, 8> place{0, 1, 3, 2, 4, 5, 7, 6};
    Hexahedron corners{};
    for (int k = 0; k < 8; ++k) {
        corners[place[k]] =
            cursor.integer("a point of a hexahedron", lowest, lowest + n_points - 1) - lowest;
    }
    return corners;
}

/// Of the hexahedron with bilinear sides: each is the mean of its two pairs of triangles.
double volume_of(const PlacedLayout& placed, int cuboid) {
    const Vector3& origin = placed.positions[placed.layout.cuboids[cuboid][0]];
    double six_volumes = 0.0;
    for (int side = 0; side < 6; ++side) {
        std::array<Vector3, 4> x;
        const auto nodes = placed.layout.nodes_of({cuboid, side});
        for (int k = 0; k < 4; ++k) x[k] = placed.positions[nodes[k]] - origin;
        for (int k = 0; k < 4; ++k) {
            six_volumes += 0.5 * x[k].dot(x[(k + 1) % 4].cross(x[(k + 2) % 4]));
        }
    }
    return six_volumes / 6.0;
}

void turn_mirrored(const std::string& name, PlacedLayout& placed) {
    for (int c = 0; c < placed.layout.n_cuboids(); ++c) {
        const double volume = volume_of(placed, c);
        if (volume == 0.0) throw FileError("{}: hexahedron {} has no volume", name, c);
        if (volume > 0.0) continue;
        auto& nodes = placed.layout.cuboids[c];
        for (int k = 0; k < 4; ++k) std::swap(nodes[k], nodes[k + 4]);
    }
}

/// Whole numbers of each entity of a Medit section that is passed over.
std::optional<int> n_values_of(std::string_view section) {
    static const std::map<std::string_view, int> n_values{
        {"Edges", 3},
        {"Triangles", 4},
        {"Quadrilaterals", 5},
        {"Tetrahedra", 5},
        {"Prisms", 7},
        {"Pyramids", 6},
        {"Corners", 1},
        {"Ridges", 1},
        {"RequiredVertices", 1},
        {"RequiredEdges", 1},
        {"RequiredTriangles", 1},
        {"RequiredQuadrilaterals", 1},
    };
    const auto found = n_values.find(section);
    return found == n_values.end() ? std::nullopt : std::optional(found->second);
}

constexpr int any = std::numeric_limits<int>::max();

}  // namespace

PlacedLayout make_placed_layout(const std::string& name, const std::vector<Vector3>& points,
                                std::vector<Hexahedron> hexahedra,
                                const std::vector<std::string>& names) {
    if (hexahedra.empty()) throw FileError("{}: has no hexahedra", name);
    std::vector<int> number(points.size(), -1);
    for (const auto& corners : hexahedra) {
        for (const int point : corners) number[point] = 0;
    }
    PlacedLayout placed;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (number[i] < 0) continue;
        number[i] = placed.layout.n_nodes++;
        placed.positions.push_back(points[i]);
        if (!names.empty()) placed.layout.node_names.push_back(names[i]);
    }
    for (auto& corners : hexahedra) {
        for (int& point : corners) point = number[point];
    }
    placed.layout.cuboids = std::move(hexahedra);
    turn_mirrored(name, placed);
    try {
        const meshing::QuadLayout boundary = meshing::layout_boundary(placed.layout).layout;
        const meshing::LayoutVerdict verdict =
            meshing::judge_layout(boundary, boundary.euler_characteristic());
        if (!verdict.is_cuboid_configuration) throw FileError("{}", verdict.reason);
    } catch (const Error& error) {
        throw FileError("{}: {}", name, error.what());
    }
    return placed;
}

PlacedLayout parse_medit_layout(const std::string& name, std::string_view text) {
    TextCursor cursor(name, text);
    cursor.expect("MeshVersionFormatted");
    cursor.integer("the version of the format", 1, 4);
    cursor.expect("Dimension");
    cursor.integer("the dimension", 3, 3);
    std::vector<Vector3> points;
    std::vector<Hexahedron> hexahedra;
    while (!cursor.at_end()) {
        const std::string_view section = cursor.word("a section, or 'End'");
        if (section == "End") break;
        if (section == "Vertices") {
            const int n = read_count(cursor, "vertices", 8, text.size());
            for (int i = 0; i < n; ++i) {
                points.push_back(read_point(cursor));
                cursor.integer("the reference of a vertex", -any, any);
            }
        } else if (section == "Hexahedra") {
            const int n = read_count(cursor, "hexahedra", 18, text.size());
            for (int i = 0; i < n; ++i) {
                hexahedra.push_back(read_corners(cursor, 1, static_cast<int>(points.size())));
                cursor.integer("the reference of a hexahedron", -any, any);
            }
        } else if (const auto n_values = n_values_of(section)) {
            const int n = read_count(cursor, "entities", 2, text.size());
            for (long i = 0; i < static_cast<long>(n) * *n_values; ++i) {
                cursor.integer("a number of an entity", -any, any);
            }
        } else {
            cursor.fail("found {}; expected Vertices, Hexahedra or another section of a mesh",
                        in_quotes(section));
        }
    }
    return make_placed_layout(name, points, std::move(hexahedra));
}

PlacedLayout parse_vtk_layout(const std::string& name, std::string_view text) {
    // The first two lines are a magic text and a title.
    const std::size_t first = text.find('\n');
    const std::size_t second = first == std::string_view::npos ? first : text.find('\n', first + 1);
    if (!text.starts_with("# vtk DataFile Version ") || second == std::string_view::npos) {
        throw FileError("{}: begins with no '# vtk DataFile Version ...' and title", name);
    }
    TextCursor cursor(name, text.substr(second + 1), 0, {}, 3);
    cursor.expect("ASCII");
    cursor.expect("DATASET");
    cursor.expect("UNSTRUCTURED_GRID");
    cursor.expect("POINTS");
    const int n_points = read_count(cursor, "points", 6, text.size());
    cursor.word("the type of the points");
    std::vector<Vector3> points;
    points.reserve(n_points);
    for (int i = 0; i < n_points; ++i) points.push_back(read_point(cursor));
    cursor.expect("CELLS");
    const int n_cells = read_count(cursor, "cells", 18, text.size());
    cursor.integer("the size of the cells (files of version 5 have none: write version 4)",
                   9 * n_cells, 9 * n_cells);
    std::vector<Hexahedron> hexahedra;
    for (int i = 0; i < n_cells; ++i) {
        cursor.integer("the number of points of a hexahedron", 8, 8);
        hexahedra.push_back(read_corners(cursor, 0, n_points));
    }
    cursor.expect("CELL_TYPES");
    cursor.integer("the number of cell types", n_cells, n_cells);
    constexpr int hexahedron_type = 12;
    for (int i = 0; i < n_cells; ++i) {
        cursor.integer("a cell's type (12, a hexahedron)", hexahedron_type, hexahedron_type);
    }
    return make_placed_layout(name, points, std::move(hexahedra));
}

PlacedLayout read_volumetric_layout(const std::filesystem::path& path) {
    const std::string ending = lower_case(path.extension().string());
    if (ending == ".mesh") return parse_medit_layout(path.string(), read_text(path));
    if (ending == ".vtk") return parse_vtk_layout(path.string(), read_text(path));
    throw FileError("{}: unknown ending '{}'; a layout is read from .mesh (Medit) or .vtk",
                    path.string(), ending);
}

}  // namespace couture::io
