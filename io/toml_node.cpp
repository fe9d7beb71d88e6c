#include "io/toml_node.h"

#include <fmt/format.h>

#include <algorithm>

namespace couture::io {

std::string located(const TomlPlace& place, const std::string& message) {
    std::string result = fmt::format("{}: {}", place.source, message);
    if (place.text.empty()) {
        return result;
    }
    // Tabs before the value are kept, so that the caret stands below it.
    std::string indent = place.text.substr(0, static_cast<std::size_t>(place.column));
    std::replace_if(
        indent.begin(), indent.end(), [](char c) { return c != '\t'; }, ' ');
    const std::string number = place.line > 0 ? fmt::format("{:>5}", place.line) : "     ";
    const int room = static_cast<int>(place.text.size()) - place.column;
    const int length = std::clamp(place.length, 1, std::max(room, 1));
    return result + fmt::format("\n{} | {}\n      | {}^{}", number, place.text, indent,
                                std::string(static_cast<std::size_t>(length - 1), '~'));
}

const TomlNode* TomlNode::find(const std::string& key) const {
    for (const auto& [name, node] : entries) {
        if (name == key) {
            return &node;
        }
    }
    return nullptr;
}

TomlNode* TomlNode::find(const std::string& key) {
    return const_cast<TomlNode*>(static_cast<const TomlNode*>(this)->find(key));
}

std::string TomlNode::kind_name() const {
    switch (kind) {
        case Kind::boolean:
            return "true or false";
        case Kind::integer:
            return "a whole number";
        case Kind::number:
            return "a number";
        case Kind::text:
            return "a text";
        case Kind::date:
            return "a date";
        case Kind::array:
            return "a list";
        case Kind::table:
            return "a section";
    }
    return "a value";
}

}  // namespace couture::io
