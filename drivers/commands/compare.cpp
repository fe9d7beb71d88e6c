#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "drivers/commands/commands.h"
#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::json;

/// What a run's time and place change, not its result.
const std::set<std::string> ignored_keys = {"phases", "peak_memory", "threads", "files",
                                            "deck",   "program",     "memory"};
/// Residuals and force balances are rounding errors: equal if both are small.
constexpr double rounding_error = 1e-8;
const std::set<std::string> rounding_keys = {"residual", "balance"};
/// Below these keys numbers are compared relative to the largest of the whole file under the same
/// key: components that vanish hold rounding errors.
const std::set<std::string> shared_scale = {"energy", "applied_force", "foundation_force",
                                            "reactions", "control_points"};
constexpr std::size_t max_listed = 20;

/// Largest magnitude of the numbers below each key of `shared_scale`.
void collect_scales(const Json& value, const std::string& shared_key,
                    std::map<std::string, double>& scales) {
    if (value.is_number() && !shared_key.empty()) {
        double& scale = scales[shared_key];
        scale = std::max(scale, std::abs(value.get<double>()));
    } else if (value.is_object()) {
        for (const auto& [key, entry] : value.items()) {
            collect_scales(entry, shared_scale.count(key) != 0 ? key : shared_key, scales);
        }
    } else if (value.is_array()) {
        for (const Json& entry : value) {
            collect_scales(entry, shared_key, scales);
        }
    }
}

class Comparison {
  public:
    Comparison(const Json& first, const Json& second, double tolerance) : tolerance_(tolerance) {
        collect_scales(first, "", scales_);
        collect_scales(second, "", scales_);
        compare(first, second, "", 0.0);
    }

    [[nodiscard]] const std::vector<std::string>& differences() const { return differences_; }

  private:
    /// @param scale  smallest size that differences are relative to
    void compare(const Json& a, const Json& b, const std::string& path, double scale) {
        if (a.is_number() && b.is_number()) {
            compare_numbers(a.get<double>(), b.get<double>(), path, scale);
        } else if (a.is_object() && b.is_object()) {
            compare_objects(a, b, path, scale);
        } else if (a.is_array() && b.is_array() && a.size() == b.size()) {
            for (std::size_t i = 0; i < a.size(); ++i) {
                compare(a[i], b[i], fmt::format("{}[{}]", path, i), scale);
            }
        } else if (a.is_array() && b.is_array()) {
            add(fmt::format("{}: {} entries, {} entries", path, a.size(), b.size()));
        } else if (a != b) {
            add(fmt::format("{}: {}, {}", path, a.dump(), b.dump()));
        }
    }

    void add(std::string difference) { differences_.push_back(std::move(difference)); }

    void compare_numbers(double a, double b, const std::string& path, double scale) {
        const double difference = std::abs(a - b);
        const double size = std::max({std::abs(a), std::abs(b), scale});
        const bool is_rounding = rounding_keys.count(path.substr(path.rfind('.') + 1)) != 0;
        if (difference > tolerance_ * size && !(is_rounding && size < rounding_error)) {
            add(fmt::format("{}: {}, {} (relative difference {:.2e})", path, a, b,
                            difference / size));
        }
    }

    void compare_objects(const Json& a, const Json& b, const std::string& path, double scale) {
        std::set<std::string> keys;
        for (const Json* object : {&a, &b}) {
            for (const auto& [key, value] : object->items()) {
                keys.insert(key);
            }
        }
        for (const std::string& key : keys) {
            const std::string name = path.empty() ? key : path + "." + key;
            if (ignored_keys.count(key) != 0) {
                continue;
            }
            if (!a.contains(key) || !b.contains(key)) {
                add(fmt::format("{}: only in the {}", name, a.contains(key) ? "first" : "second"));
            } else {
                const auto shared = scales_.find(key);
                compare(a[key], b[key], name, shared == scales_.end() ? scale : shared->second);
            }
        }
    }

    double tolerance_;
    std::map<std::string, double> scales_;
    std::vector<std::string> differences_;
};

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

}  // namespace

int run_compare(const CompareOptions& options, const CommonOptions& common) {
    const Comparison comparison(read_comparable(options.first), read_comparable(options.second),
                                options.tolerance);
    const std::vector<std::string>& differences = comparison.differences();
    if (common.json) {
        const Json object = {{"program", "couture " COUTURE_VERSION},
                             {"status", differences.empty() ? "equal" : "different"},
                             {"differences", differences}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        for (std::size_t i = 0; i < std::min(differences.size(), max_listed); ++i) {
            fmt::print("{}\n", differences[i]);
        }
        if (differences.size() > max_listed) {
            fmt::print("... and {} more\n", differences.size() - max_listed);
        }
        fmt::print("{} within {:g}\n", differences.empty() ? "equal" : "different",
                   options.tolerance);
    }
    return differences.empty() ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace couture::drivers
