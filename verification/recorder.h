#pragma once

#include <functional>
#include <string>
#include <vector>

#include "iga/core/timer.h"

namespace couture::verification {

/// One line of the table.
struct Row {
    std::string case_name;
    std::string quantity;
    double expected = 0.0;
    double obtained = 0.0;
    /// |obtained - expected|, over |expected| where `is_relative`.
    double error = 0.0;
    double bound = 0.0;
    bool is_relative = false;
    std::string source;
    bool passed = false;
    /// Since the row before it: rows read off one solution cost nothing but the first.
    double seconds = 0.0;
    /// What was thrown instead of a number.
    std::string failure;
    /// Why there is no number, where a case could not be tried on this machine; neither passed nor
    /// failed.
    std::string skipped;
};

/// Takes the rows of the cases as they are obtained.
class Recorder {
  public:
    /// @param on_row  called with every row; may be empty
    explicit Recorder(std::function<void(const Row&)> on_row = {});

    /// Rows from here on belong to this case. The source is a key of `REFERENCES.md`, or says what
    /// the expected values follow from.
    void start(const std::string& case_name);
    void set_source(const std::string& source) { source_ = source; }

    /// Passes if |obtained - expected| <= bound |expected|.
    void relative(const std::string& quantity, double expected, double obtained, double bound);
    /// Passes if |obtained - expected| <= bound.
    void absolute(const std::string& quantity, double expected, double obtained, double bound);
    /// A quantity that should be zero: passes if |obtained| <= bound.
    void vanishing(const std::string& quantity, double obtained, double bound);
    /// The case could not be finished.
    void failure(const std::string& message);
    /// The case can't be tried on this machine.
    void skip(const std::string& reason);

    [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

  private:
    void add(Row row);

    std::function<void(const Row&)> on_row_;
    std::vector<Row> rows_;
    std::string case_name_;
    std::string source_;
    Timer timer_;
    double last_time_ = 0.0;
};

}  // namespace couture::verification
