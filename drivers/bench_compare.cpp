#include "drivers/bench_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "iga/core/error.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::ordered_json;

/// What tells rows apart; everything else was measured.
const std::vector<std::string> identities{"problem", "geometry",  "solver",
                                          "part",    "task",      "genus",
                                          "patches", "degree",    "elements_per_direction",
                                          "input",   "triangles", "modes",
                                          "samples", "unknowns",  "threads",
                                          "ranks"};
/// Sizes that a mesh or a solver arrives at by itself name no row.
bool is_identity(const std::string& section, const std::string& name) {
    return std::ranges::find(identities, name) != identities.end() &&
           !(section == "meshing" && name == "patches");
}

bool is_time(const std::string& name) { return name.ends_with("seconds"); }

std::string name_of(const std::string& section, const Json& row) {
    std::string name;
    for (const auto& [key, value] : row.items()) {
        if (!is_identity(section, key)) {
            continue;
        }
        const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
        const std::string shown = value.is_string() ? text : fmt::format("{} {}", key, text);
        name += (name.empty() ? "" : ", ") + shown;
    }
    return name;
}

Json parse(const std::string& text, const std::string& path) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("machine") || !json["machine"].is_array()) {
        throw InputError("{}: not the numbers of a benchmark; write them by couture bench --save",
                         path);
    }
    return json;
}

}  // namespace

std::string compare_benchmarks(const std::string& json, const std::string& earlier,
                               const std::string& path) {
    const Json before = parse(earlier, path);
    const Json now = parse(json, "this run");
    std::string text = fmt::format("\nSeconds beside {}: ratios below 1 are faster now\n", path);
    double sum_of_logs = 0.0;
    int n_times = 0;
    int n_missing = 0;
    for (const auto& [section, rows] : now.items()) {
        if (!rows.is_array() || section == "machine") {
            continue;
        }
        std::map<std::string, Json> known;
        if (before.contains(section) && before[section].is_array()) {
            for (const Json& row : before[section]) {
                known.emplace(name_of(section, row), row);
            }
        }
        for (const Json& row : rows) {
            const std::string name = name_of(section, row);
            const auto old = known.find(name);
            if (old == known.end()) {
                ++n_missing;
                continue;
            }
            for (const auto& [key, value] : row.items()) {
                if (!is_time(key) || !value.is_number() || !old->second.contains(key) ||
                    !old->second[key].is_number()) {
                    continue;
                }
                const double seconds = value.get<double>();
                const double old_seconds = old->second[key].get<double>();
                if (!(seconds > 0.0) || !(old_seconds > 0.0)) {
                    continue;
                }
                text += fmt::format("  {:20}  {:76}  {:20}  {:10.4g}  {:10.4g}  {:6.2f}\n", section,
                                    name, key, old_seconds, seconds, seconds / old_seconds);
                sum_of_logs += std::log(seconds / old_seconds);
                ++n_times;
            }
        }
    }
    if (n_times == 0) {
        return text + "  no row of this run is in that file\n";
    }
    text += fmt::format("  {} times, geometric mean of the ratios {:.3f}", n_times,
                        std::exp(sum_of_logs / n_times));
    return text +
           (n_missing > 0 ? fmt::format("; {} rows are not in that file\n", n_missing) : "\n");
}

}  // namespace couture::drivers
