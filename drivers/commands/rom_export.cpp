#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/rom_export_content.h"
#include "iga/core/log.h"
#include "io/atomic_file.h"
#include "io/embedded_model.h"
#include "io/rom_page.h"

namespace couture::drivers {

namespace {

/// Pages above it are slow to open and too long for mail.
constexpr double large_page = 30e6;

void warn_large_page(std::size_t n_bytes, const rom::ReducedModel& model) {
    if (static_cast<double>(n_bytes) <= large_page) return;
    const rom::ReducedModelParts& parts = model.parts();
    log::warn(fmt::format(
        "the page is {:.1f} MB long, more than {:.0f}: {} modes of the geometry and {} of the "
        "displacement on {} nodes; fewer 'modes' or a larger 'tolerance' in [rom] make it shorter",
        1e-6 * static_cast<double>(n_bytes), 1e-6 * large_page,
        parts.models[parts.geometry.i_model].n_modes(),
        parts.models[parts.displacement.i_model].n_modes(), model.n_nodes()));
}

// Nobody's page, model or deck is overwritten by a slip.
void require_name(const std::filesystem::path& file, bool is_page) {
    const std::string extension = file.extension().string();
    const bool is_html = extension == ".html" || extension == ".htm";
    if (is_page && !is_html) {
        throw InputError("rom export --html {}: a page's name ends in .html", file.string());
    }
    if (!is_page && (is_html || extension == ".rom" || extension == ".toml")) {
        throw InputError(
            "rom export --binary {}: that is the name of a {}; take another, such as {}",
            file.string(),
            is_html               ? "page"
            : extension == ".rom" ? "reduced model"
                                  : "deck",
            std::filesystem::path(file).replace_extension(".bin").string());
    }
}

}  // namespace

int run_rom_export(const RomExportOptions& options, const CommonOptions& common) {
    const TrainedModel trained(options.model);
    const bool is_page = options.binary.empty();
    std::filesystem::path file = is_page ? options.html : options.binary;
    if (file.empty()) file = options.model.stem().string() + ".html";
    require_name(file, is_page);
    const io::ExportContent content = is_page ? page_content(trained) : volume_content(trained);
    if (!content.no_stress.empty()) {
        log::warn(fmt::format("the {} displacements only: {}",
                              is_page ? "page shows" : "evaluator gives", content.no_stress));
    }
    const std::string bytes = is_page ? io::make_rom_page(trained.model(), content)
                                      : io::to_embedded(trained.model(), content);
    if (is_page) warn_large_page(bytes.size(), trained.model());
    io::write_text(file, bytes);
    int n_points = 0;
    for (const rom::SampleGrid& grid : content.grids) {
        n_points += grid.n_points();
    }
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "done"},
                                               {"points", n_points},
                                               {"bytes", bytes.size()},
                                               {"warnings", log::warnings()},
                                               {"files", {file.string()}}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("{}\n  {} points {}, {:.1f} MB; wrote {}\n", content.title, n_points,
                   is_page ? "on the surface" : "at the ends of elements",
                   1e-6 * static_cast<double>(bytes.size()), file.string());
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
