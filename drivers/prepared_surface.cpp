#include "drivers/prepared_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>

#include "drivers/surface_input.h"
#include "iga/core/error.h"
#include "io/did_you_mean.h"
#include "io/pants_file.h"
#include "meshing/parts/part_landmarks.h"
#include "meshing/surface/caps.h"
#include "meshing/topology/invariants.h"

namespace couture::drivers {

namespace {

using namespace meshing;

[[noreturn]] void unknown_name(const char* what, const std::string& part, const std::string& name,
                               const std::vector<std::string>& names) {
    const std::string help = io::did_you_mean(name, names);
    throw InputError("mesh: the part '{}' has no {} '{}'{} There are {}", part, what, name,
                     help.empty() ? "." : help, io::quoted_list(names));
}

// The faces of a part by their names: all its caps, or those that are asked for.
void add_named_caps(const io::MeshDeck& deck, const io::CapSelection& open, const PartSurface& part,
                    const SurfaceMesh& mesh, std::vector<Cap>& caps) {
    std::vector<std::string> names;
    for (const PartFace& face : part.faces) names.push_back(face.name);
    for (const std::string& name : open.names) {
        if (std::find(names.begin(), names.end(), name) == names.end()) {
            unknown_name("face", deck.part, name, names);
        }
    }
    bool has_caps = false;
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        const auto& wanted = open.names;
        const bool is_named = std::find(wanted.begin(), wanted.end(), names[f]) != wanted.end();
        has_caps = has_caps || part.faces[f].is_cap;
        if (!is_named && !(open.all && part.faces[f].is_cap)) continue;
        const auto first = std::find(part.face_of_triangle.begin(), part.face_of_triangle.end(),
                                     static_cast<int>(f));
        const FaceHandle face(static_cast<int>(first - part.face_of_triangle.begin()));
        caps.push_back({names[f], mesh.data(face).region});
    }
    if (open.all && !has_caps) {
        std::vector<std::string> plane;
        for (const PartFace& face : part.faces) {
            if (face.kind == PartFaceKind::plane) plane.push_back(face.name);
        }
        throw InputError("mesh: the part '{}' has no caps to open{}", deck.part,
                         plane.empty() ? ", nor plane faces"
                                       : "; name plane faces of " + io::quoted_list(plane));
    }
}

std::vector<Cap> select_caps(const io::MeshDeck& deck, const io::CapSelection& open,
                             const std::optional<PartSurface>& part, const SurfaceMesh& mesh,
                             const Features& features) {
    std::vector<Cap> caps;
    if (part) {
        add_named_caps(deck, open, *part, mesh, caps);
    } else if (open.all || !open.names.empty()) {
        throw InputError(
            "mesh: faces of a file have no names to open them by; give points on them (open_at, "
            "--open-at) or their normals (open_facing, --open-facing)");
    }
    const auto add = [&](int region, const std::string& name) {
        const bool is_known = std::any_of(caps.begin(), caps.end(),
                                          [&](const Cap& cap) { return cap.region == region; });
        if (!is_known) caps.push_back({name, region});
    };
    for (std::size_t k = 0; k < open.points.size(); ++k) {
        add(region_near(mesh, open.points[k]), fmt::format("at_{}", k + 1));
    }
    constexpr double degree = std::numbers::pi / 180.0;
    for (std::size_t k = 0; k < open.normals.size(); ++k) {
        const Vector3& normal = open.normals[k];
        const auto regions = regions_facing(features, normal, degree);
        if (regions.empty()) {
            throw InputError(
                "mesh: no plane face with one boundary loop faces ({:.6g}, {:.6g}, {:.6g}), to a "
                "degree",
                normal.x(), normal.y(), normal.z());
        }
        for (std::size_t r = 0; r < regions.size(); ++r) {
            add(regions[r], fmt::format("facing_{}_{}", k + 1, r + 1));
        }
    }
    return caps;
}

// What a deck opens: what it says, or what was open on the member that it is cut like.
io::CapSelection caps_to_open(const io::MeshDeck& deck, const std::optional<MemberRecord>& record) {
    io::CapSelection open = deck.open;
    if (!record || deck.part.empty() || !open.is_empty()) return open;
    for (const auto& curve : record->pants.curves) {
        if (curve.kind == PantsCurveKind::boundary) open.names.push_back(curve.name);
    }
    return open;
}

// Faces of a part, or the smooth faces of a file.
NamedFaces named_faces(const SurfaceMesh& closed, const Features& features,
                       const std::optional<PartSurface>& part) {
    NamedFaces faces{to_soup(closed), {}, {}};
    if (part) {
        faces.face_of_triangle = part->face_of_triangle;
        for (const PartFace& face : part->faces) faces.names.push_back(face.name);
        return faces;
    }
    for (const auto face : closed.faces()) {
        faces.face_of_triangle.push_back(closed.data(face).region);
    }
    for (std::size_t r = 0; r < features.regions.size(); ++r) {
        faces.names.push_back(fmt::format("face_{}", r + 1));
    }
    return faces;
}

// The name of the part's curve along each edge of it, by the numbers of the edge's vertices.
std::map<std::pair<int, int>, std::string> names_of_edges(const PartSurface& part) {
    std::map<std::pair<int, int>, std::string> names;
    for (const PartCurve& curve : part.feature_curves) {
        const std::size_t n = curve.vertices.size();
        for (std::size_t k = 0; k + (curve.is_closed ? 0 : 1) < n; ++k) {
            const auto [low, high] = std::minmax({curve.vertices[k], curve.vertices[(k + 1) % n]});
            names[{low, high}] = curve.name;
        }
    }
    return names;
}

}  // namespace

io::DescribedSurface read_surface(const io::MeshDeck& deck) {
    if (!deck.part.empty() && (deck.fix || deck.fill_holes || deck.shell)) {
        throw InputError(
            "mesh: --fix, --fill-holes and --shell (fix, fill_holes, shell of [meshing]) are for "
            "files; the part '{}' has nothing to repair",
            deck.part);
    }
    const std::string source = deck.part.empty() ? deck.surface.string() : deck.part;
    return load_surface("mesh", {.surface = source,
                                 .overrides = {},
                                 .parameters = deck.parameters,
                                 .edge_length = deck.edge_length,
                                 .units = deck.units,
                                 .fix = deck.fix,
                                 .fill_holes = deck.fill_holes,
                                 .shell = deck.shell});
}

PreparedSurface prepare_surface(const io::MeshDeck& deck,
                                const std::filesystem::path& problems_file) {
    const io::DescribedSurface described = read_surface(deck);
    const std::optional<PartSurface>& part = described.part;
    PreparedSurface surface;
    if (!deck.like.empty()) surface.record = io::read_member_record(deck.like);
    surface.mesh = make_checked_mesh("mesh", described, problems_file);
    if (part) surface.landmarks = part_landmarks(*part);
    surface.part = part;
    const Features closed_features = detect_features(surface.mesh, deck.features);
    if (compute_invariants(surface.mesh).n_boundaries == 0) {
        surface.faces = named_faces(surface.mesh, closed_features, part);
    }
    std::vector<Cap> caps;
    std::vector<int> cap_of_vertex(surface.mesh.n_vertices(), -1);
    const io::CapSelection open = caps_to_open(deck, surface.record);
    if (!open.is_empty()) {
        caps = select_caps(deck, open, part, surface.mesh, closed_features);
        OpenedSurface opened = open_caps(surface.mesh, closed_features, caps);
        surface.caps = caps_of(surface.mesh, opened);
        surface.mesh = make_surface_mesh(opened.soup);
        cap_of_vertex = std::move(opened.cap_of_vertex);
        surface.closed_vertices = std::move(opened.vertices);
    }
    for (const BoundaryLoop& loop : boundary_loops(surface.mesh)) {
        const int cap = cap_of_vertex[loop.vertices.front().idx()];
        surface.boundary_names.push_back(cap >= 0 ? caps[cap].name : std::string());
    }
    return surface;
}

Features find_features(const io::MeshDeck& deck, PreparedSurface& surface) {
    Features features = detect_features(surface.mesh, deck.features);
    if (!surface.part) return features;
    const auto on_part = [&](VertexHandle v) {
        return surface.closed_vertices.empty() ? v.idx() : surface.closed_vertices[v.idx()];
    };
    const auto names = names_of_edges(*surface.part);
    for (FeatureCurve& curve : features.curves) {
        const auto [low, high] =
            std::minmax({on_part(curve.vertices[0]), on_part(curve.vertices[1])});
        const auto name = names.find({low, high});
        if (name != names.end()) curve.name = name->second;
    }
    std::map<int, std::string> corners;
    for (const PartCorner& corner : surface.part->corners) corners[corner.vertex] = corner.name;
    for (const VertexHandle v : features.corners) {
        const auto name = corners.find(on_part(v));
        if (name != corners.end()) features.corner_names[v.idx()] = name->second;
    }
    return features;
}

PantsOptions pants_options(const io::MeshDeck& deck, const PreparedSurface& surface) {
    PantsOptions options = deck.pants;
    options.boundary_names = surface.boundary_names;
    for (const io::CycleThrough& cycle : deck.cycles_through) {
        auto& points = options.cycles_through.emplace_back(cycle.points);
        for (const std::string& name : cycle.corners) {
            const auto& corners = surface.landmarks.corners;
            const auto corner = corners.find(name);
            if (corner == corners.end()) {
                std::vector<std::string> names;
                for (const auto& [known, x] : corners) names.push_back(known);
                unknown_name("corner", deck.part, name, names);
            }
            points.push_back(corner->second);
        }
    }
    return options;
}

}  // namespace couture::drivers
