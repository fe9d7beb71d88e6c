#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace couture::io {

/// Where a value of a deck was written.
struct TomlPlace {
    /// "bracket.toml:14", or "--set solver.tolerance=1" for an override.
    std::string source;
    /// The line's number, 0 for an override.
    int line = 0;
    /// The line, and the value's place in it (0-based).
    std::string text;
    int column = 0;
    int length = 1;
};

/// `message` under its source, with the line and a caret below it:
/// ```
/// bracket.toml:14: message
///    14 | poissons_ratio = 0.7
///       |                  ^~~
/// ```
[[nodiscard]] std::string located(const TomlPlace& place, const std::string& message);

/// One value of a TOML document and all below it.
struct TomlNode {
    enum class Kind { boolean, integer, number, text, date, array, table };

    Kind kind = Kind::table;
    TomlPlace place;
    bool boolean = false;
    std::int64_t integer = 0;
    /// Also set for integers.
    double number = 0.0;
    std::string text;
    std::vector<TomlNode> items;
    /// In the order of the file.
    std::vector<std::pair<std::string, TomlNode>> entries;

    [[nodiscard]] bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
    /// The entry of a table, or null.
    [[nodiscard]] const TomlNode* find(const std::string& key) const;
    [[nodiscard]] TomlNode* find(const std::string& key);
    /// "a number", "a text", "a list", "a section", ...
    [[nodiscard]] std::string kind_name() const;
};

}  // namespace couture::io
