#include "drivers/family_results.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/atomic_file.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

const std::string done = "done";

ordered_json to_json(const meshing::HomologyReport& homology) {
    return {{"corners", homology.n_corners},
            {"curves", homology.n_curves},
            {"points_per_curve", homology.points_per_curve},
            {"max_corner_distance", homology.max_corner_distance},
            {"worst_corner", homology.worst_corner},
            {"max_curve_distance", homology.max_curve_distance},
            {"worst_curve", homology.worst_curve},
            {"homologous", homology.is_homologous()}};
}

meshing::HomologyReport read_homology(const ordered_json& object) {
    meshing::HomologyReport report;
    report.n_corners = object.at("corners");
    report.n_curves = object.at("curves");
    report.points_per_curve = object.at("points_per_curve");
    report.max_corner_distance = object.at("max_corner_distance");
    report.worst_corner = object.at("worst_corner");
    report.max_curve_distance = object.at("max_curve_distance");
    report.worst_curve = object.at("worst_curve");
    return report;
}

ordered_json to_json(const MemberResult& result) {
    ordered_json object = {{"name", result.member.name},
                           {"parameters", result.member.parameters},
                           {"status", result.failure.empty() ? done : "failed"},
                           {"reason", result.failure},
                           {"seconds", result.seconds}};
    if (!result.signature.empty()) {
        object["signature"] = result.signature;
        object["certificate"] = result.certificate;
        object["min_scaled_jacobian"] = result.min_scaled_jacobian;
        object["mean_scaled_jacobian"] = result.mean_scaled_jacobian;
        object["max_distance"] = result.max_distance;
        object["hausdorff"] = result.hausdorff;
        object["hausdorff_features"] = result.hausdorff_features;
    }
    if (result.homology) object["homology"] = to_json(*result.homology);
    if (!result.to_reference.empty()) {
        object["midpoint_with_reference"] = result.to_reference;
        object["midpoint_with_previous"] = result.to_previous;
    }
    return object;
}

MemberResult read_result(const ordered_json& object) {
    MemberResult result;
    result.member.name = object.at("name");
    result.member.parameters = object.at("parameters");
    result.seconds = object.at("seconds");
    result.signature = object.at("signature");
    result.certificate = object.at("certificate");
    result.min_scaled_jacobian = object.at("min_scaled_jacobian");
    result.mean_scaled_jacobian = object.at("mean_scaled_jacobian");
    result.max_distance = object.at("max_distance");
    result.hausdorff = object.at("hausdorff");
    result.hausdorff_features = object.at("hausdorff_features");
    if (object.contains("homology")) result.homology = read_homology(object["homology"]);
    result.to_reference = object.value("midpoint_with_reference", "");
    result.to_previous = object.value("midpoint_with_previous", "");
    return result;
}

void print_member(const MemberResult& result) {
    if (!result.failure.empty()) {
        fmt::print("{:<20} {:7.2f}  failed: {}\n", result.member.name, result.seconds,
                   result.failure);
        return;
    }
    fmt::print("{:<20} {:7.2f}  {}  {:.3f} {:.3f}  {:.1e}", result.member.name, result.seconds,
               result.signature, result.min_scaled_jacobian, result.mean_scaled_jacobian,
               result.hausdorff);
    if (result.homology) {
        fmt::print("  {:.1e} {:.1e}", result.homology->max_corner_distance,
                   result.homology->max_curve_distance);
    }
    if (!result.to_reference.empty()) {
        fmt::print("  {} {}", result.to_reference, result.to_previous);
    }
    fmt::print("\n");
}

}  // namespace

bool MemberResult::has_certified_midpoints() const {
    const std::string valid = iga::to_string(iga::Validity::valid);
    return to_reference.empty() || (to_reference == valid && to_previous == valid);
}

int FamilySummary::n_failed() const {
    return static_cast<int>(std::ranges::count_if(
        results, [](const MemberResult& result) { return !result.failure.empty(); }));
}

int FamilySummary::n_folded() const {
    return static_cast<int>(std::ranges::count_if(
        results, [](const MemberResult& result) { return !result.has_certified_midpoints(); }));
}

std::string family_json(const FamilySummary& summary) {
    ordered_json object = {{"program", "couture " COUTURE_VERSION},
                           {"status", summary.is_done() ? done : "failed"},
                           {"title", summary.title},
                           {"reference", summary.results.front().member.name},
                           {"signature", summary.results.front().signature},
                           {"failed_members", summary.n_failed()},
                           {"failed_midpoints", summary.n_folded()}};
    for (const MemberResult& result : summary.results) {
        object["members"].push_back(to_json(result));
    }
    object["seconds"] = summary.seconds;
    object["warnings"] = log::warnings();
    for (const fs::path& file : summary.files) object["files"].push_back(file.string());
    return object.dump(2);
}

void print_family(const FamilySummary& summary, const fs::path& folder) {
    fmt::print(
        "{:<20} {:>7}  {:<16}  scaled Jacobian from, mean; distance from the surface, homology "
        "(corners, curves; all of the diagonal); midpoints with the reference, the one before\n",
        "member", "s", "signature");
    for (const MemberResult& result : summary.results) print_member(result);
    fmt::print("{} of {} members done, midpoints of {} not certified\n",
               static_cast<int>(summary.results.size()) - summary.n_failed(),
               summary.results.size(), summary.n_folded());
    fmt::print("{:.1f} s; wrote {} files to {}\n", summary.seconds, summary.files.size(),
               folder.string());
}

void write_family_progress(const fs::path& path, const std::string& job,
                           const std::vector<MemberResult>& results) {
    ordered_json object = {{"job", job}, {"members", ordered_json::array()}};
    for (const MemberResult& result : results) object["members"].push_back(to_json(result));
    io::write_text(path, object.dump(2) + "\n");
}

std::vector<MemberResult> read_family_progress(const fs::path& path, const std::string& job) {
    if (!fs::exists(path)) return {};
    std::vector<MemberResult> results;
    try {
        const auto object = ordered_json::parse(io::read_text(path));
        if (object.at("job") != job) {
            throw InputError(
                "mesh: --resume: {} was written by another deck or another version; go on without "
                "--resume, or into another folder (--out)",
                path.string());
        }
        for (const ordered_json& member : object.at("members")) {
            if (member.at("status") == done) results.push_back(read_result(member));
        }
    } catch (const ordered_json::exception& error) {
        throw FileError(
            "{}: is no list of the members of a family, or was cut ({}); go on without --resume",
            path.string(), error.what());
    }
    return results;
}

}  // namespace couture::drivers
