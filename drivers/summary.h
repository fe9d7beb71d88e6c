#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/deck_check.h"
#include "iga/core/timer.h"
#include "iga/core/types.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::drivers {

/// One number that the deck asked for.
struct ProbeResult {
    /// The deck's name for it, or "stress_yy at (1, 0, 0)".
    std::string name;
    std::string quantity;
    std::string load_case;
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
    std::vector<ProbeResult> probes;
    std::vector<std::string> warnings;
    std::vector<std::string> files;

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
