#include "meshing/parts/part_surface_builder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <set>

#include "meshing/parts/planar_mesh.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

/// Angle between two edges of a curve in a row, and angle that an edge spans on a curved face.
constexpr double largest_turn = pi / 12;
constexpr double largest_span = pi / 9;
/// Places at which a curve's length and turn are measured.
constexpr int n_probes = 256;
/// Between a vertex and the end of a curve, mm.
[[maybe_unused]] constexpr double place_tolerance = 1e-9;
/// How fast edges grow with the distance from shorter ones on the boundary.
constexpr double growth = 0.35;
/// Boundary edges this much shorter than the target ask for grading.
constexpr double shorter = 0.95;

double signed_area(const std::vector<Vector2>& loop) {
    double twice = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vector2& a = loop[i];
        const Vector2& b = loop[(i + 1) % loop.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice / 2;
}

/// Edge lengths in the plane: the target's, shorter where the surface is curved and near shorter
/// edges of the boundary.
PlanarSize graded_size(const std::vector<std::vector<Vector2>>& loops, double target,
                       const SheetMap& map) {
    struct Source {
        Vector2 at;
        double size;
    };
    const auto far_size = [target, scale = map.scale, radius = map.radius](const Vector2& p) {
        const double size = radius ? std::min(target, largest_span * radius(p)) : target;
        return scale ? size / scale(p) : size;
    };
    std::vector<Source> sources;
    for (const std::vector<Vector2>& loop : loops) {
        const std::size_t n = loop.size();
        for (std::size_t i = 0; i < n; ++i) {
            const double before = (loop[i] - loop[(i + n - 1) % n]).norm();
            const double behind = (loop[(i + 1) % n] - loop[i]).norm();
            const double size = (before + behind) / 2;
            if (size < shorter * far_size(loop[i])) {
                sources.push_back({loop[i], size});
            }
        }
    }
    return [far_size, sources](const Vector2& p) {
        double size = far_size(p);
        for (const Source& source : sources) {
            if (source.size < size) {
                size = std::min(size, source.size + growth * (source.at - p).norm());
            }
        }
        return size;
    };
}

std::string with_place(std::string name, const std::string& place) {
    return place.empty() ? name : name + "-" + place;
}

}  // namespace

PartSurfaceBuilder::PartSurfaceBuilder(double target_edge_length)
    : target_edge_length_(target_edge_length) {}

int PartSurfaceBuilder::add_face(std::string name, PartFaceKind kind, bool is_cap) {
    faces_.push_back({std::move(name), kind, is_cap});
    return static_cast<int>(faces_.size()) - 1;
}

int PartSurfaceBuilder::add_vertex(const Vector3& point, std::string place) {
    ends_.push_back(static_cast<int>(points_.size()));
    points_.push_back(point);
    vertex_places_.push_back(std::move(place));
    return static_cast<int>(ends_.size()) - 1;
}

int PartSurfaceBuilder::add_curve(int from, int to, const std::function<Vector3(double)>& point,
                                  std::string place) {
    // In edges from the start: each has the target length or the largest turn, whichever is less.
    std::vector<double> n_edges_to = {0.0};
    Vector3 last = point(0.0);
    Vector3 last_step = point(1.0 / n_probes) - last;
    assert((last - this->point(from)).norm() < place_tolerance);
    assert((point(1.0) - this->point(to)).norm() < place_tolerance);
    for (int i = 1; i <= n_probes; ++i) {
        const Vector3 next = point(static_cast<double>(i) / n_probes);
        const Vector3 step = next - last;
        const double turn = std::atan2(last_step.cross(step).norm(), last_step.dot(step));
        n_edges_to.push_back(n_edges_to.back() +
                             std::max(step.norm() / target_edge_length_, turn / largest_turn));
        last = next;
        last_step = step;
    }
    const double total = n_edges_to.back();
    const int n = std::max(1, static_cast<int>(std::lround(total)));
    Curve curve{from, to, {ends_[from]}, std::move(place)};
    int i = 0;
    for (int k = 1; k < n; ++k) {
        const double wanted = total * k / n;
        while (n_edges_to[i + 1] < wanted) {
            ++i;
        }
        const double part = (wanted - n_edges_to[i]) / (n_edges_to[i + 1] - n_edges_to[i]);
        curve.points.push_back(static_cast<int>(points_.size()));
        points_.push_back(point((i + part) / n_probes));
    }
    curve.points.push_back(ends_[to]);
    curves_.push_back(std::move(curve));
    return static_cast<int>(curves_.size()) - 1;
}

int PartSurfaceBuilder::add_line(int from, int to, std::string place) {
    const std::pair<int, int> key = std::minmax(from, to);
    const auto entry = lines_.find(key);
    if (entry != lines_.end()) {
        return entry->second;
    }
    const Vector3 a = point(from);
    const Vector3 b = point(to);
    const int curve = add_curve(
        from, to, [&](double t) -> Vector3 { return (1.0 - t) * a + t * b; }, std::move(place));
    lines_[key] = curve;
    return curve;
}

int PartSurfaceBuilder::add_arc(int from, int to, const Vector3& centre, double sweep,
                                std::string place) {
    const Vector3 start = point(from) - centre;
    return add_curve(
        from, to,
        [&](double t) -> Vector3 {
            const double c = std::cos(t * sweep);
            const double s = std::sin(t * sweep);
            return {centre.x() + c * start.x() - s * start.y(),
                    centre.y() + s * start.x() + c * start.y(), centre.z() + start.z()};
        },
        std::move(place));
}

PartSurfaceBuilder::Circle PartSurfaceBuilder::add_circle(const Vector3& centre, double radius,
                                                          double start_angle,
                                                          const std::string& place) {
    Circle circle{centre, radius, start_angle, {}, {}};
    const Vector3 spoke = radius * Vector3(std::cos(start_angle), std::sin(start_angle), 0.0);
    const int start = add_vertex(centre + spoke);
    const int opposite = add_vertex(centre - spoke);
    circle.vertices = {start, opposite};
    circle.arcs = {add_arc(start, opposite, centre, pi, place),
                   add_arc(opposite, start, centre, pi, place)};
    return circle;
}

void PartSurfaceBuilder::add_sheet(int face, const std::vector<int>& curves, SheetMap map) {
    sheets_.push_back({face, curves, std::move(map)});
}

void PartSurfaceBuilder::add_plane_sheet(int face, const std::vector<int>& curves, int axis,
                                         int sign) {
    add_sheet(face, curves,
              coordinate_plane_map(axis, sign, points_[curves_[curves.front()].points.front()]));
}

void PartSurfaceBuilder::add_cylinder(int face, const Circle& low, const Circle& high,
                                      Facing facing, const std::vector<std::vector<int>>& holes) {
    const std::array<int, 2> seams = {add_line(low.vertices[0], high.vertices[0]),
                                      add_line(low.vertices[1], high.vertices[1])};
    for (int half = 0; half < 2; ++half) {
        std::vector<int> curves = {low.arcs[half], seams[0], high.arcs[half], seams[1]};
        curves.insert(curves.end(), holes[half].begin(), holes[half].end());
        add_sheet(
            face, curves,
            cylinder_map(low.centre, low.radius, low.start_angle + (half + 0.5) * pi, facing));
    }
}

void PartSurfaceBuilder::add_polygon(int face, const std::vector<int>& vertices, int axis, int sign,
                                     const std::vector<int>& holes) {
    std::vector<int> curves;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        curves.push_back(add_line(vertices[i], vertices[(i + 1) % vertices.size()]));
    }
    curves.insert(curves.end(), holes.begin(), holes.end());
    add_plane_sheet(face, curves, axis, sign);
}

std::vector<std::vector<PartSurfaceBuilder::CurveUse>> PartSurfaceBuilder::chain(
    const std::vector<int>& curves) const {
    std::map<int, std::vector<int>> curves_at;
    for (const int i : curves) {
        curves_at[curves_[i].from].push_back(i);
        curves_at[curves_[i].to].push_back(i);
    }
    std::set<int> is_used;
    std::vector<std::vector<CurveUse>> loops;
    for (const int first : curves) {
        if (is_used.contains(first)) {
            continue;
        }
        std::vector<CurveUse> loop;
        CurveUse use{first, false};
        while (is_used.insert(use.curve).second) {
            loop.push_back(use);
            const int end = use.is_reversed ? curves_[use.curve].from : curves_[use.curve].to;
            const std::vector<int>& meeting = curves_at.at(end);
            assert(meeting.size() == 2);
            const int next = meeting[0] == use.curve ? meeting[1] : meeting[0];
            use = {next, curves_[next].from != end};
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

std::vector<int> PartSurfaceBuilder::points_of(const std::vector<CurveUse>& loop) const {
    std::vector<int> points;
    for (const CurveUse& use : loop) {
        std::vector<int> some = curves_[use.curve].points;
        if (use.is_reversed) {
            std::reverse(some.begin(), some.end());
        }
        points.insert(points.end(), some.begin(), some.end() - 1);
    }
    return points;
}

void PartSurfaceBuilder::mesh_sheet(const Sheet& sheet, PartSurface& part) const {
    std::vector<std::vector<int>> numbers;
    std::vector<std::vector<Vector2>> loops;
    for (const std::vector<CurveUse>& chained : chain(sheet.curves)) {
        numbers.push_back(points_of(chained));
        loops.emplace_back();
        for (const int i : numbers.back()) {
            loops.back().push_back(sheet.map.to_plane(points_[i]));
        }
    }
    std::size_t outer = 0;
    for (std::size_t i = 1; i < loops.size(); ++i) {
        if (std::abs(signed_area(loops[i])) > std::abs(signed_area(loops[outer]))) {
            outer = i;
        }
    }
    std::vector<int> vertex;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        if ((signed_area(loops[i]) > 0.0) != (i == outer)) {
            std::reverse(loops[i].begin(), loops[i].end());
            std::reverse(numbers[i].begin(), numbers[i].end());
        }
        vertex.insert(vertex.end(), numbers[i].begin(), numbers[i].end());
    }
    const PlanarMesh mesh =
        mesh_planar_region(loops, graded_size(loops, target_edge_length_, sheet.map));
    for (std::size_t i = vertex.size(); i < mesh.points.size(); ++i) {
        vertex.push_back(static_cast<int>(part.soup.points.size()));
        part.soup.points.push_back(sheet.map.to_space(mesh.points[i]));
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        part.soup.triangles.push_back({vertex[a], vertex[b], vertex[c]});
        part.face_of_triangle.push_back(sheet.face);
    }
}

void PartSurfaceBuilder::name_features(PartSurface& part) const {
    std::vector<std::vector<int>> faces_of(curves_.size());
    for (const Sheet& sheet : sheets_) {
        for (const int i : sheet.curves) {
            faces_of[i].push_back(sheet.face);
        }
    }
    std::vector<std::vector<int>> features_at(ends_.size());
    std::vector<bool> is_feature(curves_.size(), false);
    for (std::size_t i = 0; i < curves_.size(); ++i) {
        std::sort(faces_of[i].begin(), faces_of[i].end());
        assert(faces_of[i].size() == 2);
        is_feature[i] = faces_of[i][0] != faces_of[i][1];
        if (is_feature[i]) {
            features_at[curves_[i].from].push_back(static_cast<int>(i));
            features_at[curves_[i].to].push_back(static_cast<int>(i));
        }
    }
    const auto names_of = [&](const auto& faces) {
        std::vector<std::string> names;
        for (const int face : faces) {
            names.push_back(faces_[face].name);
        }
        return fmt::format("{}", fmt::join(names, "-"));
    };
    for (std::size_t v = 0; v < ends_.size(); ++v) {
        if (features_at[v].size() > 2) {
            std::set<int> faces;
            for (const int i : features_at[v]) {
                faces.insert(faces_of[i].begin(), faces_of[i].end());
            }
            part.corners.push_back({with_place(names_of(faces), vertex_places_[v]), ends_[v]});
        }
    }
    // Curves go on through vertices that are no corners.
    std::vector<bool> is_done(curves_.size(), false);
    const auto follow = [&](int first, int start) {
        PartCurve feature;
        feature.name = with_place(names_of(faces_of[first]), curves_[first].place);
        int curve = first;
        int at = start;
        while (!is_done[curve]) {
            is_done[curve] = true;
            const bool is_reversed = curves_[curve].from != at;
            const std::vector<int> points = points_of({{curve, is_reversed}});
            feature.vertices.insert(feature.vertices.end(), points.begin(), points.end());
            at = is_reversed ? curves_[curve].from : curves_[curve].to;
            if (features_at[at].size() != 2) {
                break;
            }
            curve = features_at[at][0] == curve ? features_at[at][1] : features_at[at][0];
        }
        feature.is_closed = at == start && features_at[at].size() == 2;
        if (!feature.is_closed) {
            feature.vertices.push_back(ends_[at]);
        }
        part.feature_curves.push_back(std::move(feature));
    };
    for (int i = 0; i < static_cast<int>(curves_.size()); ++i) {
        for (const int end : {curves_[i].from, curves_[i].to}) {
            if (is_feature[i] && !is_done[i] && features_at[end].size() > 2) {
                follow(i, end);
            }
        }
    }
    for (int i = 0; i < static_cast<int>(curves_.size()); ++i) {
        if (is_feature[i] && !is_done[i]) {
            follow(i, curves_[i].from);
        }
    }
}

PartSurface PartSurfaceBuilder::finish() const {
    PartSurface part;
    part.faces = faces_;
    part.soup.points = points_;
    for (const Sheet& sheet : sheets_) {
        mesh_sheet(sheet, part);
    }
    name_features(part);
    return part;
}

}  // namespace couture::meshing
