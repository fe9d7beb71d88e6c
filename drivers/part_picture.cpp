#include "drivers/part_picture.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "io/dimension_lines.h"
#include "meshing/parts/part_dimensions.h"
#include "meshing/parts/part_section.h"
#include "meshing/parts/part_surface.h"

namespace couture::drivers {

namespace {

using namespace meshing;
using Values = std::map<std::string, double>;

constexpr io::Color part_grey{0.86, 0.87, 0.88};
constexpr io::Color cap_tint{0.98, 0.80, 0.52};
constexpr io::Color cut_tint{0.66, 0.76, 0.88};
constexpr io::Color cap_edge_tint{0.88, 0.50, 0.05};
constexpr double feature_width = 1.6;
constexpr double silhouette_width = 1.3;
constexpr double cap_edge_width = 3.0;
constexpr double text_scale = 0.8;
/// The part's longest side in the views that are to scale, and the diagonal of the view of the
/// whole, in pixels.
constexpr double longest_side = 420.0;
constexpr double whole_size = 370.0;
/// Of a row of views, in pixels.
constexpr int widest_row = 1250;
/// Left of the whole for the axes, and below each view for what it is.
constexpr int axes_room = 90;
constexpr int caption_room = 26;
constexpr double label_gap = 8.0;

/// Parts whose views across an axis (0, 1, 2) are sections through the middle.
bool is_section(const std::string& part, int axis) {
    return (part == "wheel" && axis == 0) || (part == "casting" && axis == 1) ||
           (part == "torus" && axis == 1);
}

/// What a view shows of a part, before its colours.
struct Shape {
    TriangleSoup soup;
    std::vector<int> face_of_triangle;
    TriangleSoup cut;
    std::vector<std::vector<Vector3>> curves;
};

Shape make_shape(const PartSurface& part) {
    Shape shape{part.soup, part.face_of_triangle, {}, {}};
    for (const PartCurve& curve : part.feature_curves) {
        shape.curves.emplace_back();
        for (const int v : curve.vertices) {
            shape.curves.back().push_back(part.soup.points[v]);
        }
        if (curve.is_closed) {
            shape.curves.back().push_back(shape.curves.back().front());
        }
    }
    return shape;
}

Shape make_section(const PartSurface& part, int axis, int kept) {
    PartSection section = cut_part(part, axis, 0.0, kept);
    Shape shape{std::move(section.rest), std::move(section.face_of_triangle),
                std::move(section.cut), std::move(section.feature_curves)};
    for (std::vector<Vector3>& outline : section.outlines) {
        outline.push_back(outline.front());
        shape.curves.push_back(outline);
    }
    return shape;
}

struct Box {
    Vector3 low;
    Vector3 high;
};

Box box_of(const std::vector<Vector3>& points) {
    Box box{points.front(), points.front()};
    for (const Vector3& x : points) {
        box.low = box.low.cwiseMin(x);
        box.high = box.high.cwiseMax(x);
    }
    return box;
}

MatrixX to_matrix(const std::vector<Vector3>& points) {
    MatrixX matrix(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        matrix.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    }
    return matrix;
}

void add_triangles(io::Scene& scene, const std::vector<Vector3>& points,
                   const std::vector<std::array<int, 3>>& triangles, const io::Color& color) {
    if (triangles.empty()) {
        return;
    }
    io::SurfacePiece piece;
    std::vector<int> number(points.size(), -1);
    std::vector<Vector3> used;
    piece.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            int& n = number[triangles[t][k]];
            if (n < 0) {
                n = static_cast<int>(used.size());
                used.push_back(points[triangles[t][k]]);
            }
            piece.triangles(static_cast<Eigen::Index>(t), k) = n;
        }
    }
    piece.vertices = to_matrix(used);
    piece.color = color;
    scene.surfaces.push_back(std::move(piece));
}

using Edge = std::pair<int, int>;

/// Paths of vertices that contain each edge once.
std::vector<std::vector<int>> chain(const std::vector<Edge>& edges) {
    std::map<int, std::set<int>> neighbours;
    for (const auto& [a, b] : edges) {
        neighbours[a].insert(b);
        neighbours[b].insert(a);
    }
    std::vector<std::vector<int>> paths;
    for (const auto& [a, b] : edges) {
        while (!neighbours[a].empty()) {
            paths.push_back({a});
            for (int at = a; !neighbours[at].empty();) {
                const int next = *neighbours[at].begin();
                neighbours[at].erase(next);
                neighbours[next].erase(at);
                paths.back().push_back(next);
                at = next;
            }
        }
    }
    return paths;
}

/// Edges at which the surface turns away from the viewer, and those around caps.
void add_edges(io::Scene& scene, const PartSurface& part, const Shape& shape) {
    struct Sides {
        int n = 0;
        int n_seen = 0;
        int n_caps = 0;
    };
    std::map<Edge, Sides> edges;
    const std::vector<Vector3>& x = shape.soup.points;
    for (std::size_t t = 0; t < shape.soup.triangles.size(); ++t) {
        const auto& triangle = shape.soup.triangles[t];
        const auto& [a, b, c] = triangle;
        const Vector3 normal = (x[b] - x[a]).cross(x[c] - x[a]).normalized();
        constexpr double rounding = 1e-9;
        for (int k = 0; k < 3; ++k) {
            Sides& sides = edges[std::minmax(triangle[k], triangle[(k + 1) % 3])];
            ++sides.n;
            sides.n_seen += normal.dot(scene.view_direction) < -rounding ? 1 : 0;
            sides.n_caps += part.faces[shape.face_of_triangle[t]].is_cap ? 1 : 0;
        }
    }
    std::vector<Edge> silhouette;
    std::vector<Edge> around_caps;
    for (const auto& [edge, sides] : edges) {
        if (sides.n == 2 && sides.n_caps == 1 && sides.n_seen > 0) {
            around_caps.push_back(edge);
        } else if (sides.n == 2 && sides.n_seen == 1) {
            silhouette.push_back(edge);
        }
    }
    // Towards the viewer, before what they lie on.
    const Box box = box_of(x);
    const Vector3 lift = 2e-3 * (box.high - box.low).norm() * scene.view_direction.normalized();
    const auto add = [&](const std::vector<Edge>& some, double width, const io::Color& color) {
        for (const std::vector<int>& path : chain(some)) {
            io::CurvePiece piece;
            piece.points.resize(static_cast<Eigen::Index>(path.size()), 3);
            for (std::size_t i = 0; i < path.size(); ++i) {
                piece.points.row(static_cast<Eigen::Index>(i)) = (x[path[i]] - lift).transpose();
            }
            piece.width = width;
            piece.color = color;
            scene.curves.push_back(std::move(piece));
        }
    };
    add(silhouette, silhouette_width, io::CurvePiece().color);
    add(around_caps, cap_edge_width, cap_edge_tint);
}

io::Scene make_scene(const PartSurface& part, const Shape& shape, const Vector3& view_direction) {
    io::Scene scene;
    scene.view_direction = view_direction;
    scene.text_scale = text_scale;
    scene.show_axes = false;
    std::array<std::vector<std::array<int, 3>>, 2> triangles;
    for (std::size_t t = 0; t < shape.soup.triangles.size(); ++t) {
        const bool is_cap = part.faces[shape.face_of_triangle[t]].is_cap;
        triangles[is_cap ? 1 : 0].push_back(shape.soup.triangles[t]);
    }
    add_triangles(scene, shape.soup.points, triangles[0], part_grey);
    add_triangles(scene, shape.soup.points, triangles[1], cap_tint);
    add_triangles(scene, shape.cut.points, shape.cut.triangles, cut_tint);
    for (const std::vector<Vector3>& curve : shape.curves) {
        io::CurvePiece piece;
        piece.points = to_matrix(curve);
        piece.width = feature_width;
        scene.curves.push_back(std::move(piece));
    }
    add_edges(scene, part, shape);
    return scene;
}

std::string text_of(const PartDimension& dimension) {
    const std::string number = fmt::format("{:.6g}", dimension.value);
    if (!dimension.parameter.empty()) {
        const char* addition = dimension.kind == DimensionKind::diameter ? " (diameter)" : "";
        return dimension.parameter + " = " + number + addition;
    }
    switch (dimension.kind) {
        case DimensionKind::radius:
            return "radius " + number;
        case DimensionKind::diameter:
            return "diameter " + number;
        default:
            return number;
    }
}

/// The axis that a size is seen along.
int view_axis_of(const PartDimension& dimension) {
    if (dimension.offset.isZero()) {
        return 2;
    }
    int axis = 0;
    dimension.along.cross(dimension.offset).cwiseAbs().maxCoeff(&axis);
    return axis;
}

/// Unit vector out of a cap, and its middle.
std::pair<Vector3, Vector3> normal_and_middle(const PartSurface& part, int face) {
    Vector3 normal = Vector3::Zero();
    std::vector<Vector3> points;
    for (std::size_t t = 0; t < part.soup.triangles.size(); ++t) {
        if (part.face_of_triangle[t] == face) {
            const auto& [a, b, c] = part.soup.triangles[t];
            const std::vector<Vector3>& x = part.soup.points;
            normal += (x[b] - x[a]).cross(x[c] - x[a]);
            points.insert(points.end(), {x[a], x[b], x[c]});
        }
    }
    const Box box = box_of(points);
    return {normal.normalized(), 0.5 * (box.low + box.high)};
}

/// Names the caps at their edges, inside of the part.
void add_cap_names(io::Scene& scene, const PartSurface& part, double pixels_per_unit) {
    const Matrix<3> axes = io::view_axes(scene);
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        if (part.faces[f].is_cap) {
            const auto [normal, middle] = normal_and_middle(part, static_cast<int>(f));
            const double half = 0.5 * text_scale * io::label_size(part.faces[f].name).y();
            const Vector3 seen = axes.transpose() * normal;
            // Along the cap's edge, or in its middle if it is seen from the front.
            const double back = (half + label_gap) * seen.head<2>().norm() / pixels_per_unit;
            const double angle =
                std::abs(seen.x()) > std::abs(seen.y()) ? std::numbers::pi / 2 : 0.0;
            scene.labels.push_back({middle - back * normal, part.faces[f].name, angle});
        }
    }
}

void add_caption(io::Scene& scene, const std::string& text, double pixels_per_unit) {
    const Matrix<3> axes = io::view_axes(scene);
    const Vector2& center = scene.frame->center;
    const double low = center.y() - 0.5 * scene.frame->height;
    scene.labels.push_back(
        {axes * Vector3(center.x(), low - 0.3 * caption_room / pixels_per_unit, 0.0), text});
    scene.height += caption_room;
    scene.frame->height += caption_room / pixels_per_unit;
    scene.frame->center.y() -= 0.5 * caption_room / pixels_per_unit;
}

/// Views from +x, -y and +z.
io::Scene make_view(const std::string& name, const PartSurface& part, int axis,
                    const std::vector<PartDimension>& dimensions, double pixels_per_unit,
                    bool with_caps) {
    const int from = axis == 1 ? -1 : 1;
    const bool is_cut = is_section(name, axis);
    io::Scene scene = make_scene(part, is_cut ? make_section(part, axis, -from) : make_shape(part),
                                 -from * Vector3::Unit(axis));
    scene.up = axis == 2 ? Vector3::UnitY() : Vector3::UnitZ();
    std::vector<io::DimensionLine> lines;
    for (const PartDimension& dimension : dimensions) {
        if (view_axis_of(dimension) == axis) {
            lines.push_back({dimension.from, dimension.to, dimension.along, dimension.offset,
                             dimension.offset.isZero() && dimension.kind == DimensionKind::radius,
                             text_of(dimension)});
        }
    }
    if (with_caps) {
        add_cap_names(scene, part, pixels_per_unit);
    }
    io::add_dimension_lines(scene, lines, pixels_per_unit);
    constexpr std::array<const char*, 3> names = {"x", "y", "z"};
    add_caption(
        scene,
        fmt::format("{}seen from {}{}", is_cut ? fmt::format("section {} = 0, ", names[axis]) : "",
                    from > 0 ? "+" : "-", names[axis]),
        pixels_per_unit);
    return scene;
}

io::Scene make_whole(const PartSurface& part) {
    io::Scene scene = make_scene(part, make_shape(part), io::Scene().view_direction);
    const Box box = box_of(part.soup.points);
    const double size = (box.high - box.low).norm();
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        if (part.faces[f].is_cap) {
            const auto [normal, middle] = normal_and_middle(part, static_cast<int>(f));
            scene.labels.push_back({middle + 0.1 * size * normal, part.faces[f].name, 0.0, true});
        }
    }
    const double pixels_per_unit = whole_size / size;
    io::add_dimension_lines(scene, {}, pixels_per_unit);
    scene.width += axes_room;
    scene.frame->center.x() -= 0.5 * axes_room / pixels_per_unit;
    scene.show_axes = true;
    return scene;
}

}  // namespace

Values picture_parameters(const std::string& part) {
    if (part == "pant") {
        return {{"X1", 25.0},  {"Y1", -30.0}, {"Z1", 25.0}, {"X2", 25.0}, {"Y2", 30.0},
                {"Z2", -30.0}, {"X3", 35.0},  {"Y3", 25.0}, {"Z3", 30.0}};
    }
    return {};
}

std::vector<std::vector<io::Scene>> make_part_views(const std::string& part,
                                                    const Values& parameters) {
    Values values = parameters;
    values.merge(picture_parameters(part));
    const PartSurface surface = make_part_surface(part, values);
    const std::vector<PartDimension> dimensions = part_dimensions(part, values);
    const Box box = box_of(surface.soup.points);
    const double pixels_per_unit = longest_side / (box.high - box.low).maxCoeff();
    std::vector<io::Scene> views;
    for (const int axis : {2, 1, 0}) {
        if (std::any_of(dimensions.begin(), dimensions.end(),
                        [axis](const PartDimension& one) { return view_axis_of(one) == axis; })) {
            views.push_back(
                make_view(part, surface, axis, dimensions, pixels_per_unit, views.empty()));
        }
    }
    views.insert(views.begin() + 1, make_whole(surface));
    std::vector<std::vector<io::Scene>> rows;
    int width = 0;
    for (io::Scene& view : views) {
        if (rows.empty() || width + view.width > widest_row) {
            rows.emplace_back();
            width = 0;
        }
        width += view.width;
        rows.back().push_back(std::move(view));
    }
    return rows;
}

void write_part_picture(const std::filesystem::path& path, const std::string& part,
                        const Values& parameters) {
    io::render_png(path, make_part_views(part, parameters));
}

}  // namespace couture::drivers
