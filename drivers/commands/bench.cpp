#include <fmt/core.h>

#include <algorithm>

#include "drivers/bench.h"
#include "drivers/commands/commands.h"
#include "iga/core/parallel.h"
#include "io/atomic_file.h"

namespace couture::drivers {

int run_bench(const BenchCommandOptions& options, const CommonOptions& common) {
    BenchOptions bench;
    bench.quick = options.quick;
    bench.n_runs = options.quick ? 2 : 5;
    bench.max_threads = std::min(n_threads(), 2);
    const BenchResult result = run_benchmarks(bench);
    const std::string json = bench_json(result);
    if (!options.save.empty()) {
        io::write_text(options.save, json + "\n");
    }
    fmt::print("{}\n", common.json ? json : bench_text(result));
    return ExitCode::done;
}

}  // namespace couture::drivers
