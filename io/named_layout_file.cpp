#include "io/named_layout_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "io/atomic_file.h"
#include "io/deck_readers.h"
#include "io/deck_section.h"
#include "io/did_you_mean.h"
#include "io/toml_file.h"
#include "io/volumetric_layout_file.h"

namespace couture::io {

namespace {

using Hexahedron = std::array<int, 8>;

void read_nodes(Section& nodes, const TomlNode& table,
                const std::map<std::string, Vector3>& corners, std::vector<std::string>& names,
                std::vector<Vector3>& positions) {
    std::vector<std::string> corner_names;
    for (const auto& [name, x] : corners) corner_names.push_back(name);
    for (const auto& [name, node] : table.entries) {
        names.push_back(name);
        Vector3& x = positions.emplace_back(Vector3::Zero());
        if (node.kind != TomlNode::Kind::text) {
            const auto values = nodes.numbers(name, dimensions::length, {3});
            if (values.size() == 3) x = Vector3(values[0], values[1], values[2]);
            continue;
        }
        const std::string corner = nodes.text(name).value_or("");
        const auto place = corners.find(corner);
        if (place != corners.end()) {
            x = place->second;
        } else if (corners.empty()) {
            nodes.mistake(name, fmt::format("node '{}' lies at the corner '{}', but corners of a "
                                            "file have no names; give a point [x, y, z]",
                                            name, corner));
        } else {
            const std::string help = did_you_mean(corner, corner_names);
            nodes.mistake(
                name,
                fmt::format("node '{}' lies at the corner '{}', which the part does not "
                            "have{} There are {}",
                            name, corner, help.empty() ? "." : help, quoted_list(corner_names)));
        }
    }
}

std::optional<Hexahedron> read_cuboid(Section& cuboid, const std::vector<std::string>& names) {
    const std::vector<std::string> given = cuboid.texts("nodes");
    if (given.size() != 8) {
        cuboid.mistake("nodes", fmt::format("a cuboid has 8 nodes, here are {}", given.size()));
        return {};
    }
    Hexahedron corners{};
    for (std::size_t k = 0; k < 8; ++k) {
        const auto place = std::ranges::find(names, given[k]);
        if (place == names.end()) {
            cuboid.mistake("nodes", fmt::format("there is no node '{}' in [nodes]{}", given[k],
                                                did_you_mean(given[k], names)));
            return {};
        }
        if (std::find(given.begin(), given.begin() + static_cast<long>(k), given[k]) !=
            given.begin() + static_cast<long>(k)) {
            cuboid.mistake("nodes", fmt::format("node '{}' stands twice in the cuboid; its 8 nodes "
                                                "must be different. A prism of triangles is no "
                                                "cuboid: halve the sides of its ends, which makes "
                                                "three",
                                                given[k]));
            return {};
        }
        corners[k] = static_cast<int>(place - names.begin());
    }
    return corners;
}

void check_all_used(Section& nodes, const std::vector<std::string>& names,
                    const std::vector<Hexahedron>& cuboids) {
    std::set<int> used;
    for (const auto& corners : cuboids) used.insert(corners.begin(), corners.end());
    for (std::size_t n = 0; n < names.size(); ++n) {
        if (used.contains(static_cast<int>(n))) continue;
        nodes.mistake(names[n], fmt::format("node '{}' belongs to no cuboid; take it out, or name "
                                            "it in a [[cuboid]]",
                                            names[n]));
    }
}

}  // namespace

NamedLayout parse_named_layout(const std::string& name, std::string_view text,
                               const std::map<std::string, Vector3>& corners,
                               const UnitSystem& units) {
    TomlNode document = parse_toml(text, name);
    document.place = {};
    document.place.source = name;
    DeckContext context;
    context.units = units;
    Section top(document, "", context);
    NamedLayout layout;
    layout.tolerance = top.number("tolerance", dimensions::length, positive);
    std::vector<std::string> names;
    std::vector<Vector3> positions;
    std::vector<Hexahedron> cuboids;
    const TomlNode* table = top.require("nodes", "the section [nodes] with a place for each node");
    if (table != nullptr && table->kind == TomlNode::Kind::table) {
        Section nodes(*table, "[nodes]", context);
        read_nodes(nodes, *table, corners, names, positions);
        bool is_whole = top.require("cuboid", "[[cuboid]] with 'nodes'") != nullptr;
        for_each_entry(top, "cuboid", [&](Section& cuboid) {
            const auto corners_of = read_cuboid(cuboid, names);
            is_whole = is_whole && corners_of.has_value();
            if (corners_of) cuboids.push_back(*corners_of);
        });
        if (is_whole) check_all_used(nodes, names, cuboids);
    } else if (table != nullptr) {
        top.mistake("nodes",
                    fmt::format("'nodes' is {}, expected the section [nodes]", table->kind_name()));
    }
    top.finish();
    context.mistakes.throw_if_any();
    layout.placed = make_placed_layout(name, positions, std::move(cuboids), names);
    return layout;
}

NamedLayout read_named_layout(const std::filesystem::path& path,
                              const std::map<std::string, Vector3>& corners,
                              const UnitSystem& units) {
    return parse_named_layout(path.string(), read_text(path), corners, units);
}

}  // namespace couture::io
