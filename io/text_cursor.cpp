#include "io/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace couture::io {

namespace {

bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

TextCursor::TextCursor(std::string file, std::string_view text, char comment,
                       std::string_view separators, int first_line)
    : file_(std::move(file)),
      text_(text),
      comment_(comment),
      separators_(separators),
      line_(first_line),
      word_line_(first_line) {}

bool TextCursor::is_separator(char c) const {
    return is_space(c) || separators_.find(c) != std::string::npos;
}

void TextCursor::skip() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (comment_ != 0 && c == comment_) {
            while (position_ < text_.size() && text_[position_] != '\n') {
                ++position_;
            }
        } else if (is_separator(c)) {
            line_ += c == '\n' ? 1 : 0;
            ++position_;
        } else {
            return;
        }
    }
}

bool TextCursor::at_end() {
    skip();
    return position_ >= text_.size();
}

std::string_view TextCursor::peek() {
    skip();
    std::size_t end = position_;
    while (end < text_.size() && !is_separator(text_[end])) {
        ++end;
    }
    return text_.substr(position_, end - position_);
}

std::string_view TextCursor::word(std::string_view what) {
    const std::string_view result = peek();
    word_line_ = line_;
    if (result.empty()) {
        fail("the file ends here; expected {}", what);
    }
    position_ += result.size();
    return result;
}

void TextCursor::expect(std::string_view keyword) {
    const std::string_view found = word(keyword);
    if (found != keyword) {
        fail("found {}; expected '{}'", in_quotes(found), keyword);
    }
}

double TextCursor::number(std::string_view what) {
    const std::string_view found = word(what);
    std::string_view digits = found;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') {
        digits.remove_prefix(1);
    }
    double value = 0.0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (code != std::errc() || end != digits.data() + digits.size()) {
        fail("found {}; expected a number: {}", in_quotes(found), what);
    }
    if (!std::isfinite(value)) {
        fail("found {}; expected a finite number: {}", in_quotes(found), what);
    }
    return value;
}

int TextCursor::integer(std::string_view what, int low, int high) {
    const std::string_view found = word(what);
    long value = 0;
    const auto [end, code] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (code != std::errc() || end != found.data() + found.size() || value < low || value > high) {
        fail("found {}; expected {}, a whole number from {} to {}", in_quotes(found), what, low,
             high);
    }
    return static_cast<int>(value);
}

std::vector<double> TextCursor::numbers(long count, std::string_view what) {
    // A number takes a digit and a blank at least.
    const auto left = static_cast<long>((text_.size() - position_ + 1) / 2);
    if (count > left) {
        word_line_ = line_;
        fail("the file holds at most {} more numbers; expected {}: {}", left, count, what);
    }
    std::vector<double> result;
    result.reserve(static_cast<std::size_t>(count));
    for (long i = 0; i < count; ++i) {
        result.push_back(number(what));
    }
    return result;
}

std::vector<double> TextCursor::all_numbers(std::string_view what) {
    std::vector<double> result;
    while (!at_end()) {
        result.push_back(number(what));
    }
    return result;
}

std::string_view TextCursor::rest_of_line() {
    std::size_t end = position_;
    while (end < text_.size() && text_[end] != '\n') {
        ++end;
    }
    std::string_view result = text_.substr(position_, end - position_);
    position_ = end;
    while (!result.empty() && is_space(result.front())) {
        result.remove_prefix(1);
    }
    while (!result.empty() && is_space(result.back())) {
        result.remove_suffix(1);
    }
    return result;
}

void TextCursor::expect_end(std::string_view what) {
    if (!at_end()) {
        const std::string_view found = word(what);
        fail("found {} after the last of {}; expected nothing more", in_quotes(found), what);
    }
}

std::string TextCursor::where() const { return fmt::format("{}:{}", file_, word_line_); }

std::string in_quotes(std::string_view word) {
    constexpr std::size_t longest = 40;
    std::string result(word.substr(0, longest));
    std::replace_if(
        result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return "'" + result + (word.size() > longest ? "..." : "") + "'";
}

std::string exact(double number) { return fmt::format("{}", number); }

}  // namespace couture::io
