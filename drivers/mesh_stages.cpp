#include "drivers/mesh_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "drivers/own_layout.h"
#include "drivers/prepared_surface.h"
#include "drivers/solid_stages.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "io/did_you_mean.h"
#include "io/pants_file.h"
#include "io/surface_writer.h"
#include "meshing/layout/place_layout.h"
#include "meshing/pipeline/rounded_edges.h"
#include "meshing/surface/curvature.h"
#include "meshing/surface/curvature_clusters.h"
#include "meshing/surface/cut_surface.h"
#include "meshing/topology/member_warp.h"

namespace couture::drivers {

namespace {

using namespace meshing;

constexpr std::array<const char*, 11> stage_names{"surface",  "features", "loops", "pants",
                                                  "layout",   "field",    "map",   "quads",
                                                  "surfaces", "volume",   "hexes"};

// Weight of sharp edges in the criterion of cycles if the deck gives none and cuboids are to
// follow: cuts cross them.
constexpr double clear_of_sharp_edges = -0.75;

meshing::SolidStage solid_stage(MeshStage stage) {
    return static_cast<meshing::SolidStage>(static_cast<int>(stage) -
                                            static_cast<int>(MeshStage::layout));
}

// Kinds of curves in files; pants curves have those of PantsCurveKind.
constexpr int tunnel_kind = 4;
constexpr int feature_kind = 5;

io::Color color_of_kind(int kind) {
    switch (kind) {
        case static_cast<int>(PantsCurveKind::handle):
            return {0.84, 0.15, 0.16};
        case static_cast<int>(PantsCurveKind::cycle):
            return {0.0, 0.62, 0.85};
        case tunnel_kind:
            return {0.13, 0.63, 0.20};
        default:
            return {0.12, 0.14, 0.17};
    }
}

io::SurfaceLine make_line(const SurfaceMesh& mesh, const std::vector<VertexHandle>& vertices,
                          bool is_closed, int kind, int number) {
    io::SurfaceLine line{.points = {}, .is_closed = is_closed, .kind = kind, .number = number};
    for (const VertexHandle vertex : vertices) line.points.push_back(mesh.point(vertex));
    return line;
}

std::vector<io::SurfaceLine> lines_of(const MeshStages& stages, MeshStage stage) {
    std::vector<io::SurfaceLine> lines;
    if (stage == MeshStage::features) {
        for (const FeatureCurve& curve : stages.features.curves) {
            lines.push_back(make_line(stages.mesh, curve.vertices, curve.is_closed, feature_kind,
                                      static_cast<int>(lines.size())));
        }
    }
    if (!stages.pants) return lines;
    for (std::size_t c = 0; c < stages.pants->curves.size(); ++c) {
        const PantsCurve& curve = stages.pants->curves[c];
        const bool is_shown = stage == MeshStage::pants ||
                              (stage == MeshStage::loops && curve.kind != PantsCurveKind::cycle);
        if (!is_shown) continue;
        lines.push_back(make_line(stages.mesh, curve.curve.vertices, true,
                                  static_cast<int>(curve.kind), static_cast<int>(c)));
    }
    if (stage == MeshStage::loops) {
        for (std::size_t t = 0; t < stages.pants->tunnels.size(); ++t) {
            lines.push_back({.points = stages.pants->tunnels[t],
                             .is_closed = true,
                             .kind = tunnel_kind,
                             .number = static_cast<int>(t)});
        }
    }
    return lines;
}

// For each face the number of what has a colour of its own at a stage.
std::vector<int> part_of_face(const MeshStages& stages, MeshStage stage) {
    std::vector<int> part(stages.mesh.n_faces(), 0);
    for (const auto face : stages.mesh.faces()) {
        if (stage == MeshStage::features) part[face.idx()] = stages.mesh.data(face).region;
        if (stage == MeshStage::pants && stages.pants) {
            part[face.idx()] = stages.pants->patch_of_face[face.idx()];
        }
    }
    return part;
}

MatrixX column(const std::vector<double>& values) {
    return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<io::SurfaceArray> curvature_arrays(const SurfaceMesh& mesh) {
    const auto gaussian = gaussian_curvature(mesh);
    const auto principal = principal_curvatures(mesh);
    const auto n = static_cast<Eigen::Index>(gaussian.size());
    MatrixX classes(n, 1);
    MatrixX minimum(n, 1);
    MatrixX maximum(n, 1);
    MatrixX direction(n, 3);
    const std::vector<int> cluster = find_curvature_clusters(mesh).cluster_of_vertex;
    for (Eigen::Index v = 0; v < n; ++v) {
        classes(v, 0) = static_cast<double>(classify_curvature(gaussian[v]));
        minimum(v, 0) = principal[v].minimum;
        maximum(v, 0) = principal[v].maximum;
        direction.row(v) = principal[v].minimum_direction.transpose();
    }
    return {{"gaussian_curvature", column(gaussian)},
            {"geodesic_curvature", column(geodesic_curvature(mesh))},
            {"curvature_class", classes},
            {"curvature_cluster", column(std::vector<double>(cluster.begin(), cluster.end()))},
            {"minimum_curvature", minimum},
            {"maximum_curvature", maximum},
            {"minimum_direction", direction}};
}

// Mean curvature at the vertices, positive where the surface is convex.
VectorX mean_curvature(const SurfaceMesh& mesh) {
    VectorX mean(static_cast<Eigen::Index>(mesh.n_vertices()));
    const auto principal = principal_curvatures(mesh);
    for (Eigen::Index v = 0; v < mean.size(); ++v) {
        mean[v] = 0.5 * (principal[v].minimum + principal[v].maximum);
    }
    return mean;
}

// From -m to m with a fiftieth of the values beyond: nothing is the middle of the colours.
std::array<double, 2> shown_range(const SurfaceMesh& mesh, const VectorX& values) {
    std::vector<double> sizes(values.size());
    std::transform(values.begin(), values.end(), sizes.begin(),
                   [](double value) { return std::abs(value); });
    std::sort(sizes.begin(), sizes.end());
    const double most = sizes[sizes.size() - 1 - sizes.size() / 50];
    constexpr double rounding = 1e-9;
    if (most * bounding_box_diagonal(mesh) < rounding) return {0.0, 0.0};
    return {-most, most};
}

io::CurvePiece make_curve(const io::SurfaceLine& line) {
    MatrixX points(static_cast<Eigen::Index>(line.points.size()), 3);
    for (std::size_t k = 0; k < line.points.size(); ++k) {
        points.row(static_cast<Eigen::Index>(k)) = line.points[k].transpose();
    }
    return {.points = std::move(points),
            .is_closed = line.is_closed,
            .color = color_of_kind(line.kind),
            .width = line.kind == feature_kind ? 2.2 : 5.0};
}

// The smooth faces, apart from each other.
SurfaceMesh open_along_features(const SurfaceMesh& mesh) {
    const std::vector<FaceHandle> faces(mesh.faces_begin(), mesh.faces_end());
    std::vector<bool> is_sharp(mesh.n_edges());
    for (const auto edge : mesh.edges()) is_sharp[edge.idx()] = mesh.data(edge).feature >= 0;
    const CutSurface opened(mesh, faces, is_sharp);
    TriangleSoup soup;
    for (int v = 0; v < opened.n_vertices(); ++v) soup.points.push_back(opened.point(v));
    for (int f = 0; f < opened.n_faces(); ++f) soup.triangles.push_back(opened.triangle(f));
    return make_surface_mesh(soup);
}

// The surface coloured by its mean curvature, with its sharp curves. Those belong to no smooth
// face: theirs would grow with the mesh and hide all others.
io::Scene make_curvature_scene(SurfaceMesh mesh) {
    io::Scene scene;
    for (const FeatureCurve& curve : detect_features(mesh).curves) {
        scene.curves.push_back(
            make_curve(make_line(mesh, curve.vertices, curve.is_closed, feature_kind, 0)));
    }
    const SurfaceMesh opened = open_along_features(mesh);
    io::SurfacePiece piece;
    piece.vertices.resize(static_cast<Eigen::Index>(opened.n_vertices()), 3);
    for (const auto vertex : opened.vertices()) {
        piece.vertices.row(vertex.idx()) = opened.point(vertex).transpose();
    }
    piece.triangles.resize(static_cast<Eigen::Index>(opened.n_faces()), 3);
    for (const auto face : opened.faces()) {
        const auto [a, b, c] = face_vertices(opened, face);
        piece.triangles.row(face.idx()) << a.idx(), b.idx(), c.idx();
    }
    piece.values = mean_curvature(opened);
    scene.range = shown_range(mesh, piece.values);
    scene.legend = "mean curvature";
    scene.title = to_string(MeshStage::surface);
    scene.surfaces.push_back(std::move(piece));
    return scene;
}

// Warns of sharp edges that no arc runs along, the longest first.
void warn_of_rounded_edges(const CuboidDecomposition& cuboids, const Features& features) {
    std::vector<RoundedEdge> rounded = find_rounded_edges(cuboids);
    std::ranges::stable_sort(rounded, std::greater<>(), &RoundedEdge::length);
    constexpr std::size_t most_named = 5;
    for (std::size_t k = 0; k < std::min(rounded.size(), most_named); ++k) {
        const RoundedEdge& edge = rounded[k];
        const FeatureCurve& curve = features.curves[edge.curve];
        log::warn(fmt::format(
            "layout: no arc runs along {:.4g} of the length {:.4g} of the sharp edge {}, near "
            "({:.6g}, {:.6g}, {:.6g}); it is rounded there",
            edge.length, curve.length,
            curve.name.empty() ? std::to_string(edge.curve) : fmt::format("'{}'", curve.name),
            edge.place.x(), edge.place.y(), edge.place.z()));
    }
    if (rounded.size() > most_named) {
        log::warn(
            fmt::format("layout: so are {} shorter sharp edges", rounded.size() - most_named));
    }
}

using Corners = std::array<std::array<double, 3>, 3>;

Corners sorted_corners(const Vector3& a, const Vector3& b, const Vector3& c) {
    Corners corners{{{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, {c.x(), c.y(), c.z()}}};
    std::ranges::sort(corners);
    return corners;
}

// Those that were not taken off with a cap.
std::vector<std::string> names_of_faces_left(const NamedFaces& faces, const SurfaceMesh& mesh) {
    std::set<Corners> left;
    for (const auto face : mesh.faces()) {
        std::vector<Vector3> points;
        for (const auto vertex : mesh.fv_range(face)) points.push_back(mesh.point(vertex));
        left.insert(sorted_corners(points[0], points[1], points[2]));
    }
    std::vector<bool> is_left(faces.names.size(), false);
    for (std::size_t t = 0; t < faces.soup.triangles.size(); ++t) {
        const auto& [a, b, c] = faces.soup.triangles[t];
        const auto& points = faces.soup.points;
        if (left.contains(sorted_corners(points[a], points[b], points[c]))) {
            is_left[faces.face_of_triangle[t]] = true;
        }
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < is_left.size(); ++i) {
        if (is_left[i]) names.push_back(faces.names[i]);
    }
    return names;
}

// Faces of the surface that no side of a cuboid belongs to.
// Where the tolerance chose the elements.
void warn_of_distance(const meshing::SolidMesh& solid, const meshing::SolidMeshOptions& options) {
    if (!solid.distance || options.element_size > 0.0) return;
    const double of_edges = 0.5 * options.tolerance;
    if (solid.distance->surface <= options.tolerance && solid.distance->features <= of_edges) {
        return;
    }
    log::warn(fmt::format(
        "volume: splines are {:.2e} of the diagonal from the surface and {:.2e} from "
        "its sharp edges, the tolerance asks for {:.2e} and {:.2e}",
        solid.distance->surface, solid.distance->features, options.tolerance, of_edges));
}

void warn_of_lost_faces(const std::vector<std::string>& faces,
                        const std::map<std::string, std::vector<CuboidSide>>& sets) {
    std::vector<std::string> lost;
    for (const std::string& name : faces) {
        const auto set = sets.find(name);
        if (set == sets.end() || set->second.empty()) lost.push_back(name);
    }
    if (lost.empty()) return;
    log::warn(
        fmt::format("mesh: no side of a cuboid lies on the faces {}: there are no sets of these "
                    "names; a layout "
                    "with cuboids at them would have them",
                    io::quoted_list(lost)));
}

io::Scene make_scene(const MeshStages& stages, MeshStage stage,
                     const std::vector<io::SurfaceLine>& lines) {
    const SurfaceMesh& mesh = stages.mesh;
    const std::vector<int> part = part_of_face(stages, stage);
    const int n_parts = part.empty() ? 0 : 1 + *std::max_element(part.begin(), part.end());
    std::vector<std::vector<std::array<int, 3>>> triangles(n_parts);
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        triangles[part[face.idx()]].push_back({a.idx(), b.idx(), c.idx()});
    }
    io::Scene scene;
    std::vector<int> number(mesh.n_vertices(), -1);
    for (int p = 0; p < n_parts; ++p) {
        io::SurfacePiece piece;
        std::vector<int> used;
        piece.triangles.resize(static_cast<Eigen::Index>(triangles[p].size()), 3);
        for (std::size_t t = 0; t < triangles[p].size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                int& n = number[triangles[p][t][k]];
                if (n < 0) {
                    n = static_cast<int>(used.size());
                    used.push_back(triangles[p][t][k]);
                }
                piece.triangles(static_cast<Eigen::Index>(t), k) = n;
            }
        }
        piece.vertices.resize(static_cast<Eigen::Index>(used.size()), 3);
        for (std::size_t v = 0; v < used.size(); ++v) {
            piece.vertices.row(static_cast<Eigen::Index>(v)) =
                mesh.point(VertexHandle(used[v])).transpose();
            number[used[v]] = -1;
        }
        if (n_parts > 1) piece.color = io::part_color(p);
        scene.surfaces.push_back(std::move(piece));
    }
    for (const io::SurfaceLine& line : lines) scene.curves.push_back(make_curve(line));
    scene.title = to_string(stage);
    return scene;
}

}  // namespace

MeshStage read_mesh_stage(const std::string& name) {
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
        if (name == stage_names[i]) return static_cast<MeshStage>(i);
    }
    const std::vector<std::string> names(stage_names.begin(), stage_names.end());
    throw InputError("mesh: there is no stage '{}'{} There are {}", name,
                     io::did_you_mean(name, names).empty() ? "." : io::did_you_mean(name, names),
                     io::quoted_list(names));
}

std::string to_string(MeshStage stage) { return stage_names[static_cast<std::size_t>(stage)]; }

MeshStages run_mesh_stages(const io::MeshDeck& deck, const std::filesystem::path& problems_file) {
    MeshStages stages;
    run_mesh_stages(deck, problems_file, stages);
    return stages;
}

void run_mesh_stages(const io::MeshDeck& deck, const std::filesystem::path& problems_file,
                     MeshStages& stages) {
    const MeshStage last = read_mesh_stage(deck.stage);
    PreparedSurface surface = prepare_surface(deck, problems_file);
    PantsOptions options = pants_options(deck, surface);
    const Timer timer;
    double last_said = 0.0;
    options.progress = [&](std::string_view what, double fraction) {
        if (timer.seconds() < last_said + 1.0) return;
        last_said = timer.seconds();
        log::info(fmt::format("mesh: {} ({:.0f} %, {:.0f} s)", what, 100.0 * fraction, last_said));
    };
    stages = {};
    if (last >= MeshStage::features) stages.features = find_features(deck, surface);
    stages.mesh = std::move(surface.mesh);
    stages.part = std::move(surface.part);
    stages.invariants = compute_invariants(stages.mesh);
    stages.surface_name = surface_name(stages.mesh);
    check_gauss_bonnet(stages.mesh);
    if (last < MeshStage::loops) return;
    meshing::SolidMeshOptions solid = deck.solid;
    if (!deck.like.empty()) solid.node_tolerance = meshing::family_node_tolerance;
    solid.progress = [&](std::string_view what) {
        log::info(fmt::format("mesh: {} ({:.0f} s)", what, timer.seconds()));
    };
    solid.faces = std::move(surface.faces);
    if (last > MeshStage::pants) solid.last = solid_stage(last);
    const auto run_solid = [&](CuboidDecomposition cuboids) {
        warn_of_rounded_edges(cuboids, stages.features);
        // What is left if mesh_solid throws.
        stages.solid.emplace().cuboids = cuboids;
        stages.solid = mesh_solid(std::move(cuboids), solid);
        if (stages.solid->distance && stages.solid->distance->rounded > 0.0) {
            log::warn(fmt::format(
                "volume: sharp edges that no arc runs along are rounded by {:.2e} of the diagonal",
                stages.solid->distance->rounded));
        }
        warn_of_distance(*stages.solid, solid);
        if (solid.faces) {
            warn_of_lost_faces(names_of_faces_left(*solid.faces, stages.mesh),
                               stages.solid->cuboids.volume.sets);
        }
    };
    if (!deck.layout.empty() && last > MeshStage::pants) {
        solid.progress("placing the layout");
        SurfaceMesh mesh = stages.mesh;
        const OwnLayout own = read_own_layout(deck, mesh, stages.features, surface.landmarks);
        run_solid(place_layout(mesh, stages.features, own.placed, own.options));
        return;
    }
    std::optional<ClosingCaps> caps = surface.caps;
    if (last > MeshStage::pants && stages.invariants.n_components > 1) {
        throw InputError(
            "mesh: the surface has {} shells: cuboids are made of one, without cavities; take one "
            "(shell), or stop at stage pants",
            stages.invariants.n_components);
    }
    if (last > MeshStage::pants) {
        if (!caps) caps = fill_boundaries(stages.mesh);
        if (options.cycle == CriterionWeights{}) options.cycle.sharp = clear_of_sharp_edges;
        options.cuts_tori = true;
    }
    options.only_handles = last == MeshStage::loops;
    if (surface.record) {
        stages.pants = replay_pants(stages.mesh, surface.record->pants, surface.boundary_names,
                                    surface.landmarks, deck.pants.loop_width);
    } else {
        stages.pants = decompose_into_pants(stages.mesh, options);
    }
    if (last >= MeshStage::pants)
        stages.record = record_pants(stages.mesh, *stages.pants, surface.landmarks);
    if (last <= MeshStage::pants) return;
    const TemplateLibrary library = template_library(deck);
    solid.progress("choosing and drawing cuboids");
    const auto cuboids = [&] {
        if (!surface.record || !surface.record->layout) {
            return decompose_into_cuboids(stages.mesh, stages.features, *stages.pants, *caps,
                                          library);
        }
        const MemberWarp warp(surface.record->pants, stages.mesh, surface.landmarks);
        return repeat_cuboids(stages.mesh, stages.features, *stages.pants, *caps, library,
                              carry_over(*surface.record->layout, warp));
    };
    run_solid(cuboids());
}

std::optional<MeshStage> reached_stage(const MeshStages& stages) {
    if (stages.solid) {
        if (stages.solid->volume) return MeshStage::volume;
        return stages.solid->quads ? MeshStage::quads : MeshStage::layout;
    }
    if (stages.pants) return MeshStage::pants;
    if (stages.mesh.n_faces() == 0) return {};
    return stages.features.curves.empty() ? MeshStage::surface : MeshStage::features;
}

io::Scene stage_scene(const MeshStages& stages, MeshStage stage) {
    if (stage > MeshStage::pants) {
        io::Scene scene = solid_scene(*stages.solid, solid_stage(stage));
        scene.title = to_string(stage);
        return scene;
    }
    return stage == MeshStage::surface ? make_curvature_scene(stages.mesh)
                                       : make_scene(stages, stage, lines_of(stages, stage));
}

void write_stage_picture(const std::filesystem::path& path, const MeshStages& stages,
                         MeshStage stage) {
    io::Scene scene = stage_scene(stages, stage);
    if (stage > MeshStage::pants) scene.title = path.stem().string();
    io::render_png(path, scene);
}

std::vector<std::filesystem::path> write_mesh_stage(const std::filesystem::path& stem,
                                                    const MeshStages& stages, MeshStage stage,
                                                    bool png, const std::string& provenance) {
    if (stage > MeshStage::pants) {
        std::vector<std::filesystem::path> files =
            write_solid_stage(stem, *stages.solid, solid_stage(stage), png, provenance);
        if (stage == MeshStage::layout && stages.record) {
            files.push_back(stem.string() + ".json");
            io::write_layout_record(files.back(), *stages.record, stages.solid->cuboids.record,
                                    provenance);
        }
        return files;
    }
    const std::vector<io::SurfaceLine> lines = lines_of(stages, stage);
    const std::vector<int> part = part_of_face(stages, stage);
    std::vector<io::SurfaceArray> on_points;
    std::vector<io::SurfaceArray> on_triangles;
    if (stage == MeshStage::surface) on_points = curvature_arrays(stages.mesh);
    if (stage == MeshStage::features || stage == MeshStage::pants) {
        on_triangles.push_back({stage == MeshStage::features ? "region" : "patch",
                                column(std::vector<double>(part.begin(), part.end()))});
    }
    std::filesystem::path vtp = stem;
    vtp += ".vtp";
    io::write_vtp(vtp, to_soup(stages.mesh), on_points, on_triangles, lines, provenance);
    std::vector<std::filesystem::path> files{vtp};
    if (stage == MeshStage::pants && stages.record) {
        std::filesystem::path record = stem;
        record += ".json";
        io::write_pants_record(record, *stages.record, provenance);
        files.push_back(record);
    }
    if (png) {
        std::filesystem::path picture = stem;
        picture += ".png";
        write_stage_picture(picture, stages, stage);
        files.push_back(picture);
    }
    return files;
}

}  // namespace couture::drivers
