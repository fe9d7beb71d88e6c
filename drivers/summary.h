#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/deck_check.h"
#include "iga/core/timer.h"
#include "iga/core/types.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/solve/load_stepping.h"

namespace couture::drivers {

/// One number that the deck asked for.
struct ProbeResult {
    /// The deck's name for it, or "stress_yy at (1, 0, 0)".
    std::string name;
    std::string quantity;
    std::string load_case;
    /// In a run over time; nothing: at its end.
    std::optional<double> t;
    double value = 0.0;
    std::optional<double> expected;
    /// Largest accepted |value - expected|.
    double allowed_error = 0.0;
    bool passed = true;
};

/// One load case or combination.
struct CaseSummary {
    std::string name;
    double energy = 0.0;
    Vector3 applied_force = Vector3::Zero();
    Vector3 foundation_force = Vector3::Zero();
    std::map<std::string, Vector3> reactions;
    double balance = 0.0;
};

/// One accepted step of a run over time, or the remeshing that followed it.
struct StepSummary {
    int number = 0;
    double t = 0.0;
    double step = 0.0;
    int n_iterations = 0;
    int n_cuts = 0;
    double residual = 0.0;
    double energy = 0.0;
    double work = 0.0;
    double min_det_F = 1.0;
    Vector3 applied_force = Vector3::Zero();
    std::map<std::string, Vector3> reactions;
    std::optional<iga::RemeshingReport> remeshing;
};

/// A run over time.
struct SteppingSummary {
    bool finished = false;
    /// Why it stopped before its end.
    std::string reason;
    /// Given up on the way: those of the accepted steps, and those tried last.
    int n_cuts = 0;
    std::vector<StepSummary> history;

    [[nodiscard]] int n_steps() const;
    [[nodiscard]] int n_iterations() const;
    [[nodiscard]] int n_remeshings() const;
};

/// How a run of several ranks was shared out.
struct DistributionSummary {
    /// One number per rank; unknowns: those that it owns.
    std::vector<double> elements;
    std::vector<double> unknowns;
    /// Ranks that it exchanges with, and bytes that it sends in one product of matrix and vector.
    std::vector<double> neighbours;
    std::vector<double> bytes_sent;
    /// Highest resident memory, bytes.
    std::vector<double> peak_memory;
};

/// What a run is summed up to; see `schema.md`.
struct Summary {
    std::string deck;
    std::string deck_hash;
    std::string title;
    std::string units;
    std::string signature;
    GeometryCertificate certificate;
    int dimension = 3;
    int n_patches = 0;
    int n_interfaces = 0;
    int n_control_points = 0;
    double volume = 0.0;
    int n_elements = 0;
    int n_unknowns = 0;
    int n_threads = 1;
    std::vector<Phase> phases;
    iga::SolveReport solver;
    std::vector<CaseSummary> cases;
    /// Of several ranks.
    std::optional<DistributionSummary> distribution;
    /// Of hyperelastic decks.
    std::optional<SteppingSummary> stepping;
    std::vector<ProbeResult> probes;
    std::vector<std::string> warnings;
    std::vector<std::string> files;

    /// The run reached its end.
    [[nodiscard]] bool finished() const { return !stepping || stepping->finished; }
    /// True if all expectations are met.
    [[nodiscard]] bool passed() const;
};

/// Name of a load case in messages and results: the unnamed one is "default".
[[nodiscard]] std::string case_title(const std::string& name);

/// The summary as a table for people.
[[nodiscard]] std::string to_table(const Summary& summary);

/// The summary as one JSON object, indented.
[[nodiscard]] std::string to_json(const Summary& summary);

/// An object that says only why a run gave no result.
[[nodiscard]] std::string error_json(const std::string& message, int exit_code);

}  // namespace couture::drivers
