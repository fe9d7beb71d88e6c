#include <fmt/core.h>

#include <cstdio>

#include "drivers/commands/commands.h"
#include "drivers/rom_verification.h"
#include "iga/core/log.h"
#include "verification/table.h"

namespace couture::drivers {

int run_verify(const VerifyOptions& options, const CommonOptions& common) {
    if (!common.verbose) {
        // A hundred small solves would bury the table.
        log::set_level(log::Level::warnings);
    }
    // As JSON the table goes to standard error.
    std::FILE* const stream = common.json ? stderr : stdout;
    const auto print = [&](const std::string& line) {
        fmt::print(stream, "{}\n", line);
        std::fflush(stream);
    };
    verification::VerificationOptions verify;
    verify.filter = options.filter;
    verify.with_long = options.with_long;
    verify.more = reduced_model_cases();
    bool has_head = false;
    verify.on_row = [&](const verification::Row& row) {
        if (common.quiet && row.passed) {
            return;
        }
        if (!has_head) {
            print(verification::table_head());
            has_head = true;
        }
        print(verification::table_line(row));
    };
    const verification::VerificationReport report = verification::run_verification(verify);
    print(verification::table_foot(report));
    if (common.json) {
        fmt::print("{}", verification::to_json(report));
    }
    return report.n_failed() == 0 ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
