#include "verification/recorder.h"

#include <catch2/catch.hpp>
#include <limits>

#include "verification/table.h"

using namespace couture::verification;
using Catch::Matchers::Contains;

TEST_CASE("Recorder: rows pass within their bound and provably not beyond", "[verification]") {
    Recorder recorder;
    recorder.start("case");
    recorder.relative("inside", 200.0, 200.9, 0.005);
    recorder.relative("outside", 200.0, 201.1, 0.005);
    recorder.relative("of a negative number", -2.0, -2.1, 0.06);
    recorder.absolute("inside", 2.0, 2.09, 0.1);
    recorder.absolute("outside", 2.0, 1.89, 0.1);
    recorder.vanishing("inside", -1e-13, 1e-12);
    recorder.vanishing("outside", -1e-11, 1e-12);
    recorder.vanishing("no number", std::numeric_limits<double>::quiet_NaN(), 1e-12);
    recorder.failure("folded");
    std::vector<bool> passed;
    for (const Row& row : recorder.rows()) {
        passed.push_back(row.passed);
    }
    CHECK(passed == std::vector<bool>{true, false, true, true, false, true, false, false, false});
    CHECK(recorder.rows()[0].error == Approx(0.0045));
    CHECK(recorder.rows()[8].failure == "folded");
}

TEST_CASE("Recorder: rows carry case and source and are handed on at once", "[verification]") {
    std::vector<Row> seen;
    Recorder recorder([&](const Row& row) { seen.push_back(row); });
    recorder.start("first");
    recorder.set_source("closed form");
    recorder.vanishing("a", 0.0, 0.0);
    recorder.start("second");
    recorder.vanishing("b", 0.0, 0.0);
    REQUIRE(seen.size() == 2);
    CHECK(seen[0].case_name == "first");
    CHECK(seen[0].source == "closed form");
    CHECK(seen[1].case_name == "second");
    CHECK(seen[1].source.empty());
}

TEST_CASE("Recorder: what can't be tried is neither passed nor failed", "[verification]") {
    Recorder recorder;
    recorder.start("other program");
    recorder.skip("it is not installed");
    recorder.vanishing("inside", 0.0, 1e-12);
    const VerificationReport report{recorder.rows(), 1.5};
    CHECK_FALSE(recorder.rows()[0].passed);
    CHECK(report.n_failed() == 0);
    CHECK(report.n_skipped() == 1);
    CHECK_THAT(table_line(recorder.rows()[0]),
               Contains("other program") && Contains("skipped: it is not installed"));
    CHECK(table_foot(report) ==
          "2 rows, 0 failed, 1 skipped, 1.5 s (r: relative to the expected value)");
    CHECK_THAT(to_json(report),
               Contains("\"n_skipped\": 1") && Contains("\"skipped\": \"it is not installed\""));
}

TEST_CASE("table: a line says what was expected, obtained and whether it holds", "[verification]") {
    Recorder recorder;
    recorder.start("thick cylinder");
    recorder.set_source("closed form");
    recorder.relative("widening", 2.0, 2.5, 0.1);
    recorder.failure("the body is not held");
    const std::string line = table_line(recorder.rows()[0]);
    CHECK_THAT(line, Contains("thick cylinder") && Contains("widening") && Contains("2.5") &&
                         Contains("2.50e-01r") && Contains("FAIL") && Contains("closed form"));
    CHECK_THAT(table_line(recorder.rows()[1]), Contains("FAIL the body is not held"));
    const VerificationReport report{recorder.rows(), 1.5};
    CHECK(table_foot(report) == "2 rows, 2 failed, 1.5 s (r: relative to the expected value)");
    const std::string json = to_json(report);
    CHECK_THAT(json, Contains("\"passed\": false") && Contains("\"n_failed\": 2") &&
                         Contains("\"obtained\": 2.5") &&
                         Contains("\"failure\": \"the body is not held\""));
}
