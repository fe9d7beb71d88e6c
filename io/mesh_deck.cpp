#include "io/mesh_deck.h"

#include <fmt/format.h>

#include <functional>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/deck_readers.h"
#include "io/quantity.h"
#include "io/toml_file.h"

namespace couture::io {

namespace {

namespace fs = std::filesystem;

void read_existing_file(Section& section, const std::string& key, const fs::path& folder,
                        fs::path& path) {
    const auto name = section.text(key);
    if (!name) return;
    path = folder / *name;
    if (!fs::is_regular_file(path)) {
        section.mistake(key, fmt::format("there is no file {} (paths are relative to the deck)",
                                         path.string()));
    }
}

// A list of points, each a list of three numbers.
std::vector<Vector3> read_points(Section& section, const std::string& key,
                                 const Dimension& dimension) {
    std::vector<Vector3> points;
    const TomlNode* list = section.find(key);
    if (list == nullptr) return points;
    if (list->kind != TomlNode::Kind::array) {
        section.mistake(key, fmt::format("'{}' is {}, expected a list of points [[x, y, z], ...]",
                                         key, list->kind_name()));
        return points;
    }
    for (const TomlNode& item : list->items) {
        TomlNode table;
        table.place = item.place;
        table.entries.emplace_back(key, item);
        Section inner(table, section.title(), section.context());
        if (item.kind != TomlNode::Kind::array) {
            inner.mistake(key, fmt::format("'{}' holds {}, expected points [x, y, z]", key,
                                           item.kind_name()));
            continue;
        }
        const auto values = inner.numbers(key, dimension, {3});
        if (values.size() == 3) points.emplace_back(values[0], values[1], values[2]);
    }
    return points;
}

void read_surface_geometry(Section& section, const fs::path& folder, MeshDeck& deck) {
    if (section.has("surface") == section.has("part")) {
        section.mistake(section.has("part") ? "part" : "",
                        "[geometry] needs either 'surface' (a file of triangles) or 'part' (a "
                        "built-in part)");
    }
    read_existing_file(section, "surface", folder, deck.surface);
    deck.part = section.text("part").value_or("");
    const TomlNode* table = section.find("parameters");
    if (table == nullptr) return;
    if (table->kind != TomlNode::Kind::table || deck.part.empty()) {
        section.mistake("parameters", "[geometry.parameters] is a section that belongs to 'part'");
        return;
    }
    Section inner(*table, "[geometry.parameters]", section.context());
    for (const auto& [name, node] : table->entries) {
        deck.parameters[name] = inner.number(name, dimensions::length).value_or(0.0);
    }
}

// Only the terms that are named count.
void read_criterion(Section& parent, const std::string& name, meshing::CriterionWeights& weights) {
    const TomlNode* table = parent.find(name);
    if (table == nullptr) return;
    if (table->kind != TomlNode::Kind::table) {
        parent.mistake(name, fmt::format("'{}' is {}, expected weights as {{ length = 1.0, "
                                         "symmetry = 0.5 }}",
                                         name, table->kind_name()));
        return;
    }
    Section section(*table, fmt::format("[meshing.{}]", name), parent.context());
    const auto read = [&](const char* key) {
        return section.number(key, dimensions::none, not_negative).value_or(0.0);
    };
    weights = {.length = read("length"),
               .symmetry = read("symmetry"),
               .curvature = read("curvature"),
               .sharp = section.number("sharp", dimensions::none).value_or(0.0)};
    if (weights.sharp <= -1.0) {
        section.mistake("sharp", fmt::format("'sharp' is {}; lengths along sharp edges are divided "
                                             "by 1 + sharp, which must be positive",
                                             weights.sharp));
    }
    section.finish();
    if (weights.length + weights.symmetry + weights.curvature <= 0.0) {
        parent.mistake(name, fmt::format("'{}' gives no weight to length, symmetry or curvature; "
                                         "one must be positive",
                                         name));
    }
}

void read_open(Section& section, CapSelection& open) {
    open.names = section.texts("open");
    std::erase_if(open.names, [&](const std::string& name) {
        if (name == "caps") open.all = true;
        return name == "caps";
    });
    open.points = read_points(section, "open_at", dimensions::length);
    open.normals = read_points(section, "open_facing", dimensions::none);
}

void read_meshing(Section& section, const fs::path& folder, MeshDeck& deck) {
    meshing::PantsOptions& pants = deck.pants;
    deck.stage = section
                     .choice("stage", {"surface", "features", "loops", "pants", "layout", "field",
                                       "map", "quads", "surfaces", "volume", "hexes"})
                     .value_or(deck.stage);
    deck.edge_length = section.number("edge_length", dimensions::length, positive).value_or(0.0);
    if (deck.edge_length > 0.0 && deck.part.empty()) {
        section.mistake("edge_length",
                        "'edge_length' is for parts; a surface file is taken as it is");
    }
    deck.fix = section.flag("fix").value_or(false);
    deck.fill_holes = section.flag("fill_holes").value_or(false);
    constexpr int most_shells = 1'000'000;
    deck.shell = section.integer("shell", 0, most_shells);
    constexpr double flat = 180.0;
    const Range angles{.low = 0.0, .high = flat, .is_open = true};
    deck.features.angle = section.angle("feature_angle", angles).value_or(deck.features.angle);
    deck.features.corner_angle =
        section.angle("corner_angle", angles).value_or(deck.features.corner_angle);
    read_open(section, deck.open);
    read_criterion(section, "cycle", pants.cycle);
    read_criterion(section, "merge", pants.merge);
    pants.most_boundaries =
        section.integer("most_boundaries", 3, 6).value_or(pants.most_boundaries);
    pants.merge_ratio =
        section.number("merge_ratio", dimensions::none, positive).value_or(pants.merge_ratio);
    pants.loop_width =
        section.number("loop_width", dimensions::none, {.low = 0.0, .high = 1.0, .is_open = true})
            .value_or(pants.loop_width);
    for_each_entry(section, "loop", [&](Section& loop) {
        meshing::GuideLoop guide{read_points(loop, "points", dimensions::length), {}};
        if (guide.points.size() < 3) {
            loop.mistake("points", fmt::format("a loop needs at least 3 'points', here are {}",
                                               guide.points.size()));
        }
        pants.loops.push_back(std::move(guide));
    });
    for_each_entry(section, "cycle_through", [&](Section& cycle) {
        CycleThrough through{read_points(cycle, "points", dimensions::length),
                             cycle.texts("corners")};
        if (through.points.empty() && through.corners.empty()) {
            cycle.mistake("points", "[[meshing.cycle_through]] needs 'points' or 'corners'");
        }
        if (!through.corners.empty() && deck.part.empty()) {
            cycle.mistake("corners", "'corners' are names of a part's; give 'points' on a surface");
        }
        deck.cycles_through.push_back(std::move(through));
    });
    meshing::SolidMeshOptions& solid = deck.solid;
    solid.element_size = section.number("element_size", dimensions::length, positive).value_or(0.0);
    solid.tolerance =
        section.number("tolerance", dimensions::none, positive).value_or(solid.tolerance);
    constexpr int most_elements = 1000;
    solid.min_elements =
        section.integer("min_elements", 1, most_elements).value_or(solid.min_elements);
    solid.volume.degree =
        section.integer("degree", 1, iga::max_degree).value_or(solid.volume.degree);
    const std::string route =
        section.choice("parameterization", {"aligned", "quadratic", "harmonic"})
            .value_or("aligned");
    solid.route = route == "aligned"     ? meshing::LayoutMapRoute::aligned
                  : route == "quadratic" ? meshing::LayoutMapRoute::quadratic
                                         : meshing::LayoutMapRoute::harmonic;
    constexpr int most_relocations = 10'000;
    solid.max_relocations =
        section.integer("relocations", 0, most_relocations).value_or(solid.max_relocations);
    solid.alignment = section.number("alignment", dimensions::none, {.low = 0.0, .high = 1e6})
                          .value_or(solid.alignment);
    if (solid.alignment > 0.0 && solid.route != meshing::LayoutMapRoute::aligned) {
        section.mistake("alignment",
                        fmt::format("'alignment' draws the aligned map to the cross field; it has "
                                    "no place beside parameterization = \"{}\"",
                                    route));
    }
    constexpr int most_points = 1000;
    solid.n_points = section.integer("points", 2, most_points);
    read_existing_file(section, "templates", folder, deck.templates);
    read_existing_file(section, "layout", folder, deck.layout);
    read_existing_file(section, "like", folder, deck.like);
    if (!deck.layout.empty() && !(deck.templates.empty() && deck.like.empty())) {
        section.mistake("layout",
                        "'layout' takes the place of pants and templates: 'templates' and 'like' "
                        "have no place beside it");
    }
    if (!deck.layout.empty() && (deck.stage == "loops" || deck.stage == "pants")) {
        section.mistake(
            "layout", fmt::format("'layout' takes the place of pants: stage = \"{}\" has no place "
                                  "beside it; write \"layout\" or a later one",
                                  deck.stage));
    }
    if (!deck.like.empty() && !(pants.loops.empty() && deck.cycles_through.empty())) {
        section.mistake("like",
                        "'like' repeats all cuts of another member: [[meshing.loop]] and "
                        "[[meshing.cycle_through]] have no place beside it");
    }
}

void read_family(Section& section, const fs::path& folder, MeshDeck& deck) {
    FamilySection family;
    if (section.has("parameters") == section.has("design")) {
        section.mistake(section.has("design") ? "design" : "",
                        "[family] needs either 'parameters' (a table of members, .csv) or 'design' "
                        "(\"star\")");
    }
    read_existing_file(section, "parameters", folder, family.parameters);
    static_cast<void>(section.choice("design", {"star"}));
    if (section.has("level") && !section.has("design")) {
        section.mistake("level", "'level' belongs to 'design'");
    }
    family.level = section.integer("level", 1, 2).value_or(family.level);
    if (section.has("reference") && section.has("design")) {
        section.mistake("reference", "of a 'design' the deck's own geometry is the reference");
    }
    family.reference = section.text("reference").value_or("");
    family.members = section.texts("members");
    if (!deck.layout.empty()) {
        section.mistake("",
                        "[family] repeats the cuts and templates of its reference; a 'layout' of "
                        "one's own in [meshing] has neither: mesh each member by itself with it");
    }
    if (!deck.like.empty()) {
        section.mistake("",
                        "[family] repeats its reference; 'like' of [meshing] has no place "
                        "beside it");
    }
    deck.family = std::move(family);
}

}  // namespace

bool is_mesh_deck(const fs::path& path) {
    const TomlNode document = parse_toml(read_text(path), path.filename().string());
    const TomlNode* geometry = document.find("geometry");
    return document.find("meshing") != nullptr ||
           (geometry != nullptr && geometry->find("surface") != nullptr);
}

MeshDeck parse_mesh_deck(const std::string& text, const fs::path& path,
                         const std::vector<std::string>& overrides) {
    const std::string name = path.filename().string();
    TomlNode document = parse_toml(text, name);
    for (const char* key : {"material", "discretization", "fixed", "solver", "output"}) {
        if (document.find(key) == nullptr || document.find("meshing") != nullptr) continue;
        throw InputError(
            "{}: has a section [{}] and none [meshing]: a deck for 'couture solve', not for "
            "'couture mesh'",
            name, key);
    }
    MeshDeck deck;
    deck.path = path;
    deck.text = text;
    for (const std::string& assignment : overrides) {
        override_value(document, assignment);
        deck.text += fmt::format("\n# --set {}", assignment);
    }
    DeckContext context;
    document.place = {};
    document.place.source = name;
    Section top(document, "", context);
    deck.title = top.text("title").value_or(path.stem().string());
    for_section(top, "units", [&](Section& section) {
        try {
            if (const auto system = section.text("system")) context.units = UnitSystem(*system);
        } catch (const InputError& error) {
            section.mistake("system", error.what());
        }
    });
    deck.units = context.units;
    const fs::path folder = path.parent_path();
    if (top.require("geometry", "the section [geometry] with 'surface' or 'part'") != nullptr) {
        for_section(top, "geometry",
                    [&](Section& section) { read_surface_geometry(section, folder, deck); });
    }
    for_section(top, "meshing", [&](Section& section) { read_meshing(section, folder, deck); });
    const TomlNode* meshing = document.find("meshing");
    const bool has_stage = meshing != nullptr && meshing->find("stage") != nullptr;
    for_section(top, "family", [&](Section& section) {
        if (!has_stage) deck.stage = "volume";
        if (deck.stage != "volume") {
            section.mistake("",
                            fmt::format("[family] makes volumes: leave 'stage' of [meshing] out "
                                        "or set it to \"volume\", not \"{}\"",
                                        deck.stage));
        }
        read_family(section, folder, deck);
    });
    top.finish();
    context.mistakes.throw_if_any();
    return deck;
}

MeshDeck read_mesh_deck(const fs::path& path, const std::vector<std::string>& overrides) {
    return parse_mesh_deck(read_text(path), path, overrides);
}

}  // namespace couture::io
