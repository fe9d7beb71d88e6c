#include "meshing/topology/solid_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/surface/fix_surface.h"
#include "meshing/surface/repair.h"
#include "meshing/surface/self_intersection.h"
#include "meshing/surface/soup_boundary.h"
#include "meshing/surface/soup_sides.h"

namespace couture::meshing {

namespace {

constexpr double flatness = 1e-9;

std::string place(const Vector3& p) {
    // Minus nought is nought.
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
}

/// "0, 4, 9", of many the first.
std::string list(const std::vector<int>& numbers) {
    constexpr std::size_t longest = 6;
    const auto end =
        numbers.begin() + static_cast<std::ptrdiff_t>(std::min(numbers.size(), longest));
    return fmt::format("{}{}", fmt::join(numbers.begin(), end, ", "),
                       numbers.size() > longest ? ", ..." : "");
}

const char* noun(std::size_t n) { return n == 1 ? "triangle" : "triangles"; }

/// For each triangle its component across common vertices, in the order of their first triangle.
std::vector<int> vertex_components(const TriangleSoup& soup) {
    DisjointSets sets(soup.points.size());
    for (const auto& [a, b, c] : soup.triangles) {
        sets.join(a, b);
        sets.join(a, c);
    }
    std::vector<int> number(soup.points.size(), -1);
    std::vector<int> components;
    int next = 0;
    for (const auto& triangle : soup.triangles) {
        int& n = number[sets.find(triangle[0])];
        if (n < 0) n = next++;
        components.push_back(n);
    }
    return components;
}

std::vector<std::vector<int>> groups(const std::vector<int>& components) {
    std::vector<std::vector<int>> result;
    for (std::size_t t = 0; t < components.size(); ++t) {
        const auto c = static_cast<std::size_t>(components[t]);
        if (c >= result.size()) result.resize(c + 1);
        result[c].push_back(static_cast<int>(t));
    }
    return result;
}

class Check {
  public:
    Check(const TriangleSoup& soup, const CheckOptions& options) : soup_(soup), options_(options) {}

    SurfaceCheck run() {
        add_loops();
        add_edges();
        add_vertices();
        add_triangles();
        add_crossings();
        add_shells();
        std::stable_sort(
            check_.flaws.begin(), check_.flaws.end(),
            [](const SurfaceFlaw& a, const SurfaceFlaw& b) { return a.kind < b.kind; });
        return std::move(check_);
    }

  private:
    SurfaceFlaw& add(FlawKind kind, std::vector<int> triangles, const Vector3& position,
                     const std::string& what) {
        SurfaceFlaw& flaw = check_.flaws.emplace_back();
        flaw.kind = kind;
        flaw.triangles = std::move(triangles);
        flaw.position = position;
        flaw.text = fmt::format("{}: {}", place(position), what);
        return flaw;
    }

    void add_loops() {
        for (const OpenLoop& loop : open_loops(soup_)) {
            std::vector<Vector3> points;
            for (const int v : loop.vertices) points.push_back(soup_.points[v]);
            const std::size_t n_edges = points.size() - (loop.is_closed ? 0 : 1);
            double length = 0.0;
            Vector3 center = Vector3::Zero();
            for (std::size_t i = 0; i < n_edges; ++i) {
                const Vector3& a = points[i];
                const Vector3& b = points[(i + 1) % points.size()];
                length += (b - a).norm();
                center += 0.5 * (b - a).norm() * (a + b);
            }
            center = length > 0.0 ? Vector3(center / length) : points.front();
            std::vector<int> triangles = loop.triangles;
            std::sort(triangles.begin(), triangles.end());
            triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
            SurfaceFlaw& flaw =
                add(FlawKind::open_boundary, std::move(triangles), center,
                    fmt::format("{} of {} edges, length {:.6g}", loop.is_closed ? "loop" : "chain",
                                n_edges, length));
            flaw.line = std::move(points);
            flaw.is_closed = loop.is_closed;
            flaw.length = length;
        }
    }

    void add_edges() {
        const auto sides = sorted_sides(soup_);
        for (const auto& edge : edges_of(sides)) {
            const bool is_manifold = edge.size() <= 2;
            const bool is_consistent = edge.size() != 2 || edge[0].is_forward != edge[1].is_forward;
            if (is_manifold && is_consistent) continue;
            const Vector3& a = soup_.points[edge[0].low];
            const Vector3& b = soup_.points[edge[0].high];
            std::vector<int> triangles;
            for (const SoupSide& side : edge) triangles.push_back(side.triangle);
            triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
            const std::string what =
                is_manifold ? fmt::format(
                                  "triangles {} run along the edge of vertices {} and {} in the "
                                  "same direction",
                                  list(triangles), edge[0].low, edge[0].high)
                            : fmt::format("edge of vertices {} and {} with {} triangles: {}",
                                          edge[0].low, edge[0].high, edge.size(), list(triangles));
            SurfaceFlaw& flaw =
                add(is_manifold ? FlawKind::inconsistent_edge : FlawKind::non_manifold_edge,
                    std::move(triangles), 0.5 * (a + b), what);
            flaw.line = {a, b};
            flaw.length = (b - a).norm();
        }
    }

    void add_vertices() {
        const std::vector<int> fans = corner_fans(soup_);
        // First corners of the fans at each vertex that has several.
        std::vector<int> first(soup_.points.size(), -1);
        std::vector<std::pair<int, int>> others;
        for (std::size_t c = 0; c < fans.size(); ++c) {
            if (fans[c] != static_cast<int>(c)) continue;
            const int v = soup_.triangles[c / 3][c % 3];
            if (first[v] < 0) {
                first[v] = fans[c];
            } else {
                others.emplace_back(v, fans[c]);
            }
        }
        std::sort(others.begin(), others.end());
        for (std::size_t i = 0; i < others.size();) {
            const int v = others[i].first;
            std::vector<int> triangles{first[v] / 3};
            for (; i < others.size() && others[i].first == v; ++i) {
                triangles.push_back(others[i].second / 3);
            }
            const std::string what =
                fmt::format("vertex {} where {} fans of triangles touch, those of triangles {}", v,
                            triangles.size(), list(triangles));
            add(FlawKind::non_manifold_vertex, std::move(triangles), soup_.points[v], what);
        }
    }

    void add_triangles() {
        std::vector<std::pair<std::array<int, 3>, int>> corners;
        for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
            auto key = soup_.triangles[t];
            std::sort(key.begin(), key.end());
            corners.emplace_back(key, static_cast<int>(t));
            const double height = relative_height(soup_, static_cast<int>(t));
            if (height > flatness) continue;
            const auto [a, b, c] = soup_.triangles[t];
            add(FlawKind::flat_triangle, {static_cast<int>(t)},
                centroid(soup_, static_cast<int>(t)),
                fmt::format("triangle {} of vertices {}, {}, {}: its height is {:.2g} of its "
                            "longest side",
                            t, a, b, c, height));
        }
        std::sort(corners.begin(), corners.end());
        for (std::size_t i = 0; i < corners.size();) {
            std::vector<int> copies;
            const auto key = corners[i].first;
            for (; i < corners.size() && corners[i].first == key; ++i) {
                copies.push_back(corners[i].second);
            }
            if (copies.size() < 2) continue;
            const Vector3 position = centroid(soup_, copies.front());
            const std::string what = fmt::format("triangles {} have the same vertices {}, {}, {}",
                                                 list(copies), key[0], key[1], key[2]);
            add(FlawKind::duplicate_triangle, std::move(copies), position, what);
        }
        if (soup_.triangles.size() < 4) {
            std::vector<int> all(soup_.triangles.size());
            std::iota(all.begin(), all.end(), 0);
            const std::size_t n = all.size();
            add(FlawKind::too_few_triangles, std::move(all),
                n > 0 ? centroid(soup_, 0) : Vector3(Vector3::Zero()),
                fmt::format("{} {}; the least solid, a tetrahedron, has 4", n, noun(n)));
        }
    }

    void add_crossings() {
        const SelfIntersections found = find_self_intersections(soup_, options_.max_crossings);
        check_.has_more_crossings = found.is_cut_short;
        for (const TriangleCrossing& crossing : found.crossings) {
            add(FlawKind::self_intersection, {crossing.first, crossing.second}, crossing.position,
                fmt::format("triangles {} and {}", crossing.first, crossing.second));
        }
    }

    void add_disjoint(const std::vector<int>& triangles, const std::string& what) {
        Vector3 low = soup_.points[soup_.triangles[triangles.front()][0]];
        Vector3 high = low;
        for (const int t : triangles) {
            for (const int v : soup_.triangles[t]) {
                low = low.cwiseMin(soup_.points[v]);
                high = high.cwiseMax(soup_.points[v]);
            }
        }
        const Vector3 size = high - low;
        add(FlawKind::disjoint_shell, triangles, 0.5 * (low + high),
            fmt::format("{}, {} {}, size {:.4g} x {:.4g} x {:.4g}", what, triangles.size(),
                        noun(triangles.size()), size.x(), size.y(), size.z()));
    }

    void add_shells() {
        if (soup_.triangles.empty()) return;
        const auto components = groups(vertex_components(soup_));
        const bool is_closed = check_.count(FlawKind::open_boundary) == 0 &&
                               check_.count(FlawKind::non_manifold_edge) == 0 &&
                               check_.count(FlawKind::inconsistent_edge) == 0;
        const bool is_manifold = is_closed && check_.count(FlawKind::non_manifold_vertex) == 0 &&
                                 check_.count(FlawKind::too_few_triangles) == 0;
        if (!is_manifold || check_.count(FlawKind::self_intersection) > 0) {
            add_components(components, is_closed);
            return;
        }
        try {
            check_.shells = nest_shells(soup_);
        } catch (const Error& error) {
            // Without crossing triangles this is a shell without volume.
            const std::string what = error.what();
            add(FlawKind::no_volume, {0}, centroid(soup_, 0), what.substr(what.find(": ") + 2));
            return;
        }
        add_nested();
    }

    /// Where what lies in what is not known: all but the largest component are told of.
    void add_components(const std::vector<std::vector<int>>& components, bool is_closed) {
        if (components.size() < 2 || is_closed) return;
        const auto largest =
            std::max_element(components.begin(), components.end(),
                             [](const auto& a, const auto& b) { return a.size() < b.size(); });
        for (auto component = components.begin(); component != components.end(); ++component) {
            if (component == largest) continue;
            add_disjoint(*component,
                         fmt::format("component {} beside component {}",
                                     component - components.begin(), largest - components.begin()));
        }
    }

    void add_nested() {
        std::size_t largest = 0;
        for (std::size_t i = 0; i < check_.shells.size(); ++i) {
            if (check_.shells[i].shell.volume > check_.shells[largest].shell.volume) largest = i;
        }
        bool is_one = true;
        for (std::size_t i = 0; i < check_.shells.size(); ++i) {
            const NestedShell& nested = check_.shells[i];
            if (nested.shell.is_reversed) {
                add(FlawKind::inside_out, nested.shell.triangles, 0.5 * (nested.low + nested.high),
                    fmt::format("shell {}, whose normals point {}", i,
                                nested.shell.is_cavity ? "out of the cavity" : "inwards"));
            }
            if (i == largest || (nested.depth == 1 && nested.parent == static_cast<int>(largest))) {
                continue;
            }
            is_one = false;
            add_disjoint(nested.shell.triangles,
                         nested.depth > 1
                             ? fmt::format("shell {} in the cavity of shell {}", i, nested.parent)
                         : nested.depth == 1
                             ? fmt::format("shell {}, a cavity of shell {}", i, nested.parent)
                             : fmt::format("shell {} outside shell {}", i, largest));
        }
        if (is_one) check_.solid = make_solid(soup_);
    }

    const TriangleSoup& soup_;
    const CheckOptions& options_;
    SurfaceCheck check_;
};

constexpr std::array<const char*, n_flaw_kinds> kind_names{"none",
                                                           "open boundary",
                                                           "non-manifold edge",
                                                           "non-manifold vertex",
                                                           "inconsistent edge",
                                                           "inside-out shell",
                                                           "disjoint shell",
                                                           "flat triangle",
                                                           "duplicate triangle",
                                                           "self-intersection",
                                                           "surface of too few triangles",
                                                           "shell without volume"};
constexpr std::array<const char*, n_flaw_kinds> kind_plurals{"none",
                                                             "open boundaries",
                                                             "non-manifold edges",
                                                             "non-manifold vertices",
                                                             "inconsistent edges",
                                                             "inside-out shells",
                                                             "disjoint shells",
                                                             "flat triangles",
                                                             "duplicate triangles",
                                                             "self-intersections",
                                                             "surfaces of too few triangles",
                                                             "shells without volume"};

/// Six times the volume of a component, its boundary loops closed by triangles to their centres.
Eigen::AlignedBox3d box_of(const TriangleSoup& soup, const std::vector<int>& triangles) {
    Eigen::AlignedBox3d box;
    for (const int t : triangles) {
        for (const int v : soup.triangles[t]) box.extend(soup.points[v]);
    }
    return box;
}

// Whether each edge of a component has two triangles, in opposite directions.
std::vector<bool> closed_components(const TriangleSoup& soup, const std::vector<int>& components,
                                    std::size_t n) {
    std::vector<bool> is_closed(n, true);
    const auto sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        if (edge.size() == 2 && edge[0].is_forward != edge[1].is_forward) continue;
        is_closed[components[edge.front().triangle]] = false;
    }
    return is_closed;
}

double closed_volume(const TriangleSoup& soup, const std::vector<int>& triangles) {
    TriangleSoup part = part_of(soup, triangles);
    const Vector3 origin = part.points[part.triangles.front()[0]];
    double volume = 0.0;
    const auto add = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
        volume += (a - origin).dot((b - origin).cross(c - origin));
    };
    for (const auto& [a, b, c] : part.triangles) {
        add(part.points[a], part.points[b], part.points[c]);
    }
    for (const OpenLoop& loop : open_loops(part)) {
        Vector3 center = Vector3::Zero();
        for (const int v : loop.vertices) center += part.points[v];
        center /= static_cast<double>(loop.vertices.size());
        for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
            const int next = loop.vertices[(i + 1) % loop.vertices.size()];
            add(part.points[next], part.points[loop.vertices[i]], center);
        }
    }
    return volume;
}

void turn(TriangleSoup& soup, const std::vector<int>& triangles) {
    for (const int t : triangles) std::swap(soup.triangles[t][1], soup.triangles[t][2]);
}

}  // namespace

std::string to_string(FlawKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

int SurfaceCheck::count(FlawKind kind) const {
    return static_cast<int>(std::count_if(
        flaws.begin(), flaws.end(), [&](const SurfaceFlaw& flaw) { return flaw.kind == kind; }));
}

const SurfaceFlaw* SurfaceCheck::first(FlawKind kind) const {
    const auto flaw = std::find_if(flaws.begin(), flaws.end(),
                                   [&](const SurfaceFlaw& f) { return f.kind == kind; });
    return flaw == flaws.end() ? nullptr : &*flaw;
}

SurfaceCheck check_solid(const TriangleSoup& soup, const CheckOptions& options) {
    const int n_points = static_cast<int>(soup.points.size());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto [a, b, c] = soup.triangles[t];
        if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= n_points) {
            throw InputError(
                "check_solid: triangle {} has vertices {}, {}, {}; they must be numbers below {}",
                t, a, b, c, n_points);
        }
    }
    return Check(soup, options).run();
}

std::vector<std::string> summarize(const SurfaceCheck& check, int max_places) {
    std::vector<std::string> lines;
    for (int k = 1; k < n_flaw_kinds; ++k) {
        const auto kind = static_cast<FlawKind>(k);
        const int n = check.count(kind);
        if (n == 0) continue;
        const bool is_cut = kind == FlawKind::self_intersection && check.has_more_crossings;
        lines.push_back(fmt::format("{}{} {}:", n, is_cut ? " or more" : "",
                                    n == 1 ? kind_names[k] : kind_plurals[k]));
        int n_places = 0;
        for (const SurfaceFlaw& flaw : check.flaws) {
            if (flaw.kind != kind || n_places >= max_places) continue;
            lines.push_back("  " + flaw.text);
            ++n_places;
        }
        if (n > max_places) lines.emplace_back("  ...");
    }
    return lines;
}

std::vector<int> flaw_of_triangle(const SurfaceCheck& check, std::size_t n_triangles) {
    std::vector<int> result(n_triangles, 0);
    for (const bool is_whole : {false, true}) {
        for (const SurfaceFlaw& flaw : check.flaws) {
            const bool is_shell =
                flaw.kind == FlawKind::inside_out || flaw.kind == FlawKind::disjoint_shell ||
                flaw.kind == FlawKind::too_few_triangles || flaw.kind == FlawKind::no_volume;
            if (is_shell != is_whole) continue;
            for (const int t : flaw.triangles) {
                if (result[t] == 0) result[t] = static_cast<int>(flaw.kind);
            }
        }
    }
    return result;
}

int orient_outwards(TriangleSoup& soup, const std::vector<int>& turned) {
    const std::vector<int> components = vertex_components(soup);
    const auto parts = groups(components);
    std::vector<bool> is_open(parts.size(), false);
    std::vector<bool> is_broken(parts.size(), false);
    const auto sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        const int c = components[edge.front().triangle];
        if (edge.size() == 1) is_open[c] = true;
        if (edge.size() > 2 || (edge.size() == 2 && edge[0].is_forward == edge[1].is_forward)) {
            is_broken[c] = true;
        }
    }
    std::vector<bool> had_to_choose(parts.size(), false);
    for (const int t : turned) had_to_choose[components[t]] = true;
    std::vector<int> closed;
    int n_turned = 0;
    for (std::size_t c = 0; c < parts.size(); ++c) {
        if (is_broken[c]) continue;
        if (!is_open[c]) {
            closed.insert(closed.end(), parts[c].begin(), parts[c].end());
        } else if (had_to_choose[c] && closed_volume(soup, parts[c]) < 0.0) {
            turn(soup, parts[c]);
            ++n_turned;
        }
    }
    if (closed.empty()) return n_turned;
    try {
        for (const NestedShell& nested : nest_shells(part_of(soup, closed))) {
            if (!nested.shell.is_reversed) continue;
            for (const int t : nested.shell.triangles) turn(soup, {closed[t]});
            ++n_turned;
        }
    } catch (const Error&) {
        // Crossing shells have no inside: each one alone.
        for (std::size_t c = 0; c < parts.size(); ++c) {
            if (is_open[c] || is_broken[c] || closed_volume(soup, parts[c]) >= 0.0) continue;
            turn(soup, parts[c]);
            ++n_turned;
        }
    }
    return n_turned;
}

SelectedShell select_shell(const TriangleSoup& soup, int number) {
    const std::vector<int> components = vertex_components(soup);
    const auto parts = groups(components);
    if (number < 0 || static_cast<std::size_t>(number) >= parts.size()) {
        throw InputError("select_shell: there is no shell {}; there are {}, counted from 0", number,
                         parts.size());
    }
    std::vector<int> chosen = parts[number];
    SelectedShell result;
    const std::vector<bool> is_closed = closed_components(soup, components, parts.size());
    if (is_closed[number]) {
        // Of the others only those count that can lie around it or in it: what else is wrong with
        // the surface is left out of the body.
        const Eigen::AlignedBox3d box = box_of(soup, parts[number]);
        std::vector<int> near;
        for (std::size_t c = 0; c < parts.size(); ++c) {
            if (!is_closed[c]) continue;
            const Eigen::AlignedBox3d other = box_of(soup, parts[c]);
            if (!box.contains(other) && !other.contains(box)) continue;
            near.insert(near.end(), parts[c].begin(), parts[c].end());
        }
        std::sort(near.begin(), near.end());
        const auto nested = nest_shells(part_of(soup, near));
        const auto self = std::find_if(nested.begin(), nested.end(), [&](const NestedShell& shell) {
            return near[shell.shell.triangles.front()] == parts[number].front();
        });
        result.was_cavity = self->shell.is_cavity;
        for (const NestedShell& other : nested) {
            if (other.parent != self - nested.begin()) continue;
            for (const int t : other.shell.triangles) chosen.push_back(near[t]);
        }
    }
    std::sort(chosen.begin(), chosen.end());
    result.soup = part_of(soup, chosen);
    drop_unused_points(result.soup);
    return result;
}

}  // namespace couture::meshing
