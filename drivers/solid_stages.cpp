#include "drivers/solid_stages.h"

#include "iga/topology/space.h"
#include "io/obj_surface.h"
#include "io/picture.h"
#include "io/scene.h"
#include "io/spline_file.h"
#include "io/surface_writer.h"
#include "meshing/parameterization/sample_grid.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;
using namespace meshing;

constexpr int arc_kind = 6;
constexpr int sharp_arc_kind = 7;

fs::path with_extension(fs::path stem, const char* extension) {
    stem += extension;
    return stem;
}

MatrixX rows_of(const std::vector<Vector3>& points) {
    MatrixX rows(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t k = 0; k < points.size(); ++k) {
        rows.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
    }
    return rows;
}

std::vector<io::SurfaceLine> arc_lines(const CuboidDecomposition& cuboids) {
    std::vector<io::SurfaceLine> lines;
    for (int a = 0; a < cuboids.surface.layout.n_arcs(); ++a) {
        io::SurfaceLine line{.points = {},
                             .is_closed = false,
                             .kind = cuboids.surface.is_feature_arc[a] ? sharp_arc_kind : arc_kind,
                             .number = a};
        for (const VertexHandle v : cuboids.surface.arcs[a]) {
            line.points.push_back(cuboids.mesh.point(v));
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

// The surface with a colour for each quad.
io::Scene layout_scene(const CuboidDecomposition& cuboids) {
    io::Scene scene;
    const TriangleSoup soup = to_soup(cuboids.mesh);
    const int n_quads = cuboids.surface.layout.n_quads();
    std::vector<std::vector<std::array<int, 3>>> triangles(n_quads);
    for (std::size_t f = 0; f < soup.triangles.size(); ++f) {
        triangles[cuboids.surface.quad_of_face[f]].push_back(soup.triangles[f]);
    }
    for (int q = 0; q < n_quads; ++q) {
        io::SurfacePiece piece;
        std::vector<int> number(soup.points.size(), -1);
        std::vector<Vector3> points;
        piece.triangles.resize(static_cast<Eigen::Index>(triangles[q].size()), 3);
        for (std::size_t t = 0; t < triangles[q].size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                int& n = number[triangles[q][t][k]];
                if (n < 0) {
                    n = static_cast<int>(points.size());
                    points.push_back(soup.points[triangles[q][t][k]]);
                }
                piece.triangles(static_cast<Eigen::Index>(t), k) = n;
            }
        }
        piece.vertices = rows_of(points);
        piece.color = io::part_color(q);
        scene.surfaces.push_back(std::move(piece));
    }
    for (const io::SurfaceLine& line : arc_lines(cuboids)) {
        scene.curves.push_back({.points = rows_of(line.points),
                                .is_closed = false,
                                .color = {0.12, 0.14, 0.17},
                                .width = line.kind == sharp_arc_kind ? 4.0 : 2.0});
    }
    return scene;
}

io::Scene quad_scene(const LayoutSamples& samples) {
    io::Scene scene;
    const QuadMesh quads = to_quad_mesh(samples);
    io::SurfacePiece piece;
    piece.vertices = rows_of(quads.points);
    piece.triangles.resize(static_cast<Eigen::Index>(2 * quads.quads.size()), 3);
    for (std::size_t q = 0; q < quads.quads.size(); ++q) {
        const auto& [a, b, c, d] = quads.quads[q];
        const auto row = static_cast<Eigen::Index>(2 * q);
        piece.triangles.row(row) = Eigen::RowVector3i(a, b, c);
        piece.triangles.row(row + 1) = Eigen::RowVector3i(a, c, d);
    }
    scene.surfaces.push_back(std::move(piece));
    const auto add_line = [&](const MatrixX& points, int first, int step, int n, double width) {
        MatrixX rows(n, 3);
        for (int k = 0; k < n; ++k) rows.row(k) = points.col(first + k * step).transpose();
        scene.curves.push_back({.points = std::move(rows),
                                .is_closed = false,
                                .color = {0.12, 0.14, 0.17},
                                .width = width});
    };
    for (int q = 0; q < samples.layout.n_quads(); ++q) {
        const int n_s = samples.n_cells[samples.layout.sides(q)[0].arc] + 1;
        const int n_t = samples.n_cells[samples.layout.sides(q)[1].arc] + 1;
        for (int j = 1; j + 1 < n_t; ++j) add_line(samples.quads[q], j * n_s, 1, n_s, 1.0);
        for (int i = 1; i + 1 < n_s; ++i) add_line(samples.quads[q], i, n_s, n_t, 1.0);
    }
    for (const MatrixX& arc : samples.arcs) {
        add_line(arc, 0, 1, static_cast<int>(arc.cols()), 2.5);
    }
    return scene;
}

MatrixX column(const std::vector<int>& values) {
    MatrixX matrix(static_cast<Eigen::Index>(values.size()), 1);
    for (std::size_t k = 0; k < values.size(); ++k) {
        matrix(static_cast<Eigen::Index>(k), 0) = values[k];
    }
    return matrix;
}

// Angle and area distortion of each face of a map.
std::vector<io::SurfaceArray> map_arrays(const SolidMesh& solid) {
    const SurfaceMesh& mesh = solid.cuboids.mesh;
    MatrixX u(static_cast<Eigen::Index>(mesh.n_faces()), 3);
    MatrixX v(static_cast<Eigen::Index>(mesh.n_faces()), 3);
    for (Eigen::Index f = 0; f < u.rows(); ++f) {
        for (int k = 0; k < 3; ++k) {
            u(f, k) = solid.map->corners[static_cast<std::size_t>(f)][k].x();
            v(f, k) = solid.map->corners[static_cast<std::size_t>(f)][k].y();
        }
    }
    return {{"u", u}, {"v", v}};
}

}  // namespace

std::vector<fs::path> write_solid_stage(const fs::path& stem, const SolidMesh& solid,
                                        SolidStage stage, bool png, const std::string& provenance) {
    std::vector<fs::path> files;
    io::Scene scene;
    if (stage == SolidStage::layout || stage == SolidStage::map) {
        std::vector<io::SurfaceArray> on_triangles{
            {"quad", column(solid.cuboids.surface.quad_of_face)}};
        if (stage == SolidStage::map) {
            for (io::SurfaceArray& array : map_arrays(solid)) {
                on_triangles.push_back(std::move(array));
            }
        }
        files.push_back(with_extension(stem, ".vtp"));
        io::write_vtp(files.back(), to_soup(solid.cuboids.mesh), {}, on_triangles,
                      arc_lines(solid.cuboids), provenance);
        scene = layout_scene(solid.cuboids);
    } else if (stage == SolidStage::quads) {
        const QuadMesh quads = to_quad_mesh(*solid.quads);
        files.push_back(with_extension(stem, ".vtp"));
        io::write_vtp(files.back(), quads, provenance);
        files.push_back(with_extension(stem, ".obj"));
        io::write_obj(files.back(), quads, provenance);
        scene = quad_scene(*solid.quads);
    } else {
        files.push_back(with_extension(stem, ".xml"));
        io::write_splines(files.back(), solid.volume->volume);
        const iga::Space<3> space(solid.volume->volume);
        io::SceneOptions options;
        options.element_lines = true;
        scene = io::make_scene(space, options);
    }
    if (png && stage != SolidStage::map) {
        files.push_back(with_extension(stem, ".png"));
        scene.title = stem.stem().string();
        io::render_png(files.back(), scene);
    }
    return files;
}

}  // namespace couture::drivers
