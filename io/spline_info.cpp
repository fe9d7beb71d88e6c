#include "io/spline_info.h"

#include <fmt/format.h>

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

template <int d>
Json describe_patch(const iga::Patch<d>& patch) {
    Json result;
    result["degrees"] = to_array(patch.space().degrees());
    result["elements"] = to_array(patch.space().n_elements());
    result["control_points"] = to_array(patch.space().sizes());
    result["rational"] = patch.is_rational();
    if (patch.dimension() == d) {
        const iga::PatchCertificate<d> certificate = iga::certify(patch);
        result["validity"] = iga::to_string(certificate.validity);
        result["left_handed"] = certificate.orientation < 0;
        result["min_jacobian"] = certificate.min_jacobian;
        result["min_jacobian_at"] = to_array(certificate.min_xi);
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
    for (const iga::Patch<d>& patch : multipatch.patches) {
        result["patches"].push_back(describe_patch(patch));
    }
    result["n_interfaces"] = multipatch.interfaces.size();
    result["n_outer_sides"] = multipatch.outer_sides().size();
    result["boundary_sets"] = Json::object();
    for (const auto& [name, set] : multipatch.boundary_sets) {
        result["boundary_sets"][name] = set.size();
    }
    result["volume"] = iga::volume(multipatch);
    if (multipatch.dimension() == d) {
        const iga::QualitySummary<d> quality = iga::element_quality(multipatch);
        result["min_scaled_jacobian"] = quality.min_scaled_jacobian;
        result["mean_scaled_jacobian"] = quality.mean_scaled_jacobian;
        result["worst_patch"] = quality.worst_patch;
        result["worst_at"] = to_array(quality.worst_xi);
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

std::string patch_line(std::size_t number, const Json& patch) {
    std::string line =
        fmt::format("  patch {}: degrees {}, elements {}, control points {}{}", number,
                    patch["degrees"].dump(), patch["elements"].dump(),
                    patch["control_points"].dump(), patch["rational"] ? ", rational" : "");
    if (patch.contains("validity")) {
        line +=
            fmt::format(", {}{}, smallest Jacobian {} at {}", patch["validity"].get<std::string>(),
                        patch["left_handed"] ? ", left-handed" : "", patch["min_jacobian"].dump(),
                        patch["min_jacobian_at"].dump());
    }
    return line + "\n";
}

}  // namespace

std::string spline_info_json(const SplineFile& file) {
    // Names from files may hold any bytes.
    return to_json(file).dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string spline_info_text(const SplineFile& file) {
    const Json info = to_json(file);
    const bool is_surface = info["n_parameters"] == 2;
    std::string text = fmt::format("{}: {} patch(es), {} interface(s), {} outer side(s)\n",
                                   file.format, info["patches"].size(), info["n_interfaces"].dump(),
                                   info["n_outer_sides"].dump());
    for (std::size_t i = 0; i < info["patches"].size(); ++i) {
        text += patch_line(i, info["patches"][i]);
    }
    for (const auto& [name, size] : info["boundary_sets"].items()) {
        text += fmt::format("boundary set '{}': {} part(s)\n", name, size.dump());
    }
    text += fmt::format("control points: {}\n{}: {}\n", info["n_control_points"].dump(),
                        is_surface ? "area" : "volume", info["volume"].dump());
    if (info.contains("min_scaled_jacobian")) {
        text += fmt::format("scaled Jacobian: smallest {} (patch {} at {}), mean {}\n",
                            info["min_scaled_jacobian"].dump(), info["worst_patch"].dump(),
                            info["worst_at"].dump(), info["mean_scaled_jacobian"].dump());
    }
    text += fmt::format("signature: {}\n", info["signature"].get<std::string>());
    for (const std::string& note : file.notes) {
        text += fmt::format("note: {}\n", note);
    }
    return text;
}

}  // namespace couture::io
