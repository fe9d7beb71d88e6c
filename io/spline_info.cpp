#include "io/spline_info.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "iga/topology/element_quality.h"
#include "iga/topology/jacobian_certificate.h"

namespace couture::io {

namespace {

using Json = nlohmann::ordered_json;

template <typename Column>
Json to_array(const Column& column) {
    Json result = Json::array();
    for (const auto& value : column) {
        result.push_back(value);
    }
    return result;
}

/// JSON has no infinity.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

template <int d>
Json describe_patch(const iga::MultiPatch<d>& multipatch, int number) {
    const iga::Patch<d>& patch = multipatch.patches[number];
    Json result;
    result["degrees"] = to_array(patch.space().degrees());
    result["elements"] = to_array(patch.space().n_elements());
    result["control_points"] = to_array(patch.space().sizes());
    result["knots"] = Json::array();
    for (const iga::KnotVector& knots : patch.space().knots) {
        result["knots"].push_back(knots.knots());
    }
    result["rational"] = patch.is_rational();
    if (patch.dimension() == d) {
        const iga::PatchCertificate<d> certificate = iga::certify(patch);
        result["validity"] = iga::to_string(certificate.validity);
        result["left_handed"] = certificate.orientation < 0;
        result["min_jacobian"] = certificate.min_jacobian;
        result["min_jacobian_at"] = to_array(certificate.min_xi);
        const iga::QualitySummary<d> quality =
            iga::element_quality(iga::MultiPatch<d>{{patch}, {}, {}});
        result["min_scaled_jacobian"] = quality.min_scaled_jacobian;
    }
    return result;
}

template <int d>
Json describe(const iga::MultiPatch<d>& multipatch) {
    Json result;
    result["n_parameters"] = d;
    result["dimension"] = multipatch.dimension();
    result["n_control_points"] = multipatch.n_control_points();
    result["patches"] = Json::array();
    for (int i = 0; i < multipatch.n_patches(); ++i) {
        result["patches"].push_back(describe_patch(multipatch, i));
    }
    result["n_interfaces"] = multipatch.interfaces.size();
    result["interfaces"] = Json::array();
    for (const iga::Interface<d>& interface : multipatch.interfaces) {
        result["interfaces"].push_back(iga::to_string(interface));
    }
    result["n_outer_sides"] = multipatch.outer_sides().size();
    result["boundary_sets"] = Json::object();
    for (const auto& [name, set] : multipatch.boundary_sets) {
        result["boundary_sets"][name] = Json::array();
        for (const iga::PatchEntity<d>& entity : set) {
            result["boundary_sets"][name].push_back(entity.name());
        }
    }
    const MatrixX box = multipatch.bounding_box();
    result["bounding_box"]["low"] = to_array(box.col(0));
    result["bounding_box"]["high"] = to_array(box.col(1));
    result["volume"] = iga::volume(multipatch);
    if (multipatch.dimension() == d) {
        const iga::QualitySummary<d> quality = iga::element_quality(multipatch);
        result["min_scaled_jacobian"] = quality.min_scaled_jacobian;
        result["mean_scaled_jacobian"] = quality.mean_scaled_jacobian;
        result["worst_patch"] = quality.worst_patch;
        result["worst_at"] = to_array(quality.worst_xi);
        result["max_shape_ratio"] = finite_or_null(quality.max_shape_ratio);
        result["mean_shape_ratio"] = finite_or_null(quality.mean_shape_ratio);
        result["worst_shape_ratio_patch"] = quality.worst_shape_ratio_patch;
        result["worst_shape_ratio_at"] = to_array(quality.worst_shape_ratio_xi);
        result["max_angle_deviation"] = quality.max_angle_deviation;
        result["mean_angle_deviation"] = quality.mean_angle_deviation;
    }
    result["signature"] = iga::signature(multipatch);
    return result;
}

Json to_json(const SplineFile& file) {
    Json result;
    result["format"] = file.format;
    result.update(
        std::visit([](const auto& multipatch) { return describe(multipatch); }, file.multipatch));
    result["notes"] = file.notes;
    return result;
}

/// "1 patch", "2 patches".
std::string count(std::size_t n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

/// "2 x 2 x 3".
std::string product(const Json& numbers) {
    return fmt::format("{}", fmt::join(numbers.get<std::vector<int>>(), " x "));
}

/// "1.73205"; what JSON has no number for is infinite.
std::string number(const Json& value) {
    return value.is_null() ? "infinite" : fmt::format("{:.6g}", value.get<double>());
}

/// "(0, 0.5, 1)".
std::string point(const Json& coordinates) {
    std::string text;
    for (const Json& coordinate : coordinates) {
        text += fmt::format("{}{:.6g}", text.empty() ? "(" : ", ", coordinate.get<double>());
    }
    return text + ")";
}

std::string patch_line(std::size_t number, const Json& patch) {
    std::string line = fmt::format(
        "  patch {}: degrees {}, elements {}, control points {}{}", number,
        fmt::join(patch["degrees"].get<std::vector<int>>(), ", "), product(patch["elements"]),
        product(patch["control_points"]), patch["rational"] ? ", rational" : "");
    if (patch.contains("validity")) {
        line += fmt::format("; {}{}, smallest Jacobian {:.6g} at {}, scaled {:.6g}",
                            patch["validity"].get<std::string>(),
                            patch["left_handed"] ? ", left-handed" : "",
                            patch["min_jacobian"].get<double>(), point(patch["min_jacobian_at"]),
                            patch["min_scaled_jacobian"].get<double>());
    }
    return line + "\n";
}

/// "folded: patch 5, patch 8\n", or nothing if no patch is so.
template <typename Condition>
std::string patch_list(const Json& patches, const char* what, const Condition& is_so) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (patches[i].contains("validity") && is_so(patches[i])) {
            names.push_back(fmt::format("patch {}", i));
        }
    }
    return names.empty() ? "" : fmt::format("{}: {}\n", what, fmt::join(names, ", "));
}

}  // namespace

std::string spline_info_json(const SplineFile& file) {
    // Names from files may hold any bytes.
    return to_json(file).dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string spline_info_text(const SplineFile& file) {
    const Json info = to_json(file);
    const Json& patches = info["patches"];
    std::string text =
        fmt::format("{}: {}, {}, {}\n", file.format, count(patches.size(), "patch", "patches"),
                    count(info["interfaces"].size(), "interface", "interfaces"),
                    count(info["n_outer_sides"].get<std::size_t>(), "outer side", "outer sides"));
    for (std::size_t i = 0; i < patches.size(); ++i) {
        text += patch_line(i, patches[i]);
    }
    for (const Json& interface : info["interfaces"]) {
        text += fmt::format("  interface: {}\n", interface.get<std::string>());
    }
    for (const auto& [name, set] : info["boundary_sets"].items()) {
        text += fmt::format("boundary set '{}': {}\n", name,
                            fmt::join(set.template get<std::vector<std::string>>(), ", "));
    }
    text +=
        fmt::format("control points: {}\nbounding box: {} to {}\n{}: {:.12g}\n",
                    info["n_control_points"].get<int>(), point(info["bounding_box"]["low"]),
                    point(info["bounding_box"]["high"]),
                    info["n_parameters"] == 2 ? "area" : "volume", info["volume"].get<double>());
    if (info.contains("min_scaled_jacobian")) {
        text +=
            fmt::format("scaled Jacobian: smallest {:.6g} (patch {} at {}), mean {:.6g}\n",
                        info["min_scaled_jacobian"].get<double>(), info["worst_patch"].get<int>(),
                        point(info["worst_at"]), info["mean_scaled_jacobian"].get<double>());
        text +=
            fmt::format("shape ratio: largest {} (patch {} at {}), mean {}\n",
                        number(info["max_shape_ratio"]), info["worst_shape_ratio_patch"].get<int>(),
                        point(info["worst_shape_ratio_at"]), number(info["mean_shape_ratio"]));
        text += fmt::format("angle deviation: largest {:.6g}, mean {:.6g}\n",
                            info["max_angle_deviation"].get<double>(),
                            info["mean_angle_deviation"].get<double>());
    }
    text += patch_list(patches, "folded",
                       [](const Json& patch) { return patch["validity"] == "folded"; });
    text += patch_list(patches, "left-handed",
                       [](const Json& patch) { return patch["left_handed"] == true; });
    text += fmt::format("signature: {}\n", info["signature"].get<std::string>());
    for (const std::string& note : file.notes) {
        text += fmt::format("note: {}\n", note);
    }
    return text;
}

}  // namespace couture::io
