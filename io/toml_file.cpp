#include "io/toml_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <sstream>
#include <toml.hpp>

#include "iga/core/error.h"

namespace couture::io {

namespace {

using TomlValue = toml::basic_value<toml::discard_comments, std::map>;

constexpr int max_depth = 100;
/// Digits that a 64-bit integer surely holds.
constexpr std::size_t max_digits = 18;

/// The parser below is recursive and takes bytes as they are: both are checked before it runs.
void check_text(std::string_view text, const std::string& name) {
    int depth = 0;
    bool is_comment = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if ((c < 32 && c != '\n' && c != '\t' && c != '\r') || c == 127 || c >= 0xf8) {
            throw InputError("{}: byte {} = 0x{:02x} is not text; a deck is a TOML text file", name,
                             i, static_cast<int>(c));
        }
        is_comment = c == '#' || (is_comment && c != '\n');
        if (!is_comment && (c == '[' || c == '{')) {
            ++depth;
        } else if (!is_comment && (c == ']' || c == '}')) {
            depth = std::max(depth - 1, 0);
        }
        if (depth > max_depth) {
            throw InputError("{}: values are nested deeper than {}", name, max_depth);
        }
    }
}

TomlPlace to_place(const toml::source_location& location, const std::string& name) {
    TomlPlace place;
    place.line = static_cast<int>(location.line());
    place.source = fmt::format("{}:{}", name, place.line);
    place.text = location.line_str();
    if (!place.text.empty() && place.text.back() == '\r') {
        place.text.pop_back();
    }
    place.column =
        std::min(static_cast<int>(location.column()) - 1, static_cast<int>(place.text.size()));
    place.length = static_cast<int>(location.region());
    return place;
}

TomlNode to_node(const TomlValue& value, const std::string& name) {
    TomlNode node;
    node.place = to_place(value.location(), name);
    switch (value.type()) {
        case toml::value_t::boolean:
            node.kind = TomlNode::Kind::boolean;
            node.boolean = value.as_boolean();
            break;
        case toml::value_t::integer:
            if (value.location().region() > max_digits) {
                throw InputError(
                    "{}", located(node.place, fmt::format("whole number with more than {} digits",
                                                          max_digits)));
            }
            node.kind = TomlNode::Kind::integer;
            node.integer = value.as_integer();
            node.number = static_cast<double>(node.integer);
            break;
        case toml::value_t::floating:
            node.kind = TomlNode::Kind::number;
            node.number = value.as_floating();
            break;
        case toml::value_t::string:
            node.kind = TomlNode::Kind::text;
            node.text = value.as_string().str;
            break;
        case toml::value_t::array:
            node.kind = TomlNode::Kind::array;
            for (const TomlValue& item : value.as_array()) {
                node.items.push_back(to_node(item, name));
            }
            break;
        case toml::value_t::table:
            node.kind = TomlNode::Kind::table;
            for (const auto& [key, entry] : value.as_table()) {
                node.entries.emplace_back(key, to_node(entry, name));
            }
            std::stable_sort(node.entries.begin(), node.entries.end(),
                             [](const auto& a, const auto& b) {
                                 return std::pair(a.second.place.line, a.second.place.column) <
                                        std::pair(b.second.place.line, b.second.place.column);
                             });
            break;
        default:
            node.kind = TomlNode::Kind::date;
    }
    return node;
}

/// First line of the parser's own message without its prefix.
std::string reason_of(const std::string& what) {
    std::string line = what.substr(0, what.find('\n'));
    const std::size_t prefix = line.find("toml::");
    if (prefix != std::string::npos) {
        const std::size_t colon = line.find(": ", prefix);
        line = colon == std::string::npos ? line : line.substr(colon + 2);
    }
    if (line.find("already exists") != std::string::npos) {
        return "written twice: " + line;
    }
    while (!line.empty() && (line.back() == '.' || line.back() == ' ')) {
        line.pop_back();
    }
    return line;
}

std::vector<std::string> split(const std::string& path) {
    std::vector<std::string> parts;
    std::istringstream stream(path);
    for (std::string part; std::getline(stream, part, '.');) {
        parts.push_back(part);
    }
    return parts;
}

bool is_index(const std::string& part) {
    return !part.empty() && part.size() < 6 &&
           std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
}

TomlNode parse_override_value(const std::string& value) {
    try {
        return std::move(parse_toml("value = " + value + "\n", "--set").entries.at(0).second);
    } catch (const InputError&) {
        TomlNode node;
        node.kind = TomlNode::Kind::text;
        node.text = value;
        return node;
    }
}

void replace_places(TomlNode& node, const TomlPlace& place) {
    node.place = place;
    for (TomlNode& item : node.items) {
        replace_places(item, place);
    }
    for (auto& [key, entry] : node.entries) {
        replace_places(entry, place);
    }
}

}  // namespace

TomlNode parse_toml(std::string_view text, const std::string& name) {
    check_text(text, name);
    std::istringstream stream{std::string(text)};
    try {
        return to_node(toml::parse<toml::discard_comments, std::map>(stream, name), name);
    } catch (const toml::exception& error) {
        throw InputError("{}", located(to_place(error.location(), name),
                                       "not valid TOML: " + reason_of(error.what())));
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError("{}: not valid TOML: {}", name, reason_of(error.what()));
    }
}

void override_value(TomlNode& document, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    const std::vector<std::string> parts = split(assignment.substr(0, equals));
    if (equals == std::string::npos || parts.empty()) {
        throw InputError("--set {}: must read section.key=value", assignment);
    }
    TomlNode* node = &document;
    for (const std::string& part : parts) {
        if (node->kind == TomlNode::Kind::array) {
            const std::size_t index = is_index(part) ? std::stoul(part) : node->items.size();
            if (index >= node->items.size()) {
                throw InputError(
                    "--set {}: '{}' is not one of the {} entries of the list; count "
                    "from 0",
                    assignment, part, node->items.size());
            }
            node = &node->items[index];
            continue;
        }
        if (node->kind != TomlNode::Kind::table) {
            throw InputError("--set {}: '{}' lies below {}, which holds no keys", assignment, part,
                             node->kind_name());
        }
        if (node->find(part) == nullptr) {
            node->entries.emplace_back(part, TomlNode{});
        }
        node = node->find(part);
    }
    *node = parse_override_value(assignment.substr(equals + 1));
    TomlPlace place;
    place.source = "--set " + assignment;
    replace_places(*node, place);
}

}  // namespace couture::io
