#include "meshing/parts/block_surfaces.h"

#include <fmt/format.h>

#include <array>
#include <map>

namespace couture::meshing {

namespace {

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};
constexpr std::array<const char*, 2> end_names = {"low", "high"};

using Cell = std::array<int, 3>;

/// Vertices of a grid, each made when it is first asked for.
class VertexGrid {
  public:
    VertexGrid(PartSurfaceBuilder& builder, double spacing)
        : builder_(builder), spacing_(spacing) {}

    int operator()(const Cell& at) {
        const auto [entry, is_new] = numbers_.try_emplace(at, -1);
        if (is_new) {
            entry->second = builder_.add_vertex(spacing_ * Vector3(at[0], at[1], at[2]));
        }
        return entry->second;
    }

    /// Corners of the rectangle across `axis` between two opposite ones.
    std::vector<int> rectangle(int axis, const Cell& low, const Cell& high) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        Cell second = low;
        second[u] = high[u];
        Cell fourth = low;
        fourth[v] = high[v];
        return {(*this)(low), (*this)(second), (*this)(high), (*this)(fourth)};
    }

  private:
    PartSurfaceBuilder& builder_;
    double spacing_;
    std::map<Cell, int> numbers_;
};

void build_cube(const PartValues& values, PartSurfaceBuilder& builder) {
    VertexGrid grid(builder, values.at("length"));
    for (int axis = 0; axis < 3; ++axis) {
        for (int end = 0; end < 2; ++end) {
            const int face = builder.add_face(
                fmt::format("{}_{}", axis_names[axis], end_names[end]), PartFaceKind::plane);
            Cell low = {0, 0, 0};
            Cell high = {1, 1, 1};
            low[axis] = high[axis] = end;
            builder.add_polygon(face, grid.rectangle(axis, low, high), axis, end == 1 ? 1 : -1);
        }
    }
}

std::vector<int> lines_around(PartSurfaceBuilder& builder, const std::vector<int>& vertices) {
    std::vector<int> lines;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        lines.push_back(builder.add_line(vertices[i], vertices[(i + 1) % vertices.size()]));
    }
    return lines;
}

// In thirds of the length: tunnels through the middle third of each face meet in the middle.
void build_sierpinski(const PartValues& values, PartSurfaceBuilder& builder) {
    VertexGrid grid(builder, values.at("length") / 3.0);
    for (int axis = 0; axis < 3; ++axis) {
        for (int end = 0; end < 2; ++end) {
            const std::string name = fmt::format("{}_{}", axis_names[axis], end_names[end]);
            const int face = builder.add_face(name, PartFaceKind::plane);
            Cell low = {0, 0, 0};
            Cell high = {3, 3, 3};
            Cell hole_low = {1, 1, 1};
            Cell hole_high = {2, 2, 2};
            low[axis] = high[axis] = hole_low[axis] = hole_high[axis] = 3 * end;
            builder.add_polygon(face, grid.rectangle(axis, low, high), axis, end == 1 ? 1 : -1,
                                lines_around(builder, grid.rectangle(axis, hole_low, hole_high)));
            for (int across = 0; across < 3; ++across) {
                for (int side = 0; side < 2 && across != axis; ++side) {
                    const int wall = builder.add_face(
                        fmt::format("tunnel_{}_{}_{}", name, axis_names[across], end_names[side]),
                        PartFaceKind::plane);
                    Cell a = {1, 1, 1};
                    Cell b = {2, 2, 2};
                    a[axis] = 2 * end;
                    b[axis] = 2 * end + 1;
                    a[across] = b[across] = side + 1;
                    builder.add_polygon(wall, grid.rectangle(across, a, b), across,
                                        side == 0 ? 1 : -1);
                }
            }
        }
    }
}

void build_cylinder(const PartValues& values, PartSurfaceBuilder& builder) {
    const double radius = values.at("radius");
    const int wall = builder.add_face("wall", PartFaceKind::cylinder);
    const int bottom = builder.add_face("z_low", PartFaceKind::plane, true);
    const int top = builder.add_face("z_high", PartFaceKind::plane, true);
    const auto low = builder.add_circle(Vector3::Zero(), radius);
    const auto high = builder.add_circle({0.0, 0.0, values.at("length")}, radius);
    builder.add_cylinder(wall, low, high, Facing::outwards);
    builder.add_plane_sheet(bottom, low.arcs, 2, -1);
    builder.add_plane_sheet(top, high.arcs, 2, 1);
}

}  // namespace

std::vector<PartSurfaceDefinition> block_surfaces() {
    return {{{"cube",
              "The cube [0, length]^3, in mm. Faces: x_low, x_high, y_low, y_high, z_low, z_high.",
              {{"length", 100.0, 10.0, 1000.0, "edge length, mm"}}},
             5.0,
             build_cube},
            {{"cylinder",
              "A round bar about z, 0 <= z <= length, in mm. Faces: wall; caps z_low, z_high.",
              {{"radius", 30.0, 10.0, 100.0, "radius, mm"},
               {"length", 100.0, 20.0, 500.0, "size along z, mm"}}},
             4.0,
             build_cylinder},
            {{"sierpinski",
              "The sponge of level 1 in [0, length]^3, in mm: square tunnels through the middle "
              "third along each axis. Faces: x_low to z_high as of the cube; tunnel_x_low_y_low "
              "and so on: the wall on the side y low of the tunnel that opens at x_low.",
              {{"length", 90.0, 30.0, 300.0, "edge length, mm"}}},
             3.0,
             build_sierpinski}};
}

}  // namespace couture::meshing
