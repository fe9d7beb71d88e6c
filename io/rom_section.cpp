#include "io/rom_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/deck_readers.h"
#include "io/did_you_mean.h"

namespace couture::io {

namespace {

constexpr const char* geometry_prefix = "geometry.parameters.";

std::optional<rom::ParameterGroup> group_of(const std::string& key) {
    static const std::vector<std::string> loads = {"pressure",   "traction",   "body_force",
                                                   "point_load", "resultant",  "displacement",
                                                   "amplitude",  "temperature"};
    const std::string section = key.substr(0, key.find('.'));
    if (key.starts_with(geometry_prefix)) return rom::ParameterGroup::geometry;
    if (section == "material" || section == "foundation") return rom::ParameterGroup::material;
    if (std::find(loads.begin(), loads.end(), section) != loads.end()) {
        return rom::ParameterGroup::load;
    }
    return {};
}

// The value that a key names, or null.
const TomlNode* find_value(const TomlNode& document, const std::string& key) {
    const TomlNode* node = &document;
    for (std::size_t begin = 0; begin <= key.size() && node != nullptr;) {
        const std::size_t end = std::min(key.find('.', begin), key.size());
        const std::string part = key.substr(begin, end - begin);
        begin = end + 1;
        if (node->kind == TomlNode::Kind::array) {
            const bool is_index = !part.empty() && part.size() < 6 &&
                                  std::all_of(part.begin(), part.end(),
                                              [](unsigned char c) { return std::isdigit(c) != 0; });
            const std::size_t index = is_index ? std::stoul(part) : node->items.size();
            node = index < node->items.size() ? &node->items[index] : nullptr;
        } else {
            node = node->kind == TomlNode::Kind::table ? node->find(part) : nullptr;
        }
    }
    return node;
}

// @param is_listed  parameters without a key are columns of a table of members
void read_keys(Section& section, const TomlNode& document, bool is_listed, RomParameter& result) {
    result.keys = section.texts("key");
    if (result.keys.empty() && is_listed) {
        if (!section.has("name")) {
            section.mistake("name",
                            "[[rom.parameter]] needs 'key', the value of the deck that it is, or "
                            "'name', a column of 'members' of [rom]");
        }
        return;
    }
    if (result.keys.empty()) {
        section.mistake("key",
                        "[[rom.parameter]] needs 'key', the value of the deck that it is, as for "
                        "--set: \"geometry.parameters.R1\", \"resultant.0.force.1\", "
                        "\"material.steel.poissons_ratio\"");
        return;
    }
    std::optional<rom::ParameterGroup> group;
    for (const std::string& key : result.keys) {
        const auto found = group_of(key);
        if (!found) {
            section.mistake("key", fmt::format("'{}' is neither below geometry.parameters nor in a "
                                               "section of a material, load or displacement",
                                               key));
            return;
        }
        if (group && *group != *found) {
            section.mistake("key",
                            fmt::format("'{}' and '{}' belong to different groups (geometry, "
                                        "loads, materials); take two parameters",
                                        result.keys.front(), key));
            return;
        }
        group = found;
        const TomlNode* value = find_value(document, key);
        if (value == nullptr && *group != rom::ParameterGroup::geometry) {
            section.mistake("key", fmt::format("'{}' names nothing in this deck; sections that "
                                               "occur several times count from 0",
                                               key));
        } else if (value != nullptr && !value->is_number() && value->kind != TomlNode::Kind::text) {
            section.mistake("key", fmt::format("'{}' is {}; a parameter is a number: name one of "
                                               "its entries",
                                               key, value->kind_name()));
        }
    }
    result.parameter.group = *group;
}

RomParameter read_parameter(Section& section, const TomlNode& document, bool is_listed) {
    RomParameter result;
    result.source = section.place().source;
    read_keys(section, document, is_listed, result);
    const std::string key = result.keys.empty() ? "" : result.keys.front();
    result.parameter.name = section.text("name").value_or(key.substr(key.rfind('.') + 1));
    if (result.parameter.name.find_first_of("= ") != std::string::npos) {
        section.mistake("name", fmt::format("'{}' can't be a name in --set NAME=VALUE: it holds a "
                                            "space or '='",
                                            result.parameter.name));
    }
    result.parameter.unit = section.text("unit").value_or("");
    if (!result.parameter.unit.empty()) {
        try {
            static_cast<void>(parse_unit(result.parameter.unit));
        } catch (const std::exception& error) {
            section.mistake("unit", error.what());
        }
    }
    const auto range = section.numbers("range", dimensions::none, {2});
    if (range.size() == 2) {
        result.parameter.lower = range[0];
        result.parameter.upper = range[1];
        if (!(range[0] < range[1])) {
            section.mistake("range", fmt::format("[{}, {}] is empty; write the lower end first",
                                                 range[0], range[1]));
        }
    } else if (!section.has("range")) {
        section.mistake("range", "[[rom.parameter]] needs 'range', a list of both ends in 'unit'");
    }
    constexpr int most_levels = 1000;
    if (section.has("levels") && result.parameter.group == rom::ParameterGroup::geometry) {
        section.mistake("levels",
                        "'levels' are of loads and materials; geometry has 'design' of [rom]");
    }
    result.n_levels = section.integer("levels", 2, most_levels).value_or(result.n_levels);
    result.is_factored = section.flag("factored").value_or(false);
    if (result.is_factored && result.parameter.group == rom::ParameterGroup::geometry) {
        section.mistake("factored", "no displacement is proportional to a geometric parameter");
    }
    result.parameter.is_periodic = section.flag("periodic").value_or(false);
    if (result.parameter.is_periodic && result.parameter.group != rom::ParameterGroup::geometry) {
        section.mistake("periodic", "only parameters of the geometry can be periodic");
    }
    if (result.is_factored && section.has("levels")) {
        section.mistake("levels", "one solution serves all values of what is 'factored'");
    }
    if (result.is_factored && result.parameter.lower <= 0.0 && result.parameter.upper >= 0.0) {
        section.mistake("range", "the range of what is 'factored' must not hold 0");
    }
    return result;
}

void read_lists(Section& section, const std::filesystem::path& folder, RomSection& result) {
    const bool is_list = result.design == GeometryDesign::list;
    for (const auto& [key, path] :
         {std::pair{"members", &result.members}, std::pair{"validation", &result.validation}}) {
        const auto file = section.text(key);
        if (!file) continue;
        *path = folder / *file;
        if (!is_list) section.mistake(key, fmt::format("'{}' is of design = \"list\"", key));
    }
    if (is_list && result.members.empty()) {
        section.mistake("design",
                        "design = \"list\" needs 'members', a table (.csv) with a column for each "
                        "geometric parameter");
    }
}

void read_design(Section& section, const std::filesystem::path& folder, RomSection& result) {
    static const std::vector<std::string> names = {"star", "full",    "random",          "sobol",
                                                   "lhs",  "smolyak", "clenshaw_curtis", "list"};
    const std::string name = section.choice("design", names).value_or("star");
    result.design =
        static_cast<GeometryDesign>(std::find(names.begin(), names.end(), name) - names.begin());
    const bool has_level = result.design == GeometryDesign::star ||
                           result.design == GeometryDesign::smolyak ||
                           result.design == GeometryDesign::clenshaw_curtis;
    const bool has_samples = !has_level && result.design != GeometryDesign::list;
    read_lists(section, folder, result);
    constexpr int most_levels = 8;
    constexpr int most_samples = 1'000'000;
    result.level =
        section.integer("level", 1, result.design == GeometryDesign::star ? 2 : most_levels)
            .value_or(1);
    result.n_samples = section.integer("samples", 1, most_samples).value_or(0);
    if (!has_level && section.has("level")) {
        section.mistake("level", fmt::format("design = \"{}\" has no 'level'; it has '{}'", name,
                                             has_samples ? "samples" : "members"));
    }
    if (!has_samples && section.has("samples")) {
        section.mistake("samples", fmt::format("design = \"{}\" has no 'samples'; it has '{}'",
                                               name, has_level ? "level" : "members"));
    }
    if (has_samples && !section.has("samples")) {
        section.mistake("design", fmt::format("design = \"{}\" needs 'samples'{}", name,
                                              name == "full" ? ", the values on each axis" : ""));
    }
    result.n_projected = section.integer("projected", 0, most_samples).value_or(0);
    if (result.n_projected > 0 && result.design == GeometryDesign::list) {
        section.mistake("projected", "members that are listed can't be made at other points");
    }
    result.seed = static_cast<std::uint64_t>(section.integer("seed", 0, 1'000'000'000).value_or(1));
}

std::optional<rom::Trend> read_trend(Section& section) {
    static const std::vector<std::string> names = {"constant", "linear", "quadratic", "automatic"};
    const auto name = section.choice("trend", names);
    if (!name) return {};
    return static_cast<rom::Trend>(std::find(names.begin(), names.end(), *name) - names.begin());
}

}  // namespace

rom::ParameterSpace RomSection::space() const {
    std::vector<rom::Parameter> all;
    for (const RomParameter& one : parameters) all.push_back(one.parameter);
    return rom::ParameterSpace(std::move(all));
}

std::vector<int> RomSection::inputs(rom::ParameterGroup group) const {
    std::vector<int> positions;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (parameters[i].parameter.group == group && !parameters[i].is_factored) {
            positions.push_back(static_cast<int>(i));
        }
    }
    return positions;
}

std::vector<std::string> RomSection::overrides(const VectorX& point) const {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        // A TOML number has a point or an exponent, and every digit.
        const double value = point[static_cast<Eigen::Index>(i)];
        const std::string& unit = parameters[i].parameter.unit;
        for (const std::string& key : parameters[i].keys) {
            result.push_back(unit.empty() ? fmt::format("{}={:.17e}", key, value)
                                          : fmt::format("{}='{:.17e} {}'", key, value, unit));
        }
    }
    return result;
}

std::optional<RomSection> read_rom_section(Section& top, const std::filesystem::path& folder) {
    std::optional<RomSection> result;
    for_section(top, "rom", [&](Section& section) {
        result.emplace();
        result->source = section.place().source;
        read_design(section, folder, *result);
        result->is_stacked = section.choice("basis", {"separate", "stacked"}) == "stacked";
        constexpr int most_modes = 100'000;
        result->n_modes = section.integer("modes", 1, most_modes);
        result->tolerance =
            section.number("tolerance", dimensions::none, {.low = 0.0, .high = 1.0}).value_or(0.0);
        result->has_amplitude = section.choice("amplitude", {"automatic", "none"}) != "none";
        result->is_l2 = section.choice("inner_product", {"l2", "euclidean"}) != "euclidean";
        if (section.choice("correlation", {"matern_5_2", "gaussian"}) == "gaussian") {
            result->correlation = rom::CorrelationKind::gaussian;
        }
        result->trend = read_trend(section).value_or(result->trend);
        for_each_entry(section, "parameter", [&](Section& entry) {
            result->parameters.push_back(
                read_parameter(entry, top.table(), result->design == GeometryDesign::list));
        });
        if (result->parameters.empty()) {
            section.mistake("parameter",
                            "[rom] needs at least one [[rom.parameter]] with 'key' and 'range'");
        }
        for (std::size_t i = 0; i < result->parameters.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (result->parameters[i].parameter.name == result->parameters[k].parameter.name) {
                    section.mistake("parameter",
                                    fmt::format("two parameters are called '{}'; give one another "
                                                "'name'",
                                                result->parameters[i].parameter.name));
                }
                for (const std::string& key : result->parameters[i].keys) {
                    const auto& others = result->parameters[k].keys;
                    if (std::find(others.begin(), others.end(), key) == others.end()) continue;
                    section.mistake("parameter",
                                    fmt::format("'{}' and '{}' have the same key '{}'; leave one "
                                                "of them out",
                                                result->parameters[k].parameter.name,
                                                result->parameters[i].parameter.name, key));
                }
            }
        }
    });
    return result;
}

}  // namespace couture::io
