#pragma once

#include <array>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "iga/core/function.h"
#include "iga/mechanics/problem.h"
#include "io/toml_node.h"
#include "io/units.h"

namespace couture::io {

/// What is wrong with a deck, gathered so that all of it is shown at once.
class Mistakes {
  public:
    void add(const TomlPlace& place, const std::string& message);
    /// @throws InputError  with all messages, in order of lines, if there are any
    void throw_if_any() const;

  private:
    std::vector<std::pair<int, std::string>> messages_;
};

/// Values that a key accepts; bounds belong to it unless the flag says otherwise.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool is_open = false;

    [[nodiscard]] bool contains(double value) const;
    /// "> 0", ">= 1", "in (-1, 0.5)", ...
    [[nodiscard]] std::string rule() const;
};
constexpr Range any_number{};
constexpr Range positive{.low = 0.0, .is_open = true};
constexpr Range not_negative{.low = 0.0};

/// What all sections of a deck share while it is read.
struct DeckContext {
    Mistakes mistakes;
    UnitSystem units;
    /// Displacements have no z.
    bool is_plane = false;
    /// The materials are: loads follow time.
    bool is_hyperelastic = false;
    std::vector<iga::Amplitude> amplitudes;
    std::set<std::string> used_amplitudes;
    /// [discretization] says volumetric = "full".
    bool is_integrated_in_full = false;
    /// Some load grows linearly until the end.
    bool has_ramp = false;
    /// Values that name t: where, and what they are.
    std::vector<std::pair<TomlPlace, std::string>> uses_of_time;
};

/// One table of a deck while it is read. Every reader notes the key as known; `finish` reports the
/// keys that nothing asked for. A wrong value is noted in the context's mistakes and read as
/// missing.
class Section {
  public:
    /// @param title  "[material.steel]", "[[pressure]]"; empty for the top of the deck
    Section(const TomlNode& table, std::string title, DeckContext& context);

    [[nodiscard]] const std::string& title() const { return title_; }
    [[nodiscard]] const TomlPlace& place() const { return table_->place; }
    [[nodiscard]] const TomlNode& table() const { return *table_; }
    [[nodiscard]] DeckContext& context() const { return *context_; }

    /// The value, or null. Notes the key as known.
    [[nodiscard]] const TomlNode* find(const std::string& key);
    [[nodiscard]] bool has(const std::string& key);
    /// As `find`; notes a mistake if it is missing.
    const TomlNode* require(const std::string& key, const std::string& meaning);

    [[nodiscard]] std::optional<bool> flag(const std::string& key);
    [[nodiscard]] std::optional<int> integer(const std::string& key, int low, int high);
    [[nodiscard]] std::optional<std::string> text(const std::string& key);
    /// One of `names`.
    [[nodiscard]] std::optional<std::string> choice(const std::string& key,
                                                    const std::vector<std::string>& names);
    /// One text or a list of texts.
    [[nodiscard]] std::vector<std::string> texts(const std::string& key);
    /// The names under 'on', which must be there, each once.
    [[nodiscard]] std::vector<std::string> sets();
    /// The patch numbers under 'patches', each once; empty if there are none.
    [[nodiscard]] std::vector<int> patches();
    /// The name under 'case', or "".
    [[nodiscard]] std::string load_case();
    /// One whole number or a list of them, each at least `low`.
    [[nodiscard]] std::vector<int> integers(const std::string& key, int low);
    /// A number, a text with a unit, or a constant expression.
    [[nodiscard]] std::optional<double> number(const std::string& key, const Dimension& dimension,
                                               const Range& range = any_number);
    /// An angle in radians: a number is in degrees, a text has its unit.
    ///
    /// @param degrees  where it must lie
    [[nodiscard]] std::optional<double> angle(const std::string& key, const Range& degrees);
    /// A list of numbers; its length must be one of `sizes`.
    [[nodiscard]] std::vector<double> numbers(const std::string& key, const Dimension& dimension,
                                              const std::vector<int>& sizes,
                                              const Range& range = any_number);
    /// The same, of any length but 0.
    [[nodiscard]] std::vector<double> number_list(const std::string& key,
                                                  const Dimension& dimension,
                                                  const Range& range = any_number);
    /// A number, a text with a unit or an expression of x, y, z, t.
    [[nodiscard]] std::optional<Function> function(const std::string& key,
                                                   const Dimension& dimension);
    /// Components: the list under `key`, or the keys x, y, z.
    [[nodiscard]] std::array<std::optional<Function>, 3> components(const std::string& key,
                                                                    const Dimension& dimension);
    /// Three numbers (two: the third is 0).
    [[nodiscard]] std::optional<Vector3> vector(const std::string& key, const Dimension& dimension);

    /// An expression read so far names t.
    [[nodiscard]] bool names_time() const { return names_time_; }

    /// Notes a mistake if the body is plane and `key` says something of z.
    void refuse_third(const std::string& key, bool is_given);

    /// Notes a mistake at a key, or at the section if the key is missing.
    void mistake(const std::string& key, const std::string& message);
    /// Reports unknown keys.
    void finish();

  private:
    [[nodiscard]] std::optional<double> to_number(const TomlNode& node, const std::string& key,
                                                  const Dimension& dimension, const Range& range);
    [[nodiscard]] std::optional<Function> to_function(const TomlNode& node, const std::string& key,
                                                      const Dimension& dimension);
    void wrong_kind(const TomlNode& node, const std::string& key, const std::string& expected);
    /// "key 'value' of [[pressure]]".
    [[nodiscard]] std::string name_of(const std::string& key) const;

    const TomlNode* table_;
    std::string title_;
    DeckContext* context_;
    std::set<std::string> known_;
    bool names_time_ = false;
};

}  // namespace couture::io
