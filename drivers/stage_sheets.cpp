#include "drivers/stage_sheets.h"

#include <string>

#include "io/line_plot.h"
#include "io/picture.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

io::Scene in_sheet(io::Scene scene) {
    constexpr int width = 800;
    constexpr int height = 600;
    scene.width = width;
    scene.height = height;
    return scene;
}

io::Scene relocation_plot(const std::vector<double>& energies) {
    const VectorX values =
        Eigen::Map<const VectorX>(energies.data(), static_cast<Eigen::Index>(energies.size()));
    return io::make_line_plot(
        values, {.title = "energy while nodes move", .x = "step", .y = "energy (1 at best)"});
}

void write_relocation(const fs::path& file, const MeshStages& stages) {
    std::vector<io::Scene> row{in_sheet(stage_scene(stages, MeshStage::map)),
                               in_sheet(stage_scene(stages, MeshStage::quads)),
                               in_sheet(relocation_plot(stages.solid->relocation->energies))};
    row[0].title = "quads of the map";
    row[1].title = "nodes moved";
    io::render_png(file, std::vector<std::vector<io::Scene>>{row});
}

void write_stages(const fs::path& file, const MeshStages& stages) {
    std::vector<MeshStage> shown{MeshStage::surface};
    if (stages.pants) shown.push_back(MeshStage::pants);
    shown.insert(shown.end(),
                 {MeshStage::layout, stages.solid->field ? MeshStage::field : MeshStage::map,
                  MeshStage::quads, MeshStage::volume});
    std::vector<std::vector<io::Scene>> rows;
    for (const MeshStage stage : shown) {
        constexpr std::size_t n_columns = 3;
        if (rows.empty() || rows.back().size() == n_columns) rows.emplace_back();
        rows.back().push_back(in_sheet(stage_scene(stages, stage)));
    }
    io::render_png(file, rows);
}

}  // namespace

std::vector<fs::path> write_stage_sheets(const fs::path& stem, const MeshStages& stages) {
    std::vector<fs::path> files;
    if (stages.solid && stages.solid->quads) {
        files.emplace_back(stem.string() + "_relocation.png");
        write_relocation(files.back(), stages);
    }
    if (stages.solid && stages.solid->volume) {
        files.emplace_back(stem.string() + "_stages.png");
        write_stages(files.back(), stages);
    }
    return files;
}

}  // namespace couture::drivers
