#include "drivers/solid_stages.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "drivers/hex_files.h"
#include "iga/topology/space.h"
#include "io/obj_surface.h"
#include "io/scene.h"
#include "io/spline_file.h"
#include "io/surface_writer.h"
#include "meshing/field/face_frames.h"
#include "meshing/field/streamline.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/surface/point_grid.h"
#include "meshing/surface/predicates.h"

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

// Some triangles of a soup.
io::SurfacePiece piece_of(const TriangleSoup& soup,
                          const std::vector<std::array<int, 3>>& triangles) {
    io::SurfacePiece piece;
    std::vector<int> number(soup.points.size(), -1);
    std::vector<Vector3> points;
    piece.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            int& n = number[triangles[t][k]];
            if (n < 0) {
                n = static_cast<int>(points.size());
                points.push_back(soup.points[triangles[t][k]]);
            }
            piece.triangles(static_cast<Eigen::Index>(t), k) = n;
        }
    }
    piece.vertices = rows_of(points);
    return piece;
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
        io::SurfacePiece piece = piece_of(soup, triangles[q]);
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

const io::Color red{0.84, 0.15, 0.16};

// The surface with the flipped triangles of its map.
io::Scene flipped_scene(const SolidMesh& solid) {
    const TriangleSoup soup = to_soup(solid.cuboids.mesh);
    std::vector<std::array<int, 3>> good;
    std::vector<std::array<int, 3>> flipped;
    for (std::size_t f = 0; f < soup.triangles.size(); ++f) {
        const auto& [a, b, c] = solid.map->corners[f];
        (orientation(a, b, c) > 0 ? good : flipped).push_back(soup.triangles[f]);
    }
    io::Scene scene;
    scene.surfaces = {piece_of(soup, good), piece_of(soup, flipped)};
    scene.surfaces[1].color = red;
    for (const io::SurfaceLine& line : arc_lines(solid.cuboids)) {
        scene.curves.push_back({.points = rows_of(line.points), .width = 1.5});
    }
    return scene;
}

// Lines of the field through points so far apart that each can be seen, on the plain surface;
// singularities of positive index red, others blue.
io::Scene field_scene(const SolidMesh& solid) {
    const SurfaceMesh& mesh = solid.cuboids.mesh;
    io::Scene scene;
    const TriangleSoup soup = to_soup(mesh);
    scene.surfaces.push_back(piece_of(soup, soup.triangles));
    const double spacing = bounding_box_diagonal(mesh) / 50.0;
    const FaceFrames frames(mesh);
    PointGrid centers(spacing);
    for (const FaceHandle face : mesh.faces()) {
        const Vector3 center = mesh.calc_face_centroid(face);
        if (centers.distance(center) < spacing) continue;
        centers.add(center);
        for (int k = 0; k < 2; ++k) {
            const auto half = [&](int direction) {
                return trace_streamline(mesh, frames, solid.field->field, face, direction,
                                        1.5 * spacing);
            };
            std::vector<Vector3> line = half(k + 2);
            std::ranges::reverse(line);
            const std::vector<Vector3> forwards = half(k);
            line.insert(line.end(), forwards.begin() + 1, forwards.end());
            if (line.size() < 2) continue;
            scene.curves.push_back({.points = rows_of(line), .width = 1.2});
        }
    }
    for (const auto& [vertex, index] : solid.field->topology.singularities) {
        const io::Color color = index > 0 ? red : io::Color{0.10, 0.35, 0.80};
        scene.surfaces.push_back(marker(mesh.point(VertexHandle(vertex)), 0.5 * spacing, color));
    }
    return scene;
}

// With lines between elements.
template <int d>
io::Scene element_scene(const iga::MultiPatch<d>& multipatch) {
    io::SceneOptions options;
    options.element_lines = true;
    return io::make_scene(iga::Space<d>(multipatch), options);
}

}  // namespace

io::Scene solid_scene(const SolidMesh& solid, SolidStage stage) {
    switch (stage) {
        case SolidStage::field:
            return field_scene(solid);
        case SolidStage::map:
            return solid.mapped_quads ? quad_scene(*solid.mapped_quads) : flipped_scene(solid);
        case SolidStage::quads:
            return quad_scene(*solid.quads);
        case SolidStage::surfaces:
            return element_scene(solid.surfaces->surfaces);
        case SolidStage::volume:
            return element_scene(solid.volume->volume);
        case SolidStage::hexes:
            return element_scene(solid.hexes->hexahedra);
        default:
            return layout_scene(solid.cuboids);
    }
}

std::vector<fs::path> write_solid_stage(const fs::path& stem, const SolidMesh& solid,
                                        SolidStage stage, bool png, const std::string& provenance) {
    if (stage == SolidStage::field && !solid.field) return {};
    if (stage == SolidStage::surfaces && !solid.surfaces) return {};
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
    } else if (stage == SolidStage::surfaces) {
        files.push_back(with_extension(stem, ".xml"));
        io::write_splines(files.back(), solid.surfaces->surfaces);
    } else if (stage == SolidStage::volume) {
        files.push_back(with_extension(stem, ".xml"));
        io::write_splines(files.back(), solid.volume->volume);
    } else {
        files = write_hexahedra(stem, *solid.hexes, provenance).files;
    }
    if (png) {
        files.push_back(with_extension(stem, ".png"));
        io::Scene scene = solid_scene(solid, stage);
        scene.title = stem.stem().string();
        io::render_png(files.back(), scene);
    }
    return files;
}

}  // namespace couture::drivers
