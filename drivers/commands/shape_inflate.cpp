#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "drivers/commands/commands.h"
#include "drivers/number_list.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "io/atomic_file.h"
#include "io/obj_surface.h"
#include "io/picture.h"
#include "io/surface_reader.h"
#include "io/surface_writer.h"
#include "meshing/surface/inflated_sphere.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;
using meshing::InflatedSphere;
using meshing::InflationStop;

Vector3 vector_of(const std::vector<double>& numbers, std::size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

meshing::InflationOptions inflation_options(const ShapeInflateOptions& options) {
    const std::string command = "shape inflate";
    meshing::InflationOptions result;
    if (!options.center.empty()) {
        result.center =
            vector_of(read_number_list(command, "--center", options.center, "X,Y,Z"), 0);
    }
    result.radius = options.radius;
    result.strain_limit = options.strain_limit.value_or(result.strain_limit);
    result.outlet_strain_limit = options.outlet_strain_limit;
    result.hole_size = options.hole_size;
    result.n_divisions = options.n_divisions.value_or(result.n_divisions);
    for (const std::string& text : options.balls) {
        const auto n = read_number_list(command, "--ball", text, "X,Y,Z,RADIUS,LIMIT");
        result.regions.push_back({meshing::Ball{vector_of(n, 0), n[3]}, n[4]});
    }
    for (const std::string& text : options.boxes) {
        const auto n = read_number_list(command, "--box", text, "X0,Y0,Z0,X1,Y1,Z1,LIMIT");
        const Vector3 a = vector_of(n, 0);
        const Vector3 b = vector_of(n, 3);
        result.regions.push_back({meshing::AxisBox{a.cwiseMin(b), a.cwiseMax(b)}, n[6]});
    }
    return result;
}

/// Of the edges at each vertex the largest strain.
VectorX vertex_strains(const InflatedSphere& sphere) {
    VectorX strains = VectorX::Constant(static_cast<Eigen::Index>(sphere.stops.size()), -1.0);
    for (std::size_t e = 0; e < sphere.edges.size(); ++e) {
        for (const int v : sphere.edges[e]) strains[v] = std::max(strains[v], sphere.strains[e]);
    }
    return strains;
}

/// 0 where a vertex is in contact, 1 where it was held by strained edges.
VectorX stop_numbers(const InflatedSphere& sphere) {
    VectorX numbers(static_cast<Eigen::Index>(sphere.stops.size()));
    for (Eigen::Index v = 0; v < numbers.size(); ++v) {
        numbers[v] = sphere.stops[v] == InflationStop::contact ? 0.0 : 1.0;
    }
    return numbers;
}

MatrixX rows_of(const std::vector<Vector3>& points) {
    MatrixX rows(static_cast<Eigen::Index>(points.size()), 3);
    for (Eigen::Index v = 0; v < rows.rows(); ++v) rows.row(v) = points[v].transpose();
    return rows;
}

/// The edges of quads joined to long lines: behind each vertex of four edges the opposite one.
std::vector<std::vector<int>> grid_lines(const InflatedSphere& sphere) {
    std::map<std::pair<int, int>, std::vector<int>> next;
    std::vector<std::vector<int>> neighbours(sphere.stops.size());
    for (const auto& [a, b] : sphere.edges) {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    // Two edges of a quad meet in its corner; what no quad joins is opposite.
    std::map<std::pair<int, int>, std::vector<int>> beside;
    for (const auto& quad : sphere.mesh.quads) {
        for (int k = 0; k < 4; ++k) {
            const int before = quad[(k + 3) % 4];
            const int after = quad[(k + 1) % 4];
            beside[{before, quad[k]}].push_back(after);
            beside[{after, quad[k]}].push_back(before);
        }
    }
    std::map<std::pair<int, int>, bool> is_drawn;
    std::vector<std::vector<int>> lines;
    for (const auto& [a, b] : sphere.edges) {
        if (is_drawn[{a, b}]) continue;
        std::vector<int> line{a, b};
        is_drawn[{a, b}] = true;
        for (bool goes_on = true; goes_on;) {
            const int from = line[line.size() - 2];
            const int at = line.back();
            goes_on = false;
            for (const int to : neighbours[at]) {
                const auto& sides = beside[{from, at}];
                const auto edge = std::minmax(at, to);
                const bool is_opposite = to != from && std::ranges::find(sides, to) == sides.end();
                if (!is_opposite || is_drawn[edge]) continue;
                is_drawn[edge] = true;
                line.push_back(to);
                goes_on = true;
                break;
            }
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

io::Scene scene_of(const InflatedSphere& sphere, const meshing::TriangleSoup& wall,
                   const std::string& title) {
    io::Scene scene;
    scene.title = title;
    io::SurfacePiece quads;
    quads.vertices = rows_of(sphere.mesh.points);
    quads.triangles.resize(static_cast<Eigen::Index>(2 * sphere.mesh.quads.size()), 3);
    for (std::size_t q = 0; q < sphere.mesh.quads.size(); ++q) {
        const auto [a, b, c, d] = sphere.mesh.quads[q];
        quads.triangles.row(static_cast<Eigen::Index>(2 * q)) << a, b, c;
        quads.triangles.row(static_cast<Eigen::Index>(2 * q + 1)) << a, c, d;
    }
    quads.values = vertex_strains(sphere);
    scene.legend = "edge strain";
    scene.surfaces.push_back(std::move(quads));
    for (const std::vector<int>& line : grid_lines(sphere)) {
        io::CurvePiece curve;
        curve.points.resize(static_cast<Eigen::Index>(line.size()), 3);
        for (std::size_t k = 0; k < line.size(); ++k) {
            curve.points.row(static_cast<Eigen::Index>(k)) =
                sphere.mesh.points[line[k]].transpose();
        }
        curve.width = 1.0;
        scene.curves.push_back(std::move(curve));
    }
    io::SurfacePiece glass;
    glass.vertices = rows_of(wall.points);
    glass.triangles.resize(static_cast<Eigen::Index>(wall.triangles.size()), 3);
    for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
        const auto [a, b, c] = wall.triangles[t];
        glass.triangles.row(static_cast<Eigen::Index>(t)) << a, b, c;
    }
    glass.opacity = 0.25;
    scene.surfaces.push_back(std::move(glass));
    return scene;
}

struct Inflated {
    InflatedSphere sphere;
    meshing::InflationOptions options;
    int n_triangles = 0;
    double inflation_seconds = 0.0;
    double seconds = 0.0;
    std::vector<fs::path> files;
};

double mean_strain(const InflatedSphere& sphere) {
    return std::accumulate(sphere.strains.begin(), sphere.strains.end(), 0.0) /
           static_cast<double>(sphere.strains.size());
}

std::string inflated_json(const std::string& surface, const Inflated& run) {
    const InflatedSphere& sphere = run.sphere;
    const Vector3& c = sphere.center;
    const int n_points = static_cast<int>(sphere.stops.size());
    nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                     {"status", "done"},
                                     {"surface", surface},
                                     {"triangles", run.n_triangles},
                                     {"center", {c.x(), c.y(), c.z()}},
                                     {"radius", sphere.radius},
                                     {"divisions", run.options.n_divisions},
                                     {"strain_limit", run.options.strain_limit},
                                     {"regions", run.options.regions.size()},
                                     {"points", n_points},
                                     {"quads", sphere.mesh.quads.size()},
                                     {"contacts", sphere.n_contacts()},
                                     {"held", n_points - sphere.n_contacts()},
                                     {"free", sphere.n_free},
                                     {"max_strain", sphere.max_strain()},
                                     {"mean_strain", mean_strain(sphere)},
                                     {"inflation_seconds", run.inflation_seconds},
                                     {"seconds", run.seconds},
                                     {"warnings", log::warnings()}};
    if (run.options.outlet_strain_limit) {
        object["outlet_strain_limit"] = *run.options.outlet_strain_limit;
    }
    if (run.options.hole_size) object["hole_size"] = *run.options.hole_size;
    for (const fs::path& file : run.files) object["files"].push_back(file.string());
    return object.dump(2);
}

void print_inflated(const Inflated& run, const fs::path& folder) {
    const InflatedSphere& sphere = run.sphere;
    const Vector3& c = sphere.center;
    fmt::print("{} quads, {} points, from a sphere at ({:.6g}, {:.6g}, {:.6g}) of radius {:.6g}\n",
               sphere.mesh.quads.size(), sphere.stops.size(), c.x(), c.y(), c.z(), sphere.radius);
    fmt::print("{} vertices met the wall, {} were held by strained edges; {} had no wall ahead\n",
               sphere.n_contacts(), static_cast<int>(sphere.stops.size()) - sphere.n_contacts(),
               sphere.n_free);
    fmt::print("strain of edges: mean {:.3f}, largest {:.3f}\n", mean_strain(sphere),
               sphere.max_strain());
    fmt::print("{:.2f} s, {:.2f} s of them inflation; wrote {} files to {}\n", run.seconds,
               run.inflation_seconds, run.files.size(), folder.string());
}

void write_files(const std::string& name, const meshing::TriangleSoup& wall, const fs::path& folder,
                 bool with_picture, Inflated& run) {
    const std::string provenance =
        fmt::format("couture {} shape inflate; {}", COUTURE_VERSION, name);
    const fs::path stem = folder / (name + "_inflated");
    io::RawSurface polygons;
    polygons.points = run.sphere.mesh.points;
    for (const auto& quad : run.sphere.mesh.quads) polygons.add_polygon(quad);
    const std::array arrays{io::SurfaceArray{"stop", stop_numbers(run.sphere)},
                            io::SurfaceArray{"strain", vertex_strains(run.sphere)}};
    run.files = {stem.string() + ".vtp", stem.string() + ".obj"};
    io::write_vtp(run.files[0], polygons, arrays, provenance);
    io::write_obj(run.files[1], run.sphere.mesh, provenance);
    if (!with_picture) return;
    run.files.push_back(stem.string() + ".png");
    io::render_png(run.files.back(), {{scene_of(run.sphere, wall, name)}});
}

}  // namespace

int run_shape_inflate(const ShapeInflateOptions& options, const CommonOptions& common) {
    const Timer timer;
    const std::string name = fs::path(options.surface).stem().string();
    const fs::path folder = options.out.empty() ? fs::path("out") / name : options.out;
    io::require_writable(folder);
    Inflated run;
    run.options = inflation_options(options);
    const meshing::TriangleSoup wall = io::read_surface(options.surface);
    run.n_triangles = static_cast<int>(wall.triangles.size());
    const Timer inflation;
    run.sphere = meshing::inflate_sphere(wall, run.options);
    run.inflation_seconds = inflation.seconds();
    write_files(name, wall, folder, options.png, run);
    run.seconds = timer.seconds();
    if (common.json) {
        fmt::print("{}\n", inflated_json(options.surface, run));
    } else if (!common.quiet) {
        print_inflated(run, folder);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
