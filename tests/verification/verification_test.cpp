#include "verification/verification.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <set>

#include "iga/core/error.h"
#include "verification/table.h"

using namespace couture;
using namespace couture::verification;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

void check_all(const VerificationReport& report) {
    // Continuous integration has every program that results are compared with.
    const bool may_skip = std::getenv("CI") == nullptr;
    for (const Row& row : report.rows) {
        INFO(table_line(row));
        if (may_skip && !row.skipped.empty()) {
            WARN(table_line(row));
        } else {
            CHECK(row.passed);
        }
    }
    CHECK(report.n_failed() == 0);
}

}  // namespace

TEST_CASE("run_verification: a quick subset holds, whatever the size of its letters",
          "[verification]") {
    VerificationOptions options;
    options.filter = "PATCH TEST 2d";
    int n_seen = 0;
    options.on_row = [&](const Row&) { ++n_seen; };
    const VerificationReport report = run_verification(options);
    check_all(report);
    CHECK(n_seen == 15);
    CHECK(static_cast<int>(report.rows.size()) == n_seen);
}

TEST_CASE("run_verification: a filter that fits nothing lists the cases", "[verification]") {
    VerificationOptions options;
    options.filter = "no such case";
    CHECK_THROWS_WITH(run_verification(options),
                      StartsWith("verify: no case is named like 'no such case'; there are: ") &&
                          Contains("'thick cylinder, plane strain', ") &&
                          Contains("'NAFEMS LE10'"));
}

TEST_CASE("run_verification: names of cases are unique", "[verification]") {
    std::set<std::string> names;
    for (const Case& one : all_cases()) {
        CHECK(names.insert(one.name).second);
    }
}

TEST_CASE("run_verification: every case holds", "[verification]") { check_all(run_verification()); }
