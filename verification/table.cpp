#include "verification/table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace couture::verification {

std::string table_head() {
    return fmt::format("{:<34} {:<36} {:>13} {:>13} {:>10} {:>10} {:<4} {:>7}  {}\n{:-<160}",
                       "case", "quantity", "expected", "obtained", "error", "bound", "", "seconds",
                       "source", "");
}

std::string table_line(const Row& row) {
    if (!row.failure.empty()) {
        return fmt::format("{:<34} FAIL {}", row.case_name, row.failure);
    }
    if (!row.skipped.empty()) {
        return fmt::format("{:<34} skipped: {}", row.case_name, row.skipped);
    }
    const char* of = row.is_relative ? "r" : " ";
    return fmt::format("{:<34} {:<36} {:>13.7g} {:>13.7g} {:>9.2e}{} {:>9.1e}{} {:<4} {:>7.2f}  {}",
                       row.case_name, row.quantity, row.expected, row.obtained, row.error, of,
                       row.bound, of, row.passed ? "pass" : "FAIL", row.seconds, row.source);
}

std::string table_foot(const VerificationReport& report) {
    const int n_skipped = report.n_skipped();
    return fmt::format("{} rows, {} failed, {}{:.1f} s (r: relative to the expected value)",
                       report.rows.size(), report.n_failed(),
                       n_skipped > 0 ? fmt::format("{} skipped, ", n_skipped) : "", report.seconds);
}

std::string to_json(const VerificationReport& report) {
    nlohmann::ordered_json json;
    json["passed"] = report.n_failed() == 0;
    json["n_rows"] = report.rows.size();
    json["n_failed"] = report.n_failed();
    json["n_skipped"] = report.n_skipped();
    json["seconds"] = report.seconds;
    json["rows"] = nlohmann::ordered_json::array();
    for (const Row& row : report.rows) {
        nlohmann::ordered_json line;
        line["case"] = row.case_name;
        line["quantity"] = row.quantity;
        line["expected"] = row.expected;
        line["obtained"] = row.obtained;
        line["error"] = row.error;
        line["is_relative"] = row.is_relative;
        line["bound"] = row.bound;
        line["source"] = row.source;
        line["passed"] = row.passed;
        line["seconds"] = row.seconds;
        if (!row.failure.empty()) {
            line["failure"] = row.failure;
        }
        if (!row.skipped.empty()) {
            line["skipped"] = row.skipped;
        }
        json["rows"].push_back(std::move(line));
    }
    return json.dump(2) + "\n";
}

}  // namespace couture::verification
