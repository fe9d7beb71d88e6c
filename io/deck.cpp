#include "io/deck.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/deck_readers.h"
#include "io/quantity.h"
#include "io/toml_file.h"

namespace couture::io {

namespace fs = std::filesystem;

double Probe::allowed_error() const {
    return std::max(tolerance * std::abs(expect.value_or(0.0)), absolute_tolerance);
}

bool Deck::is_hyperelastic() const {
    return !problem.materials.empty() && problem.materials.front().hyperelastic.has_value();
}

bool Probe::passes(double value) const {
    return !expect || std::abs(value - *expect) <= allowed_error();
}

void for_each_entry(Section& parent, const std::string& name,
                    const std::function<void(Section&)>& read) {
    const TomlNode* list = parent.find(name);
    if (list == nullptr) {
        return;
    }
    const std::string prefix =
        parent.title().empty() ? "" : parent.title().substr(1, parent.title().size() - 2) + ".";
    const std::string title = fmt::format("[[{}{}]]", prefix, name);
    if (list->kind == TomlNode::Kind::table) {
        parent.mistake(
            name, fmt::format("[{0}] may occur several times: write {1}", prefix + name, title));
        return;
    }
    const bool is_list =
        list->kind == TomlNode::Kind::array &&
        std::all_of(list->items.begin(), list->items.end(),
                    [](const TomlNode& item) { return item.kind == TomlNode::Kind::table; });
    if (!is_list) {
        parent.mistake(
            name, fmt::format("'{}' is {}, expected sections {}", name, list->kind_name(), title));
        return;
    }
    for (const TomlNode& item : list->items) {
        Section section(item, title, parent.context());
        read(section);
        section.finish();
    }
}

void for_each_named(Section& parent, const std::string& name,
                    const std::function<void(const std::string& key, Section&)>& read) {
    const TomlNode* table = parent.find(name);
    if (table == nullptr) {
        return;
    }
    if (table->kind != TomlNode::Kind::table) {
        parent.mistake(name, fmt::format("'{0}' is {1}, expected sections [{0}.NAME]", name,
                                         table->kind_name()));
        return;
    }
    for (const auto& [key, node] : table->entries) {
        if (node.kind != TomlNode::Kind::table) {
            parent.context().mistakes.add(
                node.place, fmt::format("[{0}] holds named sections only: put '{1}' into "
                                        "[{0}.NAME]",
                                        name, key));
            continue;
        }
        Section section(node, fmt::format("[{}.{}]", name, key), parent.context());
        read(key, section);
        section.finish();
    }
}

void for_section(Section& top, const std::string& name, const std::function<void(Section&)>& read) {
    const TomlNode* table = top.find(name);
    if (table == nullptr) {
        return;
    }
    if (table->kind != TomlNode::Kind::table) {
        top.mistake(
            name, fmt::format("'{0}' is {1}, expected a section [{0}]", name, table->kind_name()));
        return;
    }
    Section section(*table, fmt::format("[{}]", name), top.context());
    read(section);
    section.finish();
}

namespace {

void read_units(Section& section, UnitSystem& units) {
    if (const auto name = section.text("system")) {
        try {
            units = UnitSystem(*name);
        } catch (const InputError& error) {
            section.mistake("system", error.what());
        }
    }
}

void read_geometry(Section& section, const fs::path& folder, GeometrySource& geometry) {
    geometry.source = section.place().source;
    const auto file = section.text("file");
    const auto part = section.text("part");
    const auto mesh = section.text("mesh");
    const auto surface = section.text("surface");
    if (surface && !mesh) {
        section.mistake("surface",
                        "'surface' is for `couture mesh`; a problem is solved on splines: 'file', "
                        "'part', or a 'mesh' that is made of the surface");
        return;
    }
    const int n_given = static_cast<int>(section.has("file")) +
                        static_cast<int>(section.has("part")) +
                        static_cast<int>(section.has("mesh"));
    if (n_given != 1) {
        section.mistake(n_given > 1 && section.has("part") ? "part" : "",
                        "[geometry] needs one of 'file' (a spline file), 'part' (a built-in part) "
                        "and 'mesh' (a deck for `couture mesh`)");
    }
    const auto require_file = [&](const std::string& key, const fs::path& path) {
        if (!fs::exists(path)) {
            section.mistake(key, fmt::format("there is no file {} (paths are relative to the deck)",
                                             path.string()));
        } else if (fs::is_directory(path)) {
            section.mistake(key, fmt::format("{} is a folder, not a file", path.string()));
        }
    };
    if (file) {
        geometry.file = folder / *file;
        require_file("file", geometry.file);
    }
    if (mesh) {
        geometry.mesh = folder / *mesh;
        require_file("mesh", geometry.mesh);
    }
    if (surface) {
        geometry.surface = folder / *surface;
        require_file("surface", geometry.surface);
    }
    geometry.part = part.value_or("");
    const auto read_table = [&](const std::string& key,
                                const std::function<void(Section&, const std::string&)>& read) {
        const TomlNode* table = section.find(key);
        if (table == nullptr) {
            return;
        }
        if (table->kind != TomlNode::Kind::table) {
            section.mistake(key, fmt::format("'{0}' is {1}, expected a section [geometry.{0}]", key,
                                             table->kind_name()));
            return;
        }
        Section inner(*table, fmt::format("[geometry.{}]", key), section.context());
        for (const auto& [name, node] : table->entries) {
            read(inner, name);
        }
    };
    read_table("parameters", [&](Section& inner, const std::string& name) {
        // Texts with a unit are lengths; angles and counts are plain numbers.
        geometry.parameters[name] = inner.number(name, dimensions::length).value_or(0.0);
    });
    read_table("sets", [&](Section& inner, const std::string& name) {
        geometry.sets[name] = inner.texts(name);
    });
    if (!geometry.parameters.empty() && !geometry.file.empty()) {
        section.mistake("parameters",
                        "[geometry.parameters] belongs to 'part' or 'mesh'; a file has none");
    }
}

void read_discretization(Section& section, Deck& deck) {
    Discretization& discretization = deck.discretization;
    discretization.source = section.place().source;
    constexpr int max_degree = 8;
    constexpr int max_points = 20;
    discretization.degree = section.integer("degree", 1, max_degree);
    discretization.elements = section.integers("elements", 1);
    if (discretization.elements.size() > 3) {
        section.mistake("elements", fmt::format("'elements' of [discretization] has {} numbers, "
                                                "expected one, or one per direction",
                                                discretization.elements.size()));
    }
    discretization.interpolates_geometry =
        section.choice("geometry", {"exact", "interpolated"}) == "interpolated";
    discretization.n_gauss_points = section.integer("gauss_points", 1, max_points);
    const std::string volumetric =
        section.choice("volumetric", {"automatic", "full", "projected"}).value_or("automatic");
    deck.stepping.volumetric = volumetric == "full"        ? iga::Volumetric::full
                               : volumetric == "projected" ? iga::Volumetric::projected
                                                           : iga::Volumetric::automatic;
    section.context().is_integrated_in_full = volumetric == "full";
}

void read_solver(Section& section, iga::SolverOptions& solver) {
    solver.name = section.choice("linear", iga::linear_solver_names()).value_or(solver.name);
    solver.tolerance =
        section.number("tolerance", dimensions::none, {.low = 0.0, .high = 1.0, .is_open = true})
            .value_or(solver.tolerance);
    solver.max_iterations =
        section.integer("max_iterations", 1, 100'000'000).value_or(solver.max_iterations);
    solver.petsc_options = section.text("petsc_options").value_or("");
    constexpr double megabyte = 1024.0 * 1024.0;
    if (const auto limit = section.number("memory_limit", dimensions::none, positive)) {
        solver.memory_limit = static_cast<std::size_t>(*limit * megabyte);
    }
}

void read_output(Section& section, Deck& deck) {
    OutputOptions& output = deck.output;
    const bool is_elasticity = deck.problem.physics == iga::Physics::elasticity;
    output.vtu = section.flag("vtu").value_or(output.vtu);
    output.linear = section.flag("linear").value_or(output.linear);
    output.gauss_points = section.flag("gauss_points").value_or(output.gauss_points);
    output.png = section.flag("png").value_or(output.png);
    output.png_quantity = is_elasticity ? "von_mises" : "potential";
    std::vector<std::string> names;
    for (const QuantityInfo& info : quantities(is_elasticity)) {
        // Pictures are drawn from displacement and stress.
        if (info.place == QuantityInfo::Place::point && !info.name.starts_with("strain_")) {
            names.push_back(info.name);
        }
    }
    output.png_quantity = section.choice("png_quantity", names).value_or(output.png_quantity);
    output.png_scale = section.number("png_scale", dimensions::none, not_negative);
    constexpr int max_steps = 1'000'000;
    output.every = section.integer("every", 1, max_steps).value_or(output.every);
    if (section.has("every") && !deck.is_hyperelastic()) {
        section.mistake("every",
                        "'every' of [output] counts the steps of hyperelastic runs; the materials "
                        "of this deck are linear");
    }
    read_probes(section, deck, deck.probes);
}

}  // namespace

Deck parse_deck(const std::string& text, const fs::path& path,
                const std::vector<std::string>& overrides) {
    const std::string name = path.filename().string();
    TomlNode document = parse_toml(text, name);
    Deck deck;
    deck.path = path;
    deck.text = text;
    for (const std::string& assignment : overrides) {
        override_value(document, assignment);
        deck.text += fmt::format("\n# --set {}", assignment);
    }
    if (document.entries.empty()) {
        throw InputError("{}: the deck is empty; it needs at least [geometry] and a material",
                         name);
    }
    DeckContext context;
    document.place = {};
    document.place.source = name;
    Section top(document, "", context);
    deck.title = top.text("title").value_or(path.stem().string());
    for_section(top, "units", [&](Section& section) { read_units(section, context.units); });
    deck.units = context.units;
    if (top.require("geometry", "the section [geometry] with 'file', 'part' or 'mesh'") !=
        nullptr) {
        for_section(top, "geometry", [&](Section& section) {
            read_geometry(section, path.parent_path(), deck.geometry);
        });
    }
    if (top.find("meshing") != nullptr) {
        top.mistake("meshing",
                    "[meshing] is for `couture mesh`; this command takes the deck of a problem on "
                    "splines");
    }
    for_section(top, "discretization",
                [&](Section& section) { read_discretization(section, deck); });
    read_problem(top, deck.problem);
    for_section(top, "solver", [&](Section& section) { read_solver(section, deck.solver); });
    read_stepping(top, deck);
    for_section(top, "output", [&](Section& section) { read_output(section, deck); });
    deck.rom = read_rom_section(top, deck.path.parent_path());
    top.finish();
    context.mistakes.throw_if_any();
    if (deck.is_hyperelastic() && !deck.output.png_scale) {
        deck.output.png_scale = 1.0;
    }
    deck.stepping.newton.solver = deck.solver;
    deck.stepping.n_gauss_points = deck.discretization.n_gauss_points;
    deck.stepping.stops = stops_of(deck, context);
    deck.model_text = model_text_of(document, deck, context);
    return deck;
}

std::string located_in(const Deck& deck, const std::string& source, const std::string& word,
                       const std::string& message) {
    const std::string name = deck.path.filename().string();
    TomlPlace place;
    place.source = source;
    if (!source.starts_with(name + ":")) {
        return located(place, message);
    }
    const int first_line = std::atoi(source.c_str() + name.size() + 1);
    std::istringstream lines(deck.text);
    std::string line;
    for (int i = 1; std::getline(lines, line); ++i) {
        if (i < first_line) {
            continue;
        }
        if (i > first_line && line.starts_with('[')) {
            break;
        }
        const std::size_t column = word.empty() ? std::string::npos : line.find(word);
        if (i == first_line || column != std::string::npos) {
            place.line = i;
            place.source = fmt::format("{}:{}", name, i);
            place.text = line;
            place.column = column == std::string::npos ? 0 : static_cast<int>(column);
            place.length =
                static_cast<int>(column == std::string::npos ? line.size() : word.size());
        }
        if (word.empty() || column != std::string::npos) {
            break;
        }
    }
    return located(place, message);
}

Deck read_deck(const fs::path& path, const std::vector<std::string>& overrides) {
    return parse_deck(read_text(path), path, overrides);
}

}  // namespace couture::io
