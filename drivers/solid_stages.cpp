#include "drivers/solid_stages.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "iga/topology/space.h"
#include "io/obj_surface.h"
#include "io/picture.h"
#include "io/scene.h"
#include "io/spline_file.h"
#include "io/surface_writer.h"
#include "meshing/field/face_frames.h"
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

// The four directions of each face's cross.
std::vector<io::SurfaceArray> cross_arrays(const SolidMesh& solid) {
    const SurfaceMesh& mesh = solid.cuboids.mesh;
    const FaceFrames frames(mesh);
    std::vector<io::SurfaceArray> arrays;
    for (int k = 0; k < 4; ++k) {
        MatrixX directions(static_cast<Eigen::Index>(mesh.n_faces()), 3);
        for (const FaceHandle face : mesh.faces()) {
            const double angle = solid.field->field.angles[face.idx()] + 0.5 * std::numbers::pi * k;
            directions.row(face.idx()) = frames.direction(face, angle).transpose();
        }
        arrays.push_back({"direction_" + std::to_string(k), std::move(directions)});
    }
    return arrays;
}

io::SurfaceArray index_array(const SolidMesh& solid) {
    MatrixX index = MatrixX::Zero(static_cast<Eigen::Index>(solid.cuboids.mesh.n_vertices()), 1);
    for (const Singularity& s : solid.field->topology.singularities) index(s.vertex, 0) = s.index;
    return {"index", std::move(index)};
}

// An octahedron.
io::SurfacePiece marker(const Vector3& center, double radius, const io::Color& color) {
    io::SurfacePiece piece;
    piece.vertices.resize(6, 3);
    for (int k = 0; k < 6; ++k) {
        piece.vertices.row(k) =
            (center + (k % 2 == 0 ? radius : -radius) * Vector3::Unit(k / 2)).transpose();
    }
    piece.triangles.resize(8, 3);
    piece.triangles << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
    piece.color = color;
    return piece;
}

// Crosses, so far apart that each can be seen, on the plain surface; singularities of positive
// index red, others blue.
io::Scene field_scene(const SolidMesh& solid) {
    const SurfaceMesh& mesh = solid.cuboids.mesh;
    io::Scene scene;
    const TriangleSoup soup = to_soup(mesh);
    io::SurfacePiece piece;
    piece.vertices = rows_of(soup.points);
    piece.triangles.resize(static_cast<Eigen::Index>(soup.triangles.size()), 3);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto& [a, b, c] = soup.triangles[t];
        piece.triangles.row(static_cast<Eigen::Index>(t)) << a, b, c;
    }
    scene.surfaces.push_back(std::move(piece));
    const double spacing = bounding_box_diagonal(mesh) / 50.0;
    const FaceFrames frames(mesh);
    std::vector<Vector3> centers;
    for (const FaceHandle face : mesh.faces()) {
        const Vector3 center = mesh.calc_face_centroid(face);
        if (std::ranges::any_of(
                centers, [&](const Vector3& other) { return (other - center).norm() < spacing; })) {
            continue;
        }
        centers.push_back(center);
        constexpr double lift = 0.05;
        const Vector3 middle = center + lift * spacing * face_normal(mesh, face);
        for (int k = 0; k < 2; ++k) {
            const double angle = solid.field->field.angles[face.idx()] + 0.5 * std::numbers::pi * k;
            const Vector3 arm = 0.45 * spacing * frames.direction(face, angle);
            scene.curves.push_back({.points = rows_of({middle - arm, middle + arm}),
                                    .is_closed = false,
                                    .color = {0.12, 0.14, 0.17},
                                    .width = 1.5});
        }
    }
    for (const auto& [vertex, index] : solid.field->topology.singularities) {
        const io::Color color =
            index > 0 ? io::Color{0.84, 0.15, 0.16} : io::Color{0.10, 0.35, 0.80};
        scene.surfaces.push_back(marker(mesh.point(VertexHandle(vertex)), 0.5 * spacing, color));
    }
    return scene;
}

}  // namespace

io::Scene solid_stage_scene(const SolidMesh& solid, SolidStage stage) {
    if (stage == SolidStage::field) return field_scene(solid);
    if (stage <= SolidStage::map) return layout_scene(solid.cuboids);
    if (stage == SolidStage::quads) return quad_scene(*solid.quads);
    io::SceneOptions options;
    options.element_lines = true;
    return io::make_scene(iga::Space<3>(solid.volume->volume), options);
}

std::vector<fs::path> write_solid_stage(const fs::path& stem, const SolidMesh& solid,
                                        SolidStage stage, bool png, const std::string& provenance) {
    if (stage == SolidStage::field && !solid.field) return {};
    std::vector<fs::path> files;
    if (stage <= SolidStage::map) {
        std::vector<io::SurfaceArray> on_triangles{
            {"quad", column(solid.cuboids.surface.quad_of_face)}};
        if (stage == SolidStage::map) {
            for (io::SurfaceArray& array : map_arrays(solid)) {
                on_triangles.push_back(std::move(array));
            }
        }
        std::vector<io::SurfaceArray> on_points;
        if (stage == SolidStage::field) {
            on_points.push_back(index_array(solid));
            for (io::SurfaceArray& array : cross_arrays(solid)) {
                on_triangles.push_back(std::move(array));
            }
        }
        files.push_back(with_extension(stem, ".vtp"));
        io::write_vtp(files.back(), to_soup(solid.cuboids.mesh), on_points, on_triangles,
                      arc_lines(solid.cuboids), provenance);
    } else if (stage == SolidStage::quads) {
        const QuadMesh quads = to_quad_mesh(*solid.quads);
        files.push_back(with_extension(stem, ".vtp"));
        io::write_vtp(files.back(), quads, provenance);
        files.push_back(with_extension(stem, ".obj"));
        io::write_obj(files.back(), quads, provenance);
    } else {
        files.push_back(with_extension(stem, ".xml"));
        io::write_splines(files.back(), solid.volume->volume);
    }
    if (png && stage != SolidStage::map) {
        files.push_back(with_extension(stem, ".png"));
        io::Scene scene = solid_stage_scene(solid, stage);
        scene.title = stem.stem().string();
        io::render_png(files.back(), scene);
    }
    return files;
}

}  // namespace couture::drivers
