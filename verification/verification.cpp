#include "verification/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "iga/core/error.h"
#include "verification/benchmarks/beams.h"
#include "verification/benchmarks/calculix.h"
#include "verification/benchmarks/cook.h"
#include "verification/benchmarks/hyperelastic.h"
#include "verification/benchmarks/kirsch.h"
#include "verification/benchmarks/lame.h"
#include "verification/benchmarks/nafems.h"
#include "verification/benchmarks/remeshing.h"
#include "verification/benchmarks/shells.h"
#include "verification/geometry/known_shapes.h"
#include "verification/geometry/shapes.h"
#include "verification/manufactured/convergence.h"
#include "verification/manufactured/patch_tests.h"

namespace couture::verification {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

}  // namespace

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (std::vector<Case> (*group)() :
         {known_shape_cases, shape_cases, patch_test_cases, convergence_cases, lame_cases,
          kirsch_cases, nafems_cases, cook_cases, shell_cases, beam_cases, hyperelastic_cases,
          remeshing_cases, calculix_cases}) {
        const std::vector<Case> more = group();
        cases.insert(cases.end(), more.begin(), more.end());
    }
    return cases;
}

int VerificationReport::n_failed() const {
    return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const Row& row) {
        return !row.passed && row.skipped.empty();
    }));
}

int VerificationReport::n_skipped() const {
    return static_cast<int>(std::count_if(rows.begin(), rows.end(),
                                          [](const Row& row) { return !row.skipped.empty(); }));
}

VerificationReport run_verification(const VerificationOptions& options) {
    const Timer timer;
    Recorder recorder(options.on_row);
    const std::string filter = lower(options.filter);
    std::vector<std::string> names;
    bool found = false;
    std::vector<Case> cases = all_cases();
    cases.insert(cases.end(), options.more.begin(), options.more.end());
    for (const Case& one : cases) {
        names.push_back("'" + one.name + "'");
        if (lower(one.name).find(filter) == std::string::npos) {
            continue;
        }
        found = true;
        if (one.is_long && !options.with_long) {
            continue;
        }
        recorder.start(one.name);
        try {
            one.run(recorder);
        } catch (const std::exception& error) {
            recorder.failure(error.what());
        }
    }
    if (!found) {
        throw InputError("verify: no case is named like '{}'; there are: {}", options.filter,
                         fmt::join(names, ", "));
    }
    return {recorder.rows(), timer.seconds()};
}

}  // namespace couture::verification
