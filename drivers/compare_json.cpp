#include "drivers/comparison.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace couture::drivers {

namespace {

using Json = nlohmann::json;

/// What a run's time and place change, not its result.
const std::set<std::string> ignored_keys = {"phases", "peak_memory", "threads", "files",
                                            "deck",   "deck_hash",   "program", "memory"};
/// Residuals and force balances are rounding errors: equal if both are small.
constexpr double rounding_error = 1e-8;
const std::set<std::string> rounding_keys = {"residual", "balance"};
/// Below these keys numbers are compared relative to the largest of the whole file under the same
/// key: components that vanish hold rounding errors.
const std::set<std::string> shared_scale = {"energy", "applied_force", "foundation_force",
                                            "reactions", "control_points"};

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

class JsonComparison {
  public:
    JsonComparison(const Json& first, const Json& second, double tolerance)
        : tolerance_(tolerance) {
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

}  // namespace

std::vector<std::string> compare_json(const Json& first, const Json& second, double tolerance) {
    return JsonComparison(first, second, tolerance).differences();
}

}  // namespace couture::drivers
