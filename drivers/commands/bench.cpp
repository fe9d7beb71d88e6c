#include <fmt/core.h>

#include <algorithm>

#include "drivers/bench.h"
#include "drivers/bench_compare.h"
#include "drivers/commands/commands.h"
#include "iga/core/parallel.h"
#include "io/atomic_file.h"

namespace couture::drivers {

int run_bench(const BenchCommandOptions& options, const CommonOptions& common) {
    BenchOptions bench;
    bench.quick = options.quick;
    bench.n_runs = options.quick ? 2 : 5;
    bench.max_threads = std::min(n_threads(), 2);
    bench.only = options.only;
    // Read first: a wrong file must not cost the run.
    const std::string earlier = options.compare.empty() ? "" : io::read_text(options.compare);
    if (!earlier.empty()) {
        static_cast<void>(compare_benchmarks(earlier, earlier, options.compare.string()));
    }
    const BenchResult result = run_benchmarks(bench);
    const std::string json = bench_json(result);
    if (!options.save.empty()) {
        io::write_text(options.save, json + "\n");
    }
    fmt::print("{}\n", common.json ? json : bench_text(result));
    if (!earlier.empty() && !common.json) {
        fmt::print("{}", compare_benchmarks(json, earlier, options.compare.string()));
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
