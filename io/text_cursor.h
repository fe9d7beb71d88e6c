#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "iga/core/error.h"

namespace couture::io {

/// Reads words and numbers of a text one after the other and knows the line of the last one.
/// Nothing is allocated on the word of the text alone: counts are compared with what is left of it.
class TextCursor {
  public:
    /// @param file  name for messages
    /// @param comment  character after which the rest of a line is skipped, or 0
    /// @param separators  what parts words besides white space
    TextCursor(std::string file, std::string_view text, char comment = '#',
               std::string_view separators = {}, int first_line = 1);

    [[nodiscard]] bool at_end();
    /// The next word without taking it; empty at the end.
    [[nodiscard]] std::string_view peek();
    /// Takes the next word. @throws FileError  at the end: names `what` was expected
    std::string_view word(std::string_view what);
    /// Takes a word that must be `keyword`.
    void expect(std::string_view keyword);
    /// Takes a finite number.
    double number(std::string_view what);
    /// Takes a whole number in [low, high].
    int integer(std::string_view what, int low, int high);
    /// Takes `count` numbers.
    std::vector<double> numbers(long count, std::string_view what);
    /// Takes all numbers up to the end.
    std::vector<double> all_numbers(std::string_view what);
    /// What is left of the line of the last word, without white space around it.
    std::string_view rest_of_line();
    /// @throws FileError  if something is left
    void expect_end(std::string_view what);

    /// "file:line" of the last word.
    [[nodiscard]] std::string where() const;
    [[nodiscard]] const std::string& file() const { return file_; }
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        throw FileError("{}: {}", where(), fmt::format(format, std::forward<Args>(args)...));
    }

  private:
    void skip();
    [[nodiscard]] bool is_separator(char c) const;

    std::string file_;
    std::string_view text_;
    std::size_t position_ = 0;
    char comment_;
    std::string separators_;
    int line_;
    int word_line_;
};

/// The word in quotes, cut where it is long, with unprintable characters replaced: for messages.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Shortest text that is read back as the same number.
[[nodiscard]] std::string exact(double number);

}  // namespace couture::io
