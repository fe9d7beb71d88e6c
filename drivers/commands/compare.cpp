#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/comparison.h"
#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::json;

constexpr std::size_t max_listed = 20;

template <int d>
Json splines_json(const iga::MultiPatch<d>& multipatch) {
    Json object = {{"signature", iga::signature(multipatch)},
                   {"interfaces", multipatch.interfaces.size()}};
    for (const auto& [name, set] : multipatch.boundary_sets) {
        for (const auto& entity : set) {
            object["sets"][name].push_back(entity.name());
        }
    }
    for (const iga::Patch<d>& patch : multipatch.patches) {
        const MatrixX rows = patch.homogeneous();
        Json& entry = object["patches"].emplace_back();
        for (const iga::KnotVector& knots : patch.space().knots) {
            entry["degrees"].push_back(knots.degree());
            entry["knots"].push_back(knots.knots());
        }
        for (Eigen::Index i = 0; i < rows.rows(); ++i) {
            const VectorX row = rows.row(i);
            entry["control_points"].push_back(std::vector<double>(row.begin(), row.end()));
        }
    }
    return object;
}

Json read_comparable(const std::filesystem::path& path) {
    if (path.extension() == ".json") {
        try {
            return Json::parse(io::read_text(path));
        } catch (const Json::parse_error& error) {
            throw FileError("{}: not valid JSON at byte {}", path.string(), error.byte);
        }
    }
    return std::visit(
        []<int d>(const iga::MultiPatch<d>& multipatch) { return splines_json<d>(multipatch); },
        io::read_splines(path).multipatch);
}

struct Differences {
    std::vector<std::string> values;
    /// What makes no difference of results, but is worth knowing.
    std::vector<std::string> provenance;
};

Differences find_differences(const CompareOptions& options) {
    const bool is_vtu = options.first.extension() == ".vtu";
    const bool is_json = options.first.extension() == ".json";
    if (is_vtu != (options.second.extension() == ".vtu") ||
        is_json != (options.second.extension() == ".json")) {
        throw InputError(
            "couture compare: {} and {} are not of one kind; two summaries (.json), two fields "
            "(.vtu) or two spline files can be compared",
            options.first.string(), options.second.string());
    }
    if (is_vtu) {
        VtuComparison comparison = compare_vtu(io::read_vtu(options.first),
                                               io::read_vtu(options.second), options.tolerance);
        return {std::move(comparison.differences), std::move(comparison.provenance)};
    }
    const Json first = read_comparable(options.first);
    const Json second = read_comparable(options.second);
    Differences differences{compare_json(first, second, options.tolerance), {}};
    const auto hash_of = [](const Json& summary) {
        const bool has_hash = summary.is_object() && summary.contains("deck_hash");
        return has_hash ? summary["deck_hash"].dump() : std::string("none");
    };
    if (hash_of(first) != hash_of(second)) {
        differences.provenance.push_back(
            fmt::format("deck_hash: {}, {}", hash_of(first), hash_of(second)));
    }
    return differences;
}

void print_limited(const std::vector<std::string>& lines, const std::string& prefix) {
    for (std::size_t i = 0; i < std::min(lines.size(), max_listed); ++i) {
        fmt::print("{}{}\n", prefix, lines[i]);
    }
    if (lines.size() > max_listed) {
        fmt::print("... and {} more\n", lines.size() - max_listed);
    }
}

}  // namespace

int run_compare(const CompareOptions& options, const CommonOptions& common) {
    if (!(options.tolerance >= 0.0)) {
        throw InputError("--tolerance is {}; must be a number >= 0", options.tolerance);
    }
    const Differences differences = find_differences(options);
    const std::string status = differences.values.empty() ? "equal" : "different";
    if (common.json) {
        const Json object = {{"program", "couture " COUTURE_VERSION},
                             {"status", status},
                             {"differences", differences.values},
                             {"provenance", differences.provenance}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        print_limited(differences.provenance, "provenance: ");
        print_limited(differences.values, "");
        fmt::print("{} within {:g}\n", status, options.tolerance);
    }
    return differences.values.empty() ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
