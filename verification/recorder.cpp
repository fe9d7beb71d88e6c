#include "verification/recorder.h"

#include <cmath>

namespace couture::verification {

Recorder::Recorder(std::function<void(const Row&)> on_row) : on_row_(std::move(on_row)) {}

void Recorder::start(const std::string& case_name) {
    case_name_ = case_name;
    source_.clear();
    last_time_ = timer_.seconds();
}

void Recorder::relative(const std::string& quantity, double expected, double obtained,
                        double bound) {
    Row row;
    row.quantity = quantity;
    row.expected = expected;
    row.obtained = obtained;
    row.error = std::abs(obtained - expected) / std::abs(expected);
    row.bound = bound;
    row.is_relative = true;
    row.passed = row.error <= bound;
    add(std::move(row));
}

void Recorder::absolute(const std::string& quantity, double expected, double obtained,
                        double bound) {
    Row row;
    row.quantity = quantity;
    row.expected = expected;
    row.obtained = obtained;
    row.error = std::abs(obtained - expected);
    row.bound = bound;
    row.passed = row.error <= bound;
    add(std::move(row));
}

void Recorder::vanishing(const std::string& quantity, double obtained, double bound) {
    absolute(quantity, 0.0, obtained, bound);
}

void Recorder::failure(const std::string& message) {
    Row row;
    row.quantity = "stopped";
    row.failure = message;
    add(std::move(row));
}

void Recorder::skip(const std::string& reason) {
    Row row;
    row.quantity = "skipped";
    row.skipped = reason;
    add(std::move(row));
}

void Recorder::add(Row row) {
    const double now = timer_.seconds();
    row.seconds = now - last_time_;
    last_time_ = now;
    row.case_name = case_name_;
    row.source = source_;
    rows_.push_back(std::move(row));
    if (on_row_) {
        on_row_(rows_.back());
    }
}

}  // namespace couture::verification
