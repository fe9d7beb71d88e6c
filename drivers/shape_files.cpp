#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drivers/shape_run.h"
#include "iga/topology/space.h"
#include "io/atomic_file.h"
#include "io/line_plot.h"
#include "io/scene.h"
#include "io/spline_file.h"
#include "io/surface_writer.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

constexpr int most_deviations = 3;

class ShapeFiles {
  public:
    ShapeFiles(const ShapeRun& run, fs::path folder) : run_(run), folder_(std::move(folder)) {}

    void write_shapes() {
        write("mean", run_.model.mean, true);
        for (int k = 0; k < run_.n_modes; ++k) write_mode(k);
        for (const ProjectedShape& shape : run_.projections) {
            write("projected_" + shape.member.name, shape.projection.points, true);
        }
        for (const VirtualShape& shape : run_.virtuals) write(shape.name, shape.points, true);
    }

    void write_tables() {
        std::string text =
            "modes,compactness,generalisation,generalisation_error,specificity,"
            "specificity_error\n";
        for (Eigen::Index k = 0; k < run_.compactness.size(); ++k) {
            const bool has_general = run_.generalisation && k < run_.generalisation->values.size();
            text += fmt::format("{},{},{},{},{}\n", k, run_.compactness[k],
                                has_general ? fmt::format("{},{}", run_.generalisation->values[k],
                                                          run_.generalisation->errors[k])
                                            : ",",
                                run_.specificity.values[k], run_.specificity.errors[k]);
        }
        write_table("curves", text);
        text = "member";
        for (int k = 1; k <= run_.model.n_modes(); ++k) text += fmt::format(",mode_{}", k);
        for (int j = 0; j < run_.model.n_members(); ++j) {
            text += fmt::format("\n{},{}", run_.population.members[j].name,
                                fmt::join(run_.model.coefficients.col(j), ","));
        }
        write_table("coefficients", text + "\n");
    }

    void draw() {
        draw_modes();
        draw_curves();
        draw_members();
    }

    std::vector<fs::path> files;

  private:
    [[nodiscard]] fs::path path(const std::string& what) const {
        return folder_ / (run_.name + "_" + what);
    }

    [[nodiscard]] bool is_volume() const { return run_.population.connectivity.volume.has_value(); }

    [[nodiscard]] MatrixX mode_at(int mode, double deviations) const {
        VectorX coefficients = VectorX::Zero(mode + 1);
        coefficients[mode] = deviations * run_.model.standard_deviations[mode];
        return rom::virtual_member(run_.model, coefficients);
    }

    /// @return the file's name
    std::string write(const std::string& what, const MatrixX& points, bool as_splines) {
        const MatrixX displacement = points - run_.model.mean;
        const std::string provenance =
            fmt::format("couture {} shape; {}; {} members, signature {}", COUTURE_VERSION, what,
                        run_.model.n_members(), run_.population.connectivity.signature);
        const fs::path file = path(what + (is_volume() ? ".vtu" : ".vtp"));
        if (is_volume()) {
            const iga::MultiPatch<3> volume = run_.population.connectivity.volume_with(points);
            const std::array arrays{io::PointArray{"displacement", displacement, {}}};
            io::VtuOptions options;
            options.provenance = provenance;
            io::write_vtu<3>(file, iga::Space<3>(volume), arrays, {}, options);
            if (as_splines) {
                files.push_back(path(what + ".xml"));
                io::write_splines(files.back(), volume);
            }
        } else {
            const std::array arrays{io::SurfaceArray{"displacement", displacement}};
            io::write_vtp(file, run_.population.connectivity.mesh_with(points), arrays, provenance);
        }
        files.push_back(file);
        return file.filename().string();
    }

    void write_mode(int mode) {
        std::string text =
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n";
        for (int s = -most_deviations; s <= most_deviations; ++s) {
            const std::string file =
                write(fmt::format("mode_{}_{:+d}", mode + 1, s), mode_at(mode, s), false);
            text += fmt::format("    <DataSet timestep=\"{}\" file=\"{}\"/>\n", s, file);
        }
        files.push_back(path(fmt::format("mode_{}.pvd", mode + 1)));
        io::write_text(files.back(), text + "  </Collection>\n</VTKFile>\n");
    }

    void write_table(const std::string& what, const std::string& text) {
        files.push_back(path(what + ".csv"));
        io::write_text(files.back(), text);
    }

    /// @param values  at the points, shown by colours; empty: none
    [[nodiscard]] io::Scene scene_of(const MatrixX& points, const VectorX& values,
                                     const std::string& title) const {
        io::Scene scene;
        if (is_volume()) {
            const iga::Space<3> space(run_.population.connectivity.volume_with(points));
            io::SceneOptions options;
            options.values = values;
            scene = io::make_scene(space, options);
        } else {
            const io::RawSurface& mesh = run_.population.connectivity.polygons;
            io::SurfacePiece piece;
            piece.vertices = points;
            piece.values = values;
            std::vector<std::array<int, 3>> triangles;
            for (std::size_t i = 0; i < mesh.n_polygons(); ++i) {
                const auto polygon = mesh.polygon(i);
                for (std::size_t k = 2; k < polygon.size(); ++k) {
                    triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
                }
            }
            piece.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
            for (std::size_t t = 0; t < triangles.size(); ++t) {
                piece.triangles.row(t) << triangles[t][0], triangles[t][1], triangles[t][2];
            }
            scene.surfaces.push_back(std::move(piece));
        }
        scene.title = title;
        scene.show_axes = false;
        return scene;
    }

    [[nodiscard]] static io::Scene sized(io::Scene scene, int width, int height) {
        scene.width = width;
        scene.height = height;
        return scene;
    }

    void draw_modes() {
        constexpr int most_rows = 4;
        std::vector<std::vector<io::Scene>> rows;
        for (int k = 0; k < std::min(run_.n_modes, most_rows); ++k) {
            auto& row = rows.emplace_back();
            const VectorX distances =
                (mode_at(k, most_deviations) - run_.model.mean).rowwise().norm();
            for (const int s : {-most_deviations, 0, most_deviations}) {
                io::Scene scene =
                    scene_of(mode_at(k, s), s == 0 ? VectorX() : distances,
                             s == 0 ? "mean" : fmt::format("mode {}, {:+d} std. dev.", k + 1, s));
                if (s != 0) {
                    scene.range = std::array{0.0, distances.maxCoeff()};
                    scene.legend = "distance";
                }
                row.push_back(sized(std::move(scene), 480, 400));
            }
        }
        files.push_back(path("modes.png"));
        io::render_png(files.back(), rows);
    }

    void draw_curves() {
        std::vector<io::Scene> row{io::make_line_plot(
            run_.compactness, {.title = "compactness", .x = "modes", .y = "part of variance"})};
        if (run_.generalisation) {
            row.push_back(io::make_line_plot(
                run_.generalisation->values,
                {.title = "generalisation", .x = "modes", .y = "distance of a member left out"}));
        }
        row.push_back(io::make_line_plot(
            run_.specificity.values,
            {.title = "specificity", .x = "modes", .y = "distance of virtual members"}));
        for (io::Scene& scene : row) scene = sized(std::move(scene), 620, 460);
        files.push_back(path("curves.png"));
        io::render_png(files.back(), {row});
    }

    void draw_members() {
        constexpr int most = 36;
        const int n = std::min(run_.model.n_members(), most);
        const int n_columns = static_cast<int>(std::ceil(std::sqrt(n)));
        std::vector<std::vector<io::Scene>> rows;
        for (int j = 0; j < n; ++j) {
            if (j % n_columns == 0) rows.emplace_back();
            const ShapeMember& member = run_.population.members[j];
            rows.back().push_back(sized(
                scene_of(run_.model.motions[j].apply(member.points), {}, member.name), 360, 300));
        }
        files.push_back(path("members.png"));
        io::render_png(files.back(), rows);
    }

    const ShapeRun& run_;
    fs::path folder_;
};

}  // namespace

std::vector<fs::path> write_shape_files(const ShapeRun& run, const fs::path& folder,
                                        bool with_pictures) {
    ShapeFiles files(run, folder);
    files.write_shapes();
    files.write_tables();
    if (with_pictures) files.draw();
    return files.files;
}

}  // namespace couture::drivers
