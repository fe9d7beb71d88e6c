#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verification/recorder.h"

namespace couture::verification {

/// One problem whose answer is known.
struct Case {
    std::string name;
    /// Only run when asked for: it takes longer than the others.
    bool is_long = false;
    std::function<void(Recorder&)> run;
};

/// Every case, in the order of `README.md`.
[[nodiscard]] std::vector<Case> all_cases();

struct VerificationOptions {
    /// Run cases whose name contains this text, letters of either size; empty: all.
    std::string filter;
    /// Run the long cases too.
    bool with_long = false;
    /// Cases after those of `all_cases`.
    std::vector<Case> more;
    /// Called with each row when it is known; may be empty.
    std::function<void(const Row&)> on_row;
};

struct VerificationReport {
    std::vector<Row> rows;
    double seconds = 0.0;
    [[nodiscard]] int n_failed() const;
    [[nodiscard]] int n_skipped() const;
};

/// Runs the cases. What a case throws becomes a row that failed.
///
/// @throws InputError  if the filter fits no case: lists those there are
[[nodiscard]] VerificationReport run_verification(const VerificationOptions& options = {});

}  // namespace couture::verification
