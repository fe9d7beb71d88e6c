#include <fmt/core.h>

#include "drivers/commands/commands.h"
#include "io/spline_info.h"

namespace couture::drivers {

int run_info(const std::filesystem::path& path, const CommonOptions& common) {
    const io::SplineFile file = io::read_splines(path);
    fmt::print("{}\n", common.json ? io::spline_info_json(file) : io::spline_info_text(file));
    return ExitCode::done;
}

}  // namespace couture::drivers
