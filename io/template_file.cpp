#include "io/template_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/built_in_templates.h"
#include "io/deck_section.h"
#include "io/did_you_mean.h"
#include "io/toml_file.h"
#include "meshing/layout/polycube_templates.h"

namespace couture::io {

namespace {

using namespace meshing;
using Kind = TomlNode::Kind;

/// What is wrong with an entry, and where.
struct EntryMistake {
    TomlPlace place;
    std::string message;
};

[[noreturn]] void fail(const TomlNode& at, std::string message) {
    throw EntryMistake{at.place, std::move(message)};
}

const std::vector<TomlNode>& items_of(const TomlNode& node, const std::string& what) {
    if (node.kind != Kind::array) {
        fail(node, fmt::format("found {}, expected a list of {}", node.kind_name(), what));
    }
    return node.items;
}

int read_integer(const TomlNode& node) {
    constexpr std::int64_t most = 1'000'000;
    if (node.kind != Kind::integer || node.integer < -most || node.integer > most) {
        fail(node, fmt::format("found {}, expected a whole number in [{}, {}]", node.kind_name(),
                               -most, most));
    }
    return static_cast<int>(node.integer);
}

template <std::size_t n>
std::array<int, n> read_integers(const TomlNode& node) {
    const auto& items = items_of(node, fmt::format("{} whole numbers", n));
    if (items.size() != n) {
        fail(node, fmt::format("found {} numbers, expected {}", items.size(), n));
    }
    std::array<int, n> values{};
    std::ranges::transform(items, values.begin(), read_integer);
    return values;
}

template <std::size_t n>
std::vector<std::array<int, n>> read_rows(const TomlNode& node) {
    std::vector<std::array<int, n>> rows;
    for (const TomlNode& item : items_of(node, fmt::format("lists of {} whole numbers", n))) {
        rows.push_back(read_integers<n>(item));
    }
    return rows;
}

Vector3 read_position(const TomlNode& node) {
    const auto& items = items_of(node, "3 numbers");
    if (items.size() != 3 || !std::ranges::all_of(items, &TomlNode::is_number)) {
        fail(node, "found something else, expected a position [x, y, z]");
    }
    return {items[0].number, items[1].number, items[2].number};
}

/// One [[template]]: which keys it has, and what is read of them.
class Entry {
  public:
    explicit Entry(const TomlNode& table) : table_(&table) {
        if (table.kind != Kind::table) fail(table, "[[template]] is a list of sections");
        name_ = text("name");
    }

    CuboidTemplate read() {
        CuboidTemplate shape = table_->find("generator") == nullptr ? read_whole() : generate();
        for (const auto& [key, node] : table_->entries) {
            if (known_.contains(key)) continue;
            fail(node, fmt::format("template '{}': unknown key '{}'{}", name_, key,
                                   did_you_mean(key, {known_.begin(), known_.end()})));
        }
        return shape;
    }

  private:
    const TomlNode* find(const std::string& key) {
        known_.insert(key);
        return table_->find(key);
    }

    const TomlNode& need(const std::string& key) {
        const TomlNode* node = find(key);
        if (node == nullptr) {
            fail(*table_, name_.empty() ? fmt::format("[[template]] needs '{}'", key)
                                        : fmt::format("template '{}' needs '{}'", name_, key));
        }
        return *node;
    }

    std::string text(const std::string& key) {
        const TomlNode& node = need(key);
        if (node.kind != Kind::text || node.text.empty()) {
            fail(node, fmt::format("'{}' is {}, expected a text", key, node.kind_name()));
        }
        return node.text;
    }

    std::vector<PolycubeCap> read_caps() {
        std::vector<PolycubeCap> caps;
        const TomlNode* list = find("caps");
        if (list == nullptr) return caps;
        for (const TomlNode& item : items_of(*list, "caps")) {
            const TomlNode* name = item.find("name");
            const TomlNode* sides = item.find("sides");
            if (item.entries.size() != 2 || name == nullptr || name->kind != Kind::text ||
                sides == nullptr) {
                fail(item, "a cap is { name = \"...\", sides = [[cuboid, side], ...] }");
            }
            auto& cap = caps.emplace_back();
            cap.name = name->text;
            for (const TomlNode& side : items_of(*sides, "[cuboid, side]")) {
                const auto [cuboid, number] = read_integers<2>(side);
                if (number < 0 || number > 5) {
                    fail(side, fmt::format("side {}; sides are 0 to 5", number));
                }
                cap.sides.push_back({cuboid, number});
            }
        }
        return caps;
    }

    CuboidTemplate generate() {
        const std::vector<std::string> generators{"disc", "bar", "ring", "star", "polycube"};
        const std::string generator = text("generator");
        if (generator == "disc") return make_disc_template(name_, read_rows<2>(need("section")));
        if (generator == "star") return make_star_template(name_, read_integer(need("legs")));
        if (generator == "ring") {
            return make_ring_template(name_, read_rows<2>(need("section")),
                                      read_integer(need("corners")));
        }
        if (generator == "polycube") {
            return make_polycube_template(name_, read_rows<3>(need("cells")), read_caps());
        }
        if (generator == "bar") {
            std::vector<std::vector<SectionCell>> branches;
            if (const TomlNode* list = find("branches")) {
                for (const TomlNode& item : items_of(*list, "chains of cells")) {
                    branches.push_back(read_rows<2>(item));
                }
            }
            return make_bar_template(name_, read_rows<2>(need("section")), branches);
        }
        fail(need("generator"),
             fmt::format("there is no generator '{}'{}; there are {}", generator,
                         did_you_mean(generator, generators), quoted_list(generators)));
    }

    CuboidTemplate read_whole() {
        known_.insert("generator");
        CuboidTemplate shape;
        shape.name = name_;
        shape.layout.cuboids = read_rows<8>(need("cuboids"));
        for (const TomlNode& item : items_of(need("positions"), "positions")) {
            shape.positions.push_back(read_position(item));
        }
        shape.layout.n_nodes = static_cast<int>(shape.positions.size());
        for (PolycubeCap& cap : read_caps()) {
            shape.caps.push_back(cap.name);
            shape.layout.sets[cap.name] = std::move(cap.sides);
        }
        return shape;
    }

    const TomlNode* table_;
    std::string name_;
    std::set<std::string> known_;
};

void add_entry(const TomlNode& table, TemplateLibrary& library, Mistakes& mistakes) {
    try {
        library.add(Entry(table).read());
    } catch (const EntryMistake& mistake) {
        mistakes.add(mistake.place, mistake.message);
    } catch (const Error& error) {
        mistakes.add(table.place, error.what());
    }
}

}  // namespace

void parse_templates(std::string_view text, const std::string& name, TemplateLibrary& library) {
    const TomlNode document = parse_toml(text, name);
    Mistakes mistakes;
    for (const auto& [key, node] : document.entries) {
        if (key != "template" || node.kind != Kind::array) {
            mistakes.add(
                node.place,
                fmt::format("unknown key '{}'; a file of templates has [[template]] only", key));
            continue;
        }
        for (const TomlNode& table : node.items) add_entry(table, library, mistakes);
    }
    mistakes.throw_if_any();
}

void add_templates(const std::filesystem::path& path, TemplateLibrary& library) {
    parse_templates(read_text(path), path.string(), library);
}

TemplateLibrary built_in_templates() {
    TemplateLibrary library;
    parse_templates(built_in_templates_text, "templates.toml", library);
    return library;
}

}  // namespace couture::io
