#include "io/surface_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/surface/features.h"
#include "meshing/surface/soup_sides.h"
#include "meshing/topology/invariants.h"

namespace couture::io {

namespace {

using Json = nlohmann::ordered_json;
using namespace meshing;

constexpr double degree = std::numbers::pi / 180.0;

Json to_array(const Vector3& point) { return {point.x(), point.y(), point.z()}; }

/// "1 triangle", "2 triangles".
std::string count(long n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string place(const Vector3& p) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
}

struct Sizes {
    double area = 0.0;
    double volume = 0.0;
    double shortest_edge = std::numeric_limits<double>::infinity();
    double longest_edge = 0.0;
    double smallest_angle = std::numbers::pi;
    Vector3 low = Vector3::Zero();
    Vector3 high = Vector3::Zero();
};

Sizes measure(const TriangleSoup& soup) {
    Sizes sizes;
    sizes.low = sizes.high = soup.points[soup.triangles.front()[0]];
    const Vector3 origin = sizes.low;
    for (const auto& triangle : soup.triangles) {
        const std::array<Vector3, 3> p{soup.points[triangle[0]], soup.points[triangle[1]],
                                       soup.points[triangle[2]]};
        sizes.area += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
        sizes.volume += (p[0] - origin).dot((p[1] - origin).cross(p[2] - origin)) / 6.0;
        for (int k = 0; k < 3; ++k) {
            const Vector3 a = p[(k + 1) % 3] - p[k];
            const Vector3 b = p[(k + 2) % 3] - p[k];
            sizes.shortest_edge = std::min(sizes.shortest_edge, a.norm());
            sizes.longest_edge = std::max(sizes.longest_edge, a.norm());
            sizes.smallest_angle =
                std::min(sizes.smallest_angle, std::atan2(a.cross(b).norm(), a.dot(b)));
            sizes.low = sizes.low.cwiseMin(p[k]);
            sizes.high = sizes.high.cwiseMax(p[k]);
        }
    }
    return sizes;
}

Json describe_features(SurfaceMesh& mesh) {
    int n_sharp = 0;
    for (const auto edge : mesh.edges()) n_sharp += dihedral_angle(mesh, edge) > 40.0 * degree;
    const Features features = detect_features(mesh);
    return {{"sharp_edges", n_sharp},
            {"curves", features.curves.size()},
            {"corners", features.corners.size()},
            {"faces", features.regions.size()}};
}

/// Components and features of an oriented manifold; nothing of what is none.
void add_topology(Json& result, const TriangleSoup& soup) {
    try {
        SurfaceMesh mesh = make_surface_mesh(soup);
        const auto invariants = compute_invariants(mesh);
        result["name"] = surface_name(mesh);
        result["genus"] = invariants.genus;
        result["boundaries"] = invariants.n_boundaries;
        for (const auto& component : component_invariants(mesh)) {
            result["components"].push_back(
                {{"name", surface_name(component.genus, component.n_boundaries)},
                 {"genus", component.genus},
                 {"boundaries", component.n_boundaries},
                 {"triangles", component.n_faces}});
        }
        result["features"] = describe_features(mesh);
    } catch (const Error&) {
        // The problems say why.
    }
}

Json describe(const DescribedSurface& surface) {
    const TriangleSoup& soup = surface.soup;
    const SurfaceCheck& check = surface.check;
    Json result;
    result["surface"] = surface.name;
    result["format"] = surface.file.format;
    result["points"] = soup.points.size();
    const auto sides = sorted_sides(soup);
    const std::size_t n_edges = edges_of(sides).size();
    result["edges"] = n_edges;
    result["triangles"] = soup.triangles.size();
    result["euler_characteristic"] = static_cast<long>(soup.points.size()) -
                                     static_cast<long>(n_edges) +
                                     static_cast<long>(soup.triangles.size());
    const bool is_manifold = check.count(FlawKind::non_manifold_edge) == 0 &&
                             check.count(FlawKind::non_manifold_vertex) == 0;
    const bool is_closed =
        check.count(FlawKind::open_boundary) == 0 && check.count(FlawKind::non_manifold_edge) == 0;
    result["closed"] = is_closed;
    result["manifold"] = is_manifold;
    result["oriented"] = check.count(FlawKind::inconsistent_edge) == 0;
    for (const char* key : {"name", "genus", "boundaries"}) result[key] = nullptr;
    result["components"] = Json::array();
    result["features"] = nullptr;
    add_topology(result, soup);
    const Sizes sizes = measure(soup);
    result["area"] = sizes.area;
    result["volume"] = is_closed && result["oriented"] == true ? Json(sizes.volume) : Json();
    result["bounding_box"] = {{"low", to_array(sizes.low)}, {"high", to_array(sizes.high)}};
    result["shortest_edge"] = sizes.shortest_edge;
    result["longest_edge"] = sizes.longest_edge;
    result["smallest_angle"] = sizes.smallest_angle;
    result["solid"] = nullptr;
    if (check.solid) {
        result["solid"] = {{"volume", check.solid->volume},
                           {"cavities", check.solid->betti[2]},
                           {"betti", check.solid->betti},
                           {"euler_characteristic", check.solid->euler_characteristic}};
    }
    result["read"] = {
        {"points", surface.file.n_points_read},
        {"polygons", surface.file.n_polygons_read},
        {"merged_points", surface.file.n_merged + surface.repair.n_merged},
        {"split_polygons", surface.file.n_split},
        {"dropped_triangles", surface.file.n_degenerate + surface.repair.n_degenerate},
        {"duplicate_triangles", surface.repair.n_duplicates},
        {"unused_points", surface.file.n_unused + surface.repair.n_unused},
        {"turned_triangles", surface.repair.n_turned},
        {"turned_shells", surface.n_shells_turned}};
    result["fixed"] = nullptr;
    if (const auto& fix = surface.fix) {
        result["fixed"] = {{"welded_points", fix->n_welded},
                           {"largest_move", fix->largest_move},
                           {"flat_triangles_removed", fix->n_flat_removed},
                           {"flat_triangles_left", fix->n_flat_left},
                           {"split_vertices", fix->n_split_vertices},
                           {"filled_holes", fix->n_filled_holes},
                           {"hole_triangles", fix->n_hole_triangles},
                           {"open_holes", fix->n_open_holes}};
    }
    if (surface.part) {
        result["corners"] = Json::object();
        for (const PartCorner& corner : surface.part->corners) {
            result["corners"][corner.name] = to_array(surface.part->soup.points[corner.vertex]);
        }
    }
    result["changes"] = describe_changes(surface);
    result["problems"] = Json::array();
    for (const SurfaceFlaw& flaw : check.flaws) {
        result["problems"].push_back({{"kind", to_string(flaw.kind)},
                                      {"at", to_array(flaw.position)},
                                      {"triangles", flaw.triangles},
                                      {"text", flaw.text}});
        if (!flaw.line.empty()) result["problems"].back()["length"] = flaw.length;
    }
    result["more_self_intersections"] = check.has_more_crossings;
    return result;
}

}  // namespace

std::string describe_former_cavity(const DescribedSurface& surface) {
    return fmt::format(
        "shell {} is the wall of a cavity; what lies inside it is taken as a body, turned outwards",
        surface.former_cavity.value());
}

std::vector<std::string> describe_changes(const DescribedSurface& surface) {
    std::vector<std::string> lines;
    const auto add = [&](int n, const char* one, const char* many, const char* what,
                         const std::vector<SurfacePlace>& places = {}) {
        if (n == 0) return;
        std::string line = fmt::format("{} {}", count(n, one, many), what);
        for (std::size_t i = 0; i < std::min<std::size_t>(places.size(), 3); ++i) {
            line += fmt::format("{}{}", i == 0 ? ": at " : ", ", place(places[i].position));
        }
        if (places.size() > 3) line += ", ...";
        lines.push_back(line);
    };
    const SurfaceFile& file = surface.file;
    const RepairReport& repair = surface.repair;
    add(file.n_merged + repair.n_merged, "point", "points", "merged with equal ones");
    add(file.n_split, "polygon", "polygons", "split into triangles");
    add(file.n_degenerate + repair.n_degenerate, "triangle", "triangles",
        "with a point twice dropped", repair.degenerate);
    add(repair.n_duplicates, "duplicate triangle", "duplicate triangles", "dropped",
        repair.duplicates);
    add(file.n_unused + repair.n_unused, "point", "points", "of no triangle dropped");
    add(repair.n_turned, "triangle", "triangles", "turned to run as their neighbours",
        repair.turned);
    if (surface.former_cavity) {
        lines.push_back(describe_former_cavity(surface));
    } else {
        add(surface.n_shells_turned, "shell", "shells", "turned outwards");
    }
    if (!surface.fix) return lines;
    const FixReport& fix = *surface.fix;
    if (fix.n_welded > 0) {
        lines.push_back(fmt::format("{} welded to near ones, moved by {:.3g} at most",
                                    count(fix.n_welded, "point", "points"), fix.largest_move));
    }
    add(fix.repair.n_degenerate, "triangle", "triangles", "dropped that welding closed");
    add(fix.repair.n_duplicates, "duplicate triangle", "duplicate triangles",
        "dropped behind welding");
    add(fix.n_flat_removed, "flat triangle", "flat triangles", "removed");
    add(fix.n_flat_left, "flat triangle", "flat triangles", "could not be removed");
    add(fix.n_split_vertices, "vertex", "vertices", "copied where parts touched at it",
        fix.split_vertices);
    add(fix.n_filled_holes, "hole", "holes", "filled", fix.filled_holes);
    add(fix.n_open_holes, "hole", "holes", "could not be filled");
    return lines;
}

std::string surface_info_json(const DescribedSurface& surface) {
    return describe(surface).dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string surface_info_text(const DescribedSurface& surface) {
    const Json info = describe(surface);
    std::string text = fmt::format(
        "{}: {}\nsurface: {} points, {} edges, {} triangles, Euler characteristic {}\n",
        surface.name, surface.file.format, info["points"].get<long>(), info["edges"].get<long>(),
        info["triangles"].get<long>(), info["euler_characteristic"].get<long>());
    text += fmt::format("{}, {}, {}\n", info["closed"] == true ? "closed" : "open",
                        info["manifold"] == true ? "manifold" : "not a manifold",
                        info["oriented"] == true ? "oriented" : "not orientable");
    if (!info["name"].is_null()) {
        const Json& components = info["components"];
        text += fmt::format("{}:",
                            count(static_cast<long>(components.size()), "component", "components"));
        for (std::size_t i = 0; i < components.size(); ++i) {
            text += fmt::format(
                "{} {} (genus {}, {})", i == 0 ? "" : ",", components[i]["name"].get<std::string>(),
                components[i]["genus"].get<int>(),
                count(components[i]["boundaries"].get<long>(), "boundary", "boundaries"));
        }
        text += "\n";
    }
    text += fmt::format("area: {:.12g}\n", info["area"].get<double>());
    if (!info["volume"].is_null()) {
        text += fmt::format("volume: {:.12g}\n", info["volume"].get<double>());
    }
    const Sizes sizes = measure(surface.soup);
    text += fmt::format(
        "bounding box: {} to {}\nedges: {:.6g} to {:.6g}; smallest angle: {:.6g} degrees\n",
        place(sizes.low), place(sizes.high), sizes.shortest_edge, sizes.longest_edge,
        sizes.smallest_angle / degree);
    if (!info["features"].is_null()) {
        const Json& features = info["features"];
        text += fmt::format("features: {} at 40 degrees, {}, {}, {}\n",
                            count(features["sharp_edges"].get<long>(), "sharp edge", "sharp edges"),
                            count(features["curves"].get<long>(), "curve", "curves"),
                            count(features["corners"].get<long>(), "corner", "corners"),
                            count(features["faces"].get<long>(), "smooth face", "smooth faces"));
    }
    if (const auto& solid = surface.check.solid) {
        text += fmt::format("solid: {}, Betti numbers {} {} {}\n",
                            count(solid->betti[2], "cavity", "cavities"), solid->betti[0],
                            solid->betti[1], solid->betti[2]);
    }
    if (surface.part) {
        for (const PartCorner& corner : surface.part->corners) {
            text += fmt::format("corner {}: {}\n", corner.name,
                                place(surface.part->soup.points[corner.vertex]));
        }
    }
    for (const std::string& line : describe_changes(surface)) {
        text += fmt::format("note: {}\n", line);
    }
    const std::vector<std::string> problems = summarize(surface.check);
    text += problems.empty() ? "problems: none\n" : "problems:\n";
    for (const std::string& line : problems) text += fmt::format("  {}\n", line);
    // As all texts that are printed with a line end.
    text.pop_back();
    return text;
}

}  // namespace couture::io
