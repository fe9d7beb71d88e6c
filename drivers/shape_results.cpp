#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/shape_run.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace {

using nlohmann::ordered_json;

std::vector<double> list(const VectorX& values) { return {values.begin(), values.end()}; }

std::string to_string(rom::Alignment alignment) {
    switch (alignment) {
        case rom::Alignment::none:
            return "none";
        case rom::Alignment::rigid:
            return "rigid";
        case rom::Alignment::similarity:
            return "similarity";
    }
    return "";
}

const std::string& name_of(const ShapeRun& run, int member) {
    return run.population.members[member].name;
}

double distance_to_mean(const ShapeRun& run, int member) {
    return run.model.coefficients.col(member).norm() / std::sqrt(run.model.n_points());
}

ordered_json to_json(const rom::ShapeCurve& curve) {
    return {{"values", list(curve.values)}, {"errors", list(curve.errors)}};
}

ordered_json members_json(const ShapeRun& run) {
    ordered_json members = ordered_json::array();
    for (int j = 0; j < run.model.n_members(); ++j) {
        members.push_back({{"name", name_of(run, j)},
                           {"file", run.population.members[j].file.string()},
                           {"coefficients", list(run.model.coefficients.col(j))},
                           {"scale", run.model.motions[j].scale},
                           {"distance_to_mean", distance_to_mean(run, j)}});
    }
    return members;
}

ordered_json modes_json(const ShapeRun& run) {
    ordered_json modes = ordered_json::array();
    for (int k = 0; k < run.model.n_modes(); ++k) {
        modes.push_back({{"standard_deviation", run.model.standard_deviations[k]},
                         {"variance_part", run.compactness[k + 1] - run.compactness[k]},
                         {"largest_displacement",
                          run.model.standard_deviations[k] *
                              rom::mode_shape(run.model, k).rowwise().norm().maxCoeff()}});
    }
    return modes;
}

ordered_json to_json(const ShapeRun& run, const ProjectedShape& shape) {
    const rom::ShapeProjection& projection = shape.projection;
    ordered_json nearest = ordered_json::array();
    for (const rom::NearMember& member : projection.nearest) {
        nearest.push_back({{"name", name_of(run, member.member)}, {"distance", member.distance}});
    }
    return {{"name", shape.member.name},
            {"file", shape.member.file.string()},
            {"coefficients", list(projection.coefficients)},
            {"scores", list(projection.scores)},
            {"distance", projection.distance},
            {"max_distance", projection.max_distance},
            {"distance_to_mean", projection.distance_to_mean},
            {"nearest", nearest}};
}

ordered_json to_json(const VirtualShape& shape) {
    ordered_json object = {{"name", shape.name}, {"scores", list(shape.scores)}};
    if (!shape.certificate.empty()) object["certificate"] = shape.certificate;
    return object;
}

void print_modes(const ShapeRun& run) {
    fmt::print("{:>5} {:>12} {:>10} {:>12} {:>15} {:>12}\n", "modes", "std. dev.", "part",
               "compactness", "generalisation", "specificity");
    const int n_rows = std::min(run.model.n_modes(), std::max(run.n_modes, 10));
    for (int k = 0; k <= n_rows; ++k) {
        const bool has_general = run.generalisation && k < run.generalisation->values.size();
        fmt::print("{:>5} {:>12} {:>10} {:>12.6f} {:>15} {:>12.6g}\n", k,
                   k == 0 ? "" : fmt::format("{:.6g}", run.model.standard_deviations[k - 1]),
                   k == 0 ? "" : fmt::format("{:.4f}", run.compactness[k] - run.compactness[k - 1]),
                   run.compactness[k],
                   has_general ? fmt::format("{:.6g}", run.generalisation->values[k]) : "",
                   run.specificity.values[k]);
    }
    if (n_rows < run.model.n_modes()) fmt::print("... {} modes in all\n", run.model.n_modes());
}

void print_projection(const ShapeRun& run, const ProjectedShape& shape) {
    const rom::ShapeProjection& projection = shape.projection;
    fmt::print(
        "\n{}: {:.6g} from its projection onto {} modes (at most {:.6g}), {:.6g} from the "
        "mean\n",
        shape.member.name, projection.distance, run.n_modes, projection.max_distance,
        projection.distance_to_mean);
    fmt::print("  coefficients over standard deviations: {:.3f}\n",
               fmt::join(projection.scores, " "));
    fmt::print("  nearest members:");
    for (const rom::NearMember& member : projection.nearest) {
        fmt::print(" {} ({:.6g})", name_of(run, member.member), member.distance);
    }
    fmt::print("\n");
}

}  // namespace

std::string shape_json(const ShapeRun& run) {
    const ShapeConnectivity& connectivity = run.population.connectivity;
    ordered_json object = {{"program", "couture " COUTURE_VERSION},
                           {"status", "done"},
                           {"kind", connectivity.kind},
                           {"signature", connectivity.signature},
                           {"points", connectivity.n_points},
                           {"alignment", to_string(run.model.alignment)},
                           {"iterations", run.model.n_iterations},
                           {"converged", run.model.has_converged},
                           {"reference", name_of(run, run.model.reference)},
                           {"members", members_json(run)},
                           {"modes", modes_json(run)},
                           {"used_modes", run.n_modes},
                           {"compactness", list(run.compactness)}};
    if (run.generalisation) object["generalisation"] = to_json(*run.generalisation);
    object["specificity"] = to_json(run.specificity);
    if (!run.mean_certificate.empty()) object["mean_certificate"] = run.mean_certificate;
    object["projections"] = ordered_json::array();
    for (const ProjectedShape& shape : run.projections) {
        object["projections"].push_back(to_json(run, shape));
    }
    object["virtual"] = ordered_json::array();
    for (const VirtualShape& shape : run.virtuals) object["virtual"].push_back(to_json(shape));
    object["seconds"] = run.seconds;
    object["warnings"] = log::warnings();
    object["files"] = ordered_json::array();
    for (const auto& file : run.files) object["files"].push_back(file.string());
    return object.dump(2);
}

void print_shape(const ShapeRun& run, const std::filesystem::path& folder) {
    const ShapeConnectivity& connectivity = run.population.connectivity;
    fmt::print("{} members ({}, {} points, signature {}), alignment {}; reference {}\n",
               run.model.n_members(), connectivity.kind, connectivity.n_points,
               connectivity.signature, to_string(run.model.alignment),
               name_of(run, run.model.reference));
    print_modes(run);
    if (!run.mean_certificate.empty()) fmt::print("mean: {}\n", run.mean_certificate);
    for (const ProjectedShape& shape : run.projections) print_projection(run, shape);
    for (const VirtualShape& shape : run.virtuals) {
        fmt::print("{}: {:.3g} standard deviations{}{}\n", shape.name,
                   fmt::join(shape.scores, ", "), shape.certificate.empty() ? "" : ", ",
                   shape.certificate);
    }
    fmt::print("{:.1f} s; wrote {} files to {}\n", run.seconds, run.files.size(), folder.string());
}

}  // namespace couture::drivers
