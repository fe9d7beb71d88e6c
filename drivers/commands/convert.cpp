#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/job_geometry.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

io::AnyMultiPatch read_any(const std::filesystem::path& path) {
    if (path.extension() == ".toml") {
        return load_geometry(io::read_deck(path));
    }
    io::SplineFile file = io::read_splines(path);
    for (const std::string& note : file.notes) {
        log::info(fmt::format("{}: {}", path.filename().string(), note));
    }
    return std::move(file.multipatch);
}

}  // namespace

int run_convert(const std::filesystem::path& from, const std::filesystem::path& to,
                const CommonOptions& common) {
    const io::AnyMultiPatch multipatch = read_any(from);
    io::write_splines(to, multipatch);
    const int n_patches =
        std::visit([](const auto& patches) { return patches.n_patches(); }, multipatch);
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "done"},
                                               {"patches", n_patches},
                                               {"files", {to.string()}}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("wrote {} ({} patches)\n", to.string(), n_patches);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
