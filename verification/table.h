#pragma once

#include <string>

#include "verification/verification.h"

namespace couture::verification {

/// The table's head, one line and a rule below it.
[[nodiscard]] std::string table_head();
/// One line of the table: case, quantity, expected, obtained, error (% where relative), bound,
/// pass or FAIL, seconds, source.
[[nodiscard]] std::string table_line(const Row& row);
/// "94 rows, 0 failed, 61.2 s", and how many were skipped if any.
[[nodiscard]] std::string table_foot(const VerificationReport& report);
/// All rows as one JSON object.
[[nodiscard]] std::string to_json(const VerificationReport& report);

}  // namespace couture::verification
