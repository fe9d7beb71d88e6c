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

}  // namespace

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
