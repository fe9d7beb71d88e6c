#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_page_data.h"
#include "iga/core/log.h"
#include "io/atomic_file.h"

namespace couture::drivers {

int run_rom_export(const RomExportOptions& options, const CommonOptions& common) {
    const TrainedModel trained(options.model);
    const io::PageContent content = page_content(trained);
    if (!content.no_stress.empty()) {
        log::warn("the page shows displacements only: " + content.no_stress);
    }
    std::filesystem::path file = options.html;
    if (file.empty()) file = options.model.stem().string() + ".html";
    const std::string page = io::make_rom_page(trained.model(), content);
    io::write_text(file, page);
    int n_points = 0;
    for (const rom::SampleGrid& grid : content.grids) {
        n_points += grid.n_points();
    }
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "done"},
                                               {"points", n_points},
                                               {"bytes", page.size()},
                                               {"warnings", log::warnings()},
                                               {"files", {file.string()}}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("{}\n  {} points on the surface, {:.1f} MB; wrote {}\n", content.title, n_points,
                   1e-6 * static_cast<double>(page.size()), file.string());
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
