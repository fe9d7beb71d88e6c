#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/summary.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::ordered_json;

Json to_json_list(const Vector3& v) { return Json::array({v[0], v[1], v[2]}); }

Json to_json_object(const std::map<std::string, Vector3>& forces) {
    Json object = Json::object();
    for (const auto& [set, force] : forces) {
        object[set] = to_json_list(force);
    }
    return object;
}

Json to_json_object(const CaseSummary& load_case) {
    return {{"name", case_title(load_case.name)},
            {"energy", load_case.energy},
            {"applied_force", to_json_list(load_case.applied_force)},
            {"foundation_force", to_json_list(load_case.foundation_force)},
            {"reactions", to_json_object(load_case.reactions)},
            {"balance", load_case.balance}};
}

Json to_json_object(const iga::RemeshingReport& report) {
    const auto pair = [](double before, double after) {
        return Json{{"before", before}, {"after", after}};
    };
    return {{"cause", report.cause},
            {"transfer", report.transfer == iga::Transfer::gradient ? "gradient" : "displacement"},
            {"energy",
             {{"before", report.energy_before},
              {"transferred", report.energy_transferred},
              {"after", report.energy_after}}},
            {"volume", pair(report.volume_before, report.volume_after)},
            {"reactions_before", to_json_object(report.reactions_before)},
            {"reactions_after", to_json_object(report.reactions_after)},
            {"shape_ratio", pair(report.shape_ratio_before, report.shape_ratio_after)},
            {"scaled_jacobian", pair(report.scaled_jacobian_before, report.scaled_jacobian_after)},
            {"angle_deviation", pair(report.angle_deviation_before, report.angle_deviation_after)},
            {"gradient_drift", report.gradient_drift},
            {"min_det_F", report.min_det_F},
            {"largest_gap", report.largest_gap},
            {"iterations", report.n_iterations}};
}

Json to_json_object(const StepSummary& step) {
    Json object = {{"number", step.number},
                   {"t", step.t},
                   {"step", step.step},
                   {"iterations", step.n_iterations},
                   {"cuts", step.n_cuts},
                   {"residual", step.residual},
                   {"energy", step.energy},
                   {"work", step.work},
                   {"min_det_F", step.min_det_F},
                   {"applied_force", to_json_list(step.applied_force)},
                   {"reactions", to_json_object(step.reactions)}};
    if (step.remeshing) {
        object["remeshing"] = to_json_object(*step.remeshing);
    }
    return object;
}

/// Adds the keys of a run over time.
void add_stepping(Json& object, const SteppingSummary& stepping) {
    object["finished"] = stepping.finished;
    if (!stepping.finished) {
        object["reason"] = stepping.reason;
    }
    object["steps"] = stepping.n_steps();
    object["cuts"] = stepping.n_cuts;
    object["newton_iterations"] = stepping.n_iterations();
    object["remeshings"] = stepping.n_remeshings();
    Json history = Json::array();
    for (const StepSummary& step : stepping.history) {
        history.push_back(to_json_object(step));
    }
    object["history"] = history;
}

Json to_json_object(const ProbeResult& probe) {
    Json object = {{"name", probe.name},
                   {"quantity", probe.quantity},
                   {"case", case_title(probe.load_case)},
                   {"value", probe.value}};
    if (probe.t) {
        object["t"] = *probe.t;
    }
    if (probe.expected) {
        object["expected"] = *probe.expected;
        object["allowed_error"] = probe.allowed_error;
    }
    object["passed"] = probe.passed;
    return object;
}

}  // namespace

std::string to_json(const Summary& summary) {
    Json phases = Json::array();
    for (const Phase& phase : summary.phases) {
        phases.push_back(
            {{"name", phase.name}, {"seconds", phase.seconds}, {"peak_memory", phase.peak_memory}});
    }
    Json cases = Json::array();
    for (const CaseSummary& load_case : summary.cases) {
        cases.push_back(to_json_object(load_case));
    }
    Json probes = Json::array();
    for (const ProbeResult& probe : summary.probes) {
        probes.push_back(to_json_object(probe));
    }
    Json object = {{"program", "couture " COUTURE_VERSION},
                   {"status", !summary.finished() ? "not_finished"
                              : summary.passed()  ? "done"
                                                  : "expectation_not_met"},
                   {"deck", summary.deck},
                   {"deck_hash", summary.deck_hash},
                   {"title", summary.title},
                   {"units", summary.units},
                   {"signature", summary.signature},
                   {"certificate",
                    {{"validity", iga::to_string(summary.certificate.validity)},
                     {"min_jacobian", summary.certificate.min_jacobian},
                     {"patch", summary.certificate.patch}}},
                   {"dimension", summary.dimension},
                   {"patches", summary.n_patches},
                   {"interfaces", summary.n_interfaces},
                   {"control_points", summary.n_control_points},
                   {"volume", summary.volume},
                   {"elements", summary.n_elements},
                   {"unknowns", summary.n_unknowns},
                   {"threads", summary.n_threads},
                   {"phases", phases},
                   {"peak_memory", peak_memory()},
                   {"solver",
                    {{"name", summary.solver.solver},
                     {"iterations", summary.solver.iterations},
                     {"residual", summary.solver.residual},
                     {"memory", summary.solver.memory},
                     {"note", summary.solver.note}}},
                   {"energy", cases.empty() ? Json(0.0) : cases[0]["energy"]},
                   {"reactions", cases.empty() ? Json::object() : cases[0]["reactions"]},
                   {"cases", cases},
                   {"probes", probes},
                   {"warnings", summary.warnings},
                   {"files", summary.files}};
    if (summary.distribution) {
        const DistributionSummary& ranks = *summary.distribution;
        object["ranks"] = {{"elements", ranks.elements},
                           {"unknowns", ranks.unknowns},
                           {"neighbours", ranks.neighbours},
                           {"bytes_sent", ranks.bytes_sent},
                           {"peak_memory", ranks.peak_memory}};
    }
    if (summary.stepping) {
        add_stepping(object, *summary.stepping);
    }
    return object.dump(2) + "\n";
}

std::string error_json(const std::string& message, int exit_code) {
    const Json object = {{"program", "couture " COUTURE_VERSION},
                         {"status", exit_code == 2 ? "bad_input" : "failed"},
                         {"error", message}};
    // Messages may quote bytes of a broken file that are not text.
    return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace couture::drivers
