#include "io/deck_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "io/did_you_mean.h"
#include "io/expression.h"

namespace couture::io {

void Mistakes::add(const TomlPlace& place, const std::string& message) {
    messages_.emplace_back(place.line, located(place, message));
}

void Mistakes::throw_if_any() const {
    if (messages_.empty()) {
        return;
    }
    auto sorted = messages_;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string all;
    for (const auto& [line, message] : sorted) {
        all += (all.empty() ? "" : "\n") + message;
    }
    throw InputError("{}", all);
}

bool Range::contains(double value) const {
    return is_open ? value > low && value < high : value >= low && value <= high;
}

std::string Range::rule() const {
    const bool has_low = std::isfinite(low);
    const bool has_high = std::isfinite(high);
    if (has_low && has_high) {
        return fmt::format(fmt::runtime(is_open ? "in ({}, {})" : "in [{}, {}]"), low, high);
    }
    if (has_low) {
        return fmt::format("{} {}", is_open ? ">" : ">=", low);
    }
    return fmt::format("{} {}", is_open ? "<" : "<=", high);
}

Section::Section(const TomlNode& table, std::string title, DeckContext& context)
    : table_(&table), title_(std::move(title)), context_(&context) {}

std::string Section::name_of(const std::string& key) const {
    return title_.empty() ? fmt::format("'{}'", key) : fmt::format("'{}' of {}", key, title_);
}

const TomlNode* Section::find(const std::string& key) {
    known_.insert(key);
    return table_->find(key);
}

bool Section::has(const std::string& key) { return find(key) != nullptr; }

const TomlNode* Section::require(const std::string& key, const std::string& meaning) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        context_->mistakes.add(
            place(),
            fmt::format("{} needs '{}' ({})", title_.empty() ? "the deck" : title_, key, meaning));
    }
    return node;
}

void Section::mistake(const std::string& key, const std::string& message) {
    const TomlNode* node = table_->find(key);
    context_->mistakes.add(node != nullptr ? node->place : place(), message);
}

void Section::wrong_kind(const TomlNode& node, const std::string& key,
                         const std::string& expected) {
    context_->mistakes.add(
        node.place, fmt::format("{} is {}, expected {}", name_of(key), node.kind_name(), expected));
}

std::optional<bool> Section::flag(const std::string& key) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    if (node->kind != TomlNode::Kind::boolean) {
        wrong_kind(*node, key, "true or false");
        return {};
    }
    return node->boolean;
}

std::optional<int> Section::integer(const std::string& key, int low, int high) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    if (node->kind != TomlNode::Kind::integer) {
        wrong_kind(*node, key, "a whole number");
        return {};
    }
    if (node->integer < low || node->integer > high) {
        context_->mistakes.add(node->place, fmt::format("{} = {} is out of range; it must be in "
                                                        "[{}, {}]",
                                                        name_of(key), node->integer, low, high));
        return {};
    }
    return static_cast<int>(node->integer);
}

std::vector<int> Section::integers(const std::string& key, int low) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    const std::vector<TomlNode> items =
        node->kind == TomlNode::Kind::array ? node->items : std::vector<TomlNode>{*node};
    std::vector<int> result;
    for (const TomlNode& item : items) {
        if (item.kind != TomlNode::Kind::integer) {
            wrong_kind(item, key, "a whole number or a list of them");
        } else if (item.integer < low || item.integer > std::numeric_limits<int>::max()) {
            context_->mistakes.add(
                item.place, fmt::format("{} = {} is out of range; it must be >= {}", name_of(key),
                                        item.integer, low));
        } else {
            result.push_back(static_cast<int>(item.integer));
        }
    }
    return result;
}

std::optional<std::string> Section::text(const std::string& key) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    if (node->kind != TomlNode::Kind::text) {
        wrong_kind(*node, key, "a text");
        return {};
    }
    return node->text;
}

std::optional<std::string> Section::choice(const std::string& key,
                                           const std::vector<std::string>& names) {
    std::optional<std::string> chosen = text(key);
    if (chosen && std::find(names.begin(), names.end(), *chosen) == names.end()) {
        const std::string suggestion = did_you_mean(*chosen, names);
        mistake(key, fmt::format("unknown {} '{}'{}{}", key, *chosen,
                                 suggestion.empty() ? "; there are " : suggestion,
                                 suggestion.empty() ? quoted_list(names)
                                                    : " (" + quoted_list(names) + ")"));
        return {};
    }
    return chosen;
}

std::vector<std::string> Section::sets() {
    require("on", "the name of a boundary set, or a list of names");
    std::vector<std::string> names = texts("on");
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (std::find(names.begin(), names.begin() + i, names[i]) != names.begin() + i) {
            mistake("on",
                    fmt::format("'on' of {} names '{}' twice; once is enough", title_, names[i]));
        }
    }
    return names;
}

std::vector<int> Section::patches() {
    std::vector<int> numbers = integers("patches", 0);
    std::vector<int> sorted = numbers;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) {
        mistake("patches", fmt::format("'patches' of {} names patch {} twice; once is enough",
                                       title_, *twice));
    }
    return numbers;
}

std::string Section::load_case() {
    const std::string name = text("case").value_or("");
    if (context_->is_hyperelastic && has("case")) {
        mistake("case", fmt::format("'case' of {}: hyperelastic bodies are loaded along one path "
                                    "in time, without load cases; give the load an 'amplitude'",
                                    title_));
        return "";
    }
    // Results are files named after their load case.
    const bool has_bad = std::any_of(name.begin(), name.end(), [](unsigned char c) {
        return c == '/' || c == '\\' || std::iscntrl(c) != 0;
    });
    if (has_bad || (has("case") && (name.empty() || name.front() == '.'))) {
        mistake("case",
                fmt::format("case '{}' of {} can't name a result file; take letters, digits, "
                            "spaces, '-' and '_'",
                            name, title_));
        return "";
    }
    return name;
}

std::vector<std::string> Section::texts(const std::string& key) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    if (node->kind == TomlNode::Kind::text) {
        return {node->text};
    }
    std::vector<std::string> result;
    if (node->kind != TomlNode::Kind::array || node->items.empty()) {
        wrong_kind(*node, key, "a text or a list of texts");
        return {};
    }
    for (const TomlNode& item : node->items) {
        if (item.kind == TomlNode::Kind::text) {
            result.push_back(item.text);
        } else {
            wrong_kind(item, key, "a text");
        }
    }
    return result;
}

std::optional<double> Section::to_number(const TomlNode& node, const std::string& key,
                                         const Dimension& dimension, const Range& range) {
    double value = node.number;
    if (node.kind == TomlNode::Kind::text) {
        try {
            if (looks_like_quantity(node.text)) {
                value = parse_quantity(node.text, dimension, context_->units);
            } else {
                const Expression expression(node.text);
                if (!expression.variables().empty()) {
                    context_->mistakes.add(
                        node.place,
                        fmt::format("{} must be constant; '{}' depends on {}", name_of(key),
                                    node.text, fmt::join(expression.variables(), ", ")));
                    return {};
                }
                value = expression(Vector3::Zero(), 0.0);
            }
        } catch (const InputError& error) {
            context_->mistakes.add(node.place, fmt::format("{}: {}", name_of(key), error.what()));
            return {};
        }
    } else if (!node.is_number()) {
        wrong_kind(node, key, "a number or a text with a unit");
        return {};
    }
    if (!std::isfinite(value)) {
        context_->mistakes.add(node.place,
                               fmt::format("{} = {}; it must be finite", name_of(key), value));
        return {};
    }
    if (!range.contains(value)) {
        context_->mistakes.add(node.place, fmt::format("{} = {} is out of range; it must be {}",
                                                       name_of(key), value, range.rule()));
        return {};
    }
    return value;
}

std::optional<double> Section::number(const std::string& key, const Dimension& dimension,
                                      const Range& range) {
    const TomlNode* node = find(key);
    return node != nullptr ? to_number(*node, key, dimension, range) : std::nullopt;
}

std::optional<double> Section::angle(const std::string& key, const Range& degrees) {
    constexpr double degree = std::numbers::pi / 180.0;
    const TomlNode* node = find(key);
    if (node == nullptr) return {};
    const bool has_unit = node->kind == TomlNode::Kind::text && looks_like_quantity(node->text);
    const auto value = to_number(*node, key, dimensions::none, has_unit ? any_number : degrees);
    if (!value) return {};
    const double in_degrees = has_unit ? *value / degree : *value;
    if (!degrees.contains(in_degrees)) {
        mistake(key, fmt::format("{} = {} degrees is out of range; it must be {}", name_of(key),
                                 in_degrees, degrees.rule()));
        return {};
    }
    return in_degrees * degree;
}

std::vector<double> Section::numbers(const std::string& key, const Dimension& dimension,
                                     const std::vector<int>& sizes, const Range& range) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    const auto size = static_cast<int>(node->items.size());
    if (node->kind != TomlNode::Kind::array ||
        std::find(sizes.begin(), sizes.end(), size) == sizes.end()) {
        context_->mistakes.add(
            node->place,
            fmt::format("{} is {}, expected a list of {} numbers", name_of(key),
                        node->kind == TomlNode::Kind::array ? fmt::format("a list of {}", size)
                                                            : node->kind_name(),
                        fmt::join(sizes, " or ")));
        return {};
    }
    std::vector<double> result;
    for (const TomlNode& item : node->items) {
        result.push_back(to_number(item, key, dimension, range).value_or(0.0));
    }
    return result;
}

std::vector<double> Section::number_list(const std::string& key, const Dimension& dimension,
                                         const Range& range) {
    const TomlNode* node = find(key);
    if (node == nullptr) {
        return {};
    }
    if (node->kind != TomlNode::Kind::array || node->items.empty()) {
        wrong_kind(*node, key, "a list of numbers");
        return {};
    }
    return numbers(key, dimension, {static_cast<int>(node->items.size())}, range);
}

std::optional<Function> Section::to_function(const TomlNode& node, const std::string& key,
                                             const Dimension& dimension) {
    if (node.kind == TomlNode::Kind::text && !looks_like_quantity(node.text)) {
        try {
            Expression expression(node.text);
            const std::vector<std::string>& names = expression.variables();
            if (!names.empty()) {
                if (std::find(names.begin(), names.end(), "t") != names.end()) {
                    names_time_ = true;
                    context_->uses_of_time.emplace_back(node.place, name_of(key));
                }
                // What goes wrong at some point later still names the place in the deck.
                return Function([expression = std::move(expression),
                                 where = fmt::format("{}: {}", node.place.source, name_of(key))](
                                    const Vector3& x, double t) {
                    try {
                        return expression(x, t);
                    } catch (const InputError& error) {
                        throw InputError("{}: {}", where, error.what());
                    }
                });
            }
        } catch (const InputError& error) {
            context_->mistakes.add(node.place, fmt::format("{}: {}", name_of(key), error.what()));
            return {};
        }
    }
    const std::optional<double> value = to_number(node, key, dimension, any_number);
    return value ? std::optional<Function>(constant(*value)) : std::nullopt;
}

std::optional<Function> Section::function(const std::string& key, const Dimension& dimension) {
    const TomlNode* node = find(key);
    return node != nullptr ? to_function(*node, key, dimension) : std::nullopt;
}

std::array<std::optional<Function>, 3> Section::components(const std::string& key,
                                                           const Dimension& dimension) {
    const std::array<std::string, 3> axes = {"x", "y", "z"};
    std::array<std::optional<Function>, 3> result;
    const TomlNode* list = find(key);
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = function(axes[i], dimension);
        if (list != nullptr && has(axes[i])) {
            mistake(axes[i], fmt::format("{} has both '{}' and '{}'; give one of them", title_, key,
                                         axes[i]));
        }
    }
    if (list == nullptr) {
        refuse_third("z", result[2].has_value());
        return result;
    }
    const std::size_t size = list->items.size();
    if (list->kind != TomlNode::Kind::array || size < 2 || size > 3) {
        wrong_kind(*list, key, "a list of 2 or 3 components");
        return result;
    }
    for (std::size_t i = 0; i < size; ++i) {
        result[i] = to_function(list->items[i], key, dimension);
    }
    if (context_->is_plane && size == 3 && list->items[2].number == 0.0 &&
        list->items[2].is_number()) {
        result[2].reset();
    }
    refuse_third(key, result[2].has_value());
    return result;
}

void Section::refuse_third(const std::string& key, bool is_given) {
    if (context_->is_plane && is_given) {
        mistake(key,
                fmt::format("{} has a z component; a plane body has x and y only, leave it out",
                            title_));
    }
}

std::optional<Vector3> Section::vector(const std::string& key, const Dimension& dimension) {
    const std::vector<double> values = numbers(key, dimension, {2, 3});
    if (values.empty()) {
        return {};
    }
    return Vector3(values[0], values[1], values.size() > 2 ? values[2] : 0.0);
}

void Section::finish() {
    const std::vector<std::string> candidates(known_.begin(), known_.end());
    for (const auto& [key, node] : table_->entries) {
        if (known_.count(key) != 0) {
            continue;
        }
        TomlPlace place = node.place;
        const std::size_t column = place.text.find(key);
        if (column != std::string::npos) {
            place.column = static_cast<int>(column);
            place.length = static_cast<int>(key.size());
        }
        const std::string where =
            title_.empty() ? "at the top of the deck" : fmt::format("in {}", title_);
        std::string help = did_you_mean(key, candidates);
        if (help.empty()) {
            help = fmt::format("; there are {}", quoted_list(candidates));
        }
        const bool is_section =
            node.kind == TomlNode::Kind::table ||
            (!node.items.empty() && node.items[0].kind == TomlNode::Kind::table && title_.empty());
        context_->mistakes.add(
            place,
            fmt::format("unknown {} '{}' {}{}", is_section ? "section" : "key", key, where, help));
    }
}

}  // namespace couture::io
