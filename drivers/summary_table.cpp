#include <fmt/format.h>

#include <algorithm>

#include "drivers/summary.h"

namespace couture::drivers {

namespace {

constexpr double megabyte = 1024.0 * 1024.0;

std::string to_text(const Vector3& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]);
}

std::string probe_lines(const std::vector<ProbeResult>& probes) {
    std::size_t width = 10;
    const auto label = [&](const ProbeResult& probe) {
        return probe.load_case.empty() ? probe.name
                                       : fmt::format("{} [{}]", probe.name, probe.load_case);
    };
    for (const ProbeResult& probe : probes) {
        width = std::max(width, label(probe).size());
    }
    std::string text =
        fmt::format("  {:<{}} {:>13} {:>13}\n", "probe", width, "obtained", "expected");
    for (const ProbeResult& probe : probes) {
        text += fmt::format("  {:<{}} {:>13.6g}", label(probe), width, probe.value);
        if (probe.expected) {
            text += fmt::format(
                " {:>13.6g}  {}", *probe.expected,
                probe.passed ? "ok"
                             : fmt::format("NOT MET (allowed error {:.3g})", probe.allowed_error));
        }
        text += "\n";
    }
    return text;
}

std::string remeshing_lines(const StepSummary& step) {
    const iga::RemeshingReport& report = *step.remeshing;
    std::string text = fmt::format("    meshed again at t = {:.6g} ({}), {} iterations\n", step.t,
                                   report.cause, report.n_iterations);
    const auto line = [&](const char* name, double before, double after) {
        text +=
            fmt::format("      {:<22} before {:>13.6g}  after {:>13.6g}\n", name, before, after);
    };
    line("energy", report.energy_before, report.energy_after);
    line("volume", report.volume_before, report.volume_after);
    line("worst shape ratio", report.shape_ratio_before, report.shape_ratio_after);
    line("worst scaled Jacobian", report.scaled_jacobian_before, report.scaled_jacobian_after);
    line("worst angle deviation", report.angle_deviation_before, report.angle_deviation_after);
    return text;
}

std::string stepping_lines(const SteppingSummary& stepping) {
    std::string text = fmt::format("  steps {}, cuts {}, Newton iterations {}, remeshings {}\n",
                                   stepping.n_steps(), stepping.n_cuts, stepping.n_iterations(),
                                   stepping.n_remeshings());
    for (const StepSummary& step : stepping.history) {
        if (step.remeshing) {
            text += remeshing_lines(step);
        }
    }
    if (!stepping.history.empty()) {
        const StepSummary& last = stepping.history.back();
        text += fmt::format("  at t = {:.6g}: energy {:.6g}, work {:.6g}, det F >= {:.4g}\n",
                            last.t, last.energy, last.work, last.min_det_F);
    }
    if (!stepping.finished) {
        text += fmt::format("  NOT FINISHED: {}\n", stepping.reason);
    }
    return text;
}

std::string distribution_lines(const DistributionSummary& ranks) {
    const auto range = [](const std::vector<double>& values, double unit) {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        return fmt::format("{:.4g} to {:.4g}", *least / unit, *most / unit);
    };
    constexpr double kilobyte = 1024.0;
    return fmt::format(
        "  ranks {}: elements {}, unknowns {}, neighbours {}, sent per product {} kB, peak memory "
        "{} MB\n",
        ranks.elements.size(), range(ranks.elements, 1.0), range(ranks.unknowns, 1.0),
        range(ranks.neighbours, 1.0), range(ranks.bytes_sent, kilobyte),
        range(ranks.peak_memory, megabyte));
}

}  // namespace

int SteppingSummary::n_steps() const { return static_cast<int>(history.size()) - n_remeshings(); }

int SteppingSummary::n_iterations() const {
    int n = 0;
    for (const StepSummary& step : history) {
        n += step.n_iterations;
    }
    return n;
}

int SteppingSummary::n_remeshings() const {
    return static_cast<int>(
        std::count_if(history.begin(), history.end(),
                      [](const StepSummary& step) { return step.remeshing.has_value(); }));
}

bool Summary::passed() const {
    return std::all_of(probes.begin(), probes.end(),
                       [](const ProbeResult& probe) { return probe.passed; });
}

std::string case_title(const std::string& name) { return name.empty() ? "default" : name; }

std::string to_table(const Summary& summary) {
    std::string text = summary.title + "\n";
    text += fmt::format("  patches {}, interfaces {}, elements {}, unknowns {}, volume {:.10g}\n",
                        summary.n_patches, summary.n_interfaces, summary.n_elements,
                        summary.n_unknowns, summary.volume);
    text += fmt::format("  geometry {}, smallest det J {:.3g} (patch {})\n",
                        summary.certificate.validity == iga::Validity::valid
                            ? "proven free of folds"
                            : iga::to_string(summary.certificate.validity),
                        summary.certificate.min_jacobian, summary.certificate.patch);
    text += fmt::format("  solver {}, iterations {}, residual {:.2g}\n", summary.solver.solver,
                        summary.solver.iterations, summary.solver.residual);
    if (!summary.solver.note.empty()) {
        text += fmt::format("    {}\n", summary.solver.note);
    }
    if (summary.distribution) {
        text += distribution_lines(*summary.distribution);
    }
    if (summary.stepping) {
        text += stepping_lines(*summary.stepping);
    }
    for (const CaseSummary& load_case : summary.cases) {
        text += fmt::format("  case '{}': energy {:.6g}, applied force {}, balance {:.1e}\n",
                            case_title(load_case.name), load_case.energy,
                            to_text(load_case.applied_force), load_case.balance);
        for (const auto& [set, force] : load_case.reactions) {
            text += fmt::format("    reaction on '{}' {}\n", set, to_text(force));
        }
        if (load_case.foundation_force.norm() > 0.0) {
            text += fmt::format("    foundations {}\n", to_text(load_case.foundation_force));
        }
    }
    if (!summary.probes.empty()) {
        text += probe_lines(summary.probes);
    }
    text += fmt::format("  {:<24} {:>9} {:>12}\n", "phase", "seconds", "peak memory");
    for (const Phase& phase : summary.phases) {
        text += fmt::format("  {:<24} {:>9.2f} {:>9.0f} MB\n", phase.name, phase.seconds,
                            static_cast<double>(phase.peak_memory) / megabyte);
    }
    for (const std::string& warning : summary.warnings) {
        text += fmt::format("  warning: {}\n", warning);
    }
    for (const std::string& file : summary.files) {
        text += fmt::format("  wrote {}\n", file);
    }
    return text;
}

}  // namespace couture::drivers
