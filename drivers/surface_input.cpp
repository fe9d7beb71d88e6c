#include "drivers/surface_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/did_you_mean.h"
#include "io/surface_writer.h"
#include "meshing/parts/part_surface.h"

namespace couture::drivers {

namespace {

using meshing::FlawKind;

void read_or_build(const std::string& command, const SurfaceInputOptions& options,
                   io::DescribedSurface& surface) {
    if (!is_part_input(options.surface)) {
        if (!options.overrides.empty() || options.edge_length != 0.0) {
            throw InputError(
                "{}: --set and --edge-length are for parts; '{}' is a file, which is taken as it "
                "is",
                command, options.surface);
        }
        surface.file = io::read_surface_file(options.surface);
        return;
    }
    std::map<std::string, double> parameters = options.parameters;
    for (const std::string& setting : options.overrides) {
        parameters.insert(read_setting(command, setting, "--set"));
    }
    constexpr double millimetre = 1e-3;
    const double unit = options.units.scale(io::dimensions::length) / millimetre;
    for (auto& [name, value] : parameters) value *= unit;
    surface.part =
        meshing::make_part_surface(options.surface, parameters, unit * options.edge_length);
    for (Vector3& point : surface.part->soup.points) point /= unit;
    io::SurfaceFile& file = surface.file;
    file.soup = surface.part->soup;
    file.format = "part";
    file.n_points_read = static_cast<int>(file.soup.points.size());
    file.n_polygons_read = static_cast<int>(file.soup.triangles.size());
}

/// What to do about a kind that is refused.
std::string advice(FlawKind kind, bool is_parted) {
    switch (kind) {
        case FlawKind::self_intersection:
            if (is_parted) {
                return "--fix gave parts that touch a vertex each, but they still lie in one "
                       "place: move them apart, or join them along an edge, where the surface was "
                       "made, or take one alone with --shell N";
            }
            return "such must be resolved where the surface was made";
        case FlawKind::disjoint_shell:
            return "choose one with --shell N, numbered from 0 as 'couture info' lists components";
        case FlawKind::non_manifold_vertex:
            return "--fix gives each part a vertex of its own";
        case FlawKind::inconsistent_edge:
            return "a surface that cannot be oriented (as a Moebius strip) bounds no solid";
        case FlawKind::non_manifold_edge:
            return "an edge has two triangles; remove inner walls and what stands out of the "
                   "surface where it was made";
        default:
            return "a solid needs a closed surface around it";
    }
}

constexpr std::array refused{FlawKind::non_manifold_edge,  FlawKind::non_manifold_vertex,
                             FlawKind::inconsistent_edge,  FlawKind::disjoint_shell,
                             FlawKind::duplicate_triangle, FlawKind::self_intersection,
                             FlawKind::too_few_triangles,  FlawKind::no_volume};

std::string times(int n) { return n == 1 ? "" : fmt::format(" ({} such)", n); }

}  // namespace

std::pair<std::string, double> read_setting(const std::string& command, const std::string& setting,
                                            const char* option) {
    const std::size_t sign = setting.find('=');
    double value = 0.0;
    if (sign != std::string::npos) {
        const char* first = setting.data() + sign + 1;
        const char* end = setting.data() + setting.size();
        const auto [stop, error] = std::from_chars(first, end, value);
        if (error == std::errc() && stop == end && first != end) {
            return {setting.substr(0, sign), value};
        }
    }
    throw InputError("{}: {} '{}' is no setting; write NAME=NUMBER", command, option, setting);
}

void require_file_or_part(const std::string& command, const std::string& name) {
    const std::filesystem::path path(name);
    if (path.has_extension() || path.has_parent_path() || is_part_input(name) ||
        std::filesystem::exists(path)) {
        return;
    }
    std::vector<std::string> names;
    for (const meshing::PartInfo& part : meshing::part_surfaces()) names.push_back(part.name);
    const std::string help = io::did_you_mean(name, names);
    throw InputError("{}: there is no file and no part '{}'{} Parts are {}", command, name,
                     help.empty() ? "." : help, io::quoted_list(names));
}

bool is_part_input(const std::string& name) {
    const auto& parts = meshing::part_surfaces();
    return std::any_of(parts.begin(), parts.end(),
                       [&](const meshing::PartInfo& part) { return part.name == name; });
}

bool is_surface_input(const std::string& name) {
    return io::is_surface_file(name) || is_part_input(name);
}

io::DescribedSurface load_surface(const std::string& command, const SurfaceInputOptions& options) {
    require_file_or_part(command, options.surface);
    io::DescribedSurface surface;
    surface.name = options.surface;
    read_or_build(command, options, surface);
    meshing::RepairedSurface repaired = meshing::repair_surface(surface.file.soup);
    surface.soup = std::move(repaired.soup);
    surface.repair = std::move(repaired.report);
    std::vector<int> turned = std::move(repaired.turned);
    if (options.fix || options.fill_holes) {
        meshing::FixOptions fix{.fills_holes = options.fill_holes};
        if (!options.fix) fix.weld_distance = fix.flatness = 0.0;
        meshing::FixedSurface fixed = meshing::fix_surface(surface.soup, fix);
        surface.soup = std::move(fixed.soup);
        surface.fix = std::move(fixed.report);
        // Triangles have other numbers now.
        turned.clear();
    }
    if (options.shell) {
        meshing::SelectedShell selected = meshing::select_shell(surface.soup, *options.shell);
        surface.soup = std::move(selected.soup);
        if (selected.was_cavity) surface.former_cavity = *options.shell;
        turned.clear();
    }
    surface.n_shells_turned = meshing::orient_outwards(surface.soup, turned);
    surface.check = meshing::check_solid(surface.soup);
    return surface;
}

meshing::SurfaceMesh make_checked_mesh(const std::string& command,
                                       const io::DescribedSurface& surface,
                                       const std::filesystem::path& problems_file) {
    const meshing::SurfaceCheck& check = surface.check;
    if (surface.repair.n_turned > 0) {
        log::warn(
            fmt::format("{}: {} triangles ran against their neighbours; they are turned round",
                        command, surface.repair.n_turned));
    }
    if (surface.former_cavity) {
        log::info(fmt::format("{}: {}", command, io::describe_former_cavity(surface)));
    } else if (surface.n_shells_turned > 0) {
        log::warn(fmt::format("{}: {} of the surface {} inside out; {} turned round", command,
                              surface.n_shells_turned == 1
                                  ? "a shell"
                                  : fmt::format("{} shells", surface.n_shells_turned),
                              surface.n_shells_turned == 1 ? "is" : "are",
                              surface.n_shells_turned == 1 ? "it is" : "they are"));
    }
    const bool is_parted = surface.fix && surface.fix->n_split_vertices > 0;
    std::string text;
    FlawKind first = FlawKind::none;
    for (const FlawKind kind : refused) {
        const meshing::SurfaceFlaw* flaw = check.first(kind);
        if (flaw == nullptr) continue;
        if (first == FlawKind::none) first = kind;
        text += fmt::format("\n  {}{} at {}; {}", to_string(kind), times(check.count(kind)),
                            flaw->text, advice(kind, is_parted));
    }
    if (first != FlawKind::none) {
        std::string message = fmt::format("{}: {} can't be meshed:{}", command, surface.name, text);
        if (!problems_file.empty()) {
            write_problems(problems_file, surface);
            message += fmt::format("\n  all places are marked in {}", problems_file.string());
        }
        if (first == FlawKind::self_intersection) throw GeometryError("{}", message);
        throw TopologyError("{}", message);
    }
    if (const meshing::SurfaceFlaw* flaw = check.first(FlawKind::flat_triangle)) {
        log::warn(fmt::format("{}: flat triangle{} at {}; --fix removes such", command,
                              times(check.count(FlawKind::flat_triangle)), flaw->text));
    }
    for (const meshing::SurfaceFlaw& flaw : check.flaws) {
        if (flaw.kind != FlawKind::open_boundary) continue;
        log::info(fmt::format("{}: the surface is open at {}", command, flaw.text));
    }
    return meshing::make_surface_mesh(surface.soup);
}

void write_problems(const std::filesystem::path& path, const io::DescribedSurface& surface) {
    const auto flaws = meshing::flaw_of_triangle(surface.check, surface.soup.triangles.size());
    MatrixX values(static_cast<Eigen::Index>(flaws.size()), 1);
    for (std::size_t t = 0; t < flaws.size(); ++t) {
        values(static_cast<Eigen::Index>(t), 0) = flaws[t];
    }
    std::vector<io::SurfaceLine> lines;
    for (std::size_t i = 0; i < surface.check.flaws.size(); ++i) {
        const meshing::SurfaceFlaw& flaw = surface.check.flaws[i];
        if (flaw.line.empty()) continue;
        lines.push_back({.points = flaw.line,
                         .is_closed = flaw.is_closed,
                         .kind = static_cast<int>(flaw.kind),
                         .number = static_cast<int>(i)});
    }
    const std::vector<io::SurfaceArray> on_triangles{{"problem", values}};
    io::write_vtp(path, surface.soup, {}, on_triangles, lines,
                  fmt::format("couture {} problems of {}", COUTURE_VERSION, surface.name));
}

io::Scene problems_scene(const io::DescribedSurface& surface) {
    constexpr io::Color red{0.84, 0.15, 0.16};
    const meshing::TriangleSoup& soup = surface.soup;
    const auto flaws = meshing::flaw_of_triangle(surface.check, soup.triangles.size());
    MatrixX vertices(static_cast<Eigen::Index>(soup.points.size()), 3);
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        vertices.row(static_cast<Eigen::Index>(i)) = soup.points[i].transpose();
    }
    io::Scene scene;
    for (const bool is_flawed : {false, true}) {
        std::vector<int> corners;
        for (std::size_t t = 0; t < flaws.size(); ++t) {
            if ((flaws[t] != 0) != is_flawed) continue;
            const std::array<int, 3>& triangle = soup.triangles[t];
            corners.insert(corners.end(), triangle.begin(), triangle.end());
        }
        if (corners.empty()) continue;
        io::SurfacePiece piece;
        piece.vertices = vertices;
        piece.triangles = Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
            corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
        if (is_flawed) piece.color = red;
        scene.surfaces.push_back(std::move(piece));
    }
    for (const meshing::SurfaceFlaw& flaw : surface.check.flaws) {
        if (flaw.line.empty()) continue;
        MatrixX points(static_cast<Eigen::Index>(flaw.line.size()), 3);
        for (std::size_t k = 0; k < flaw.line.size(); ++k) {
            points.row(static_cast<Eigen::Index>(k)) = flaw.line[k].transpose();
        }
        scene.curves.push_back(
            {.points = std::move(points), .is_closed = flaw.is_closed, .color = red, .width = 4.0});
    }
    return scene;
}

}  // namespace couture::drivers
