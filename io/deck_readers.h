#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/deck.h"
#include "io/deck_section.h"

namespace couture::io {

/// Calls `read` for every [[name]] of a section's table; each is finished afterwards.
void for_each_entry(Section& parent, const std::string& name,
                    const std::function<void(Section&)>& read);

/// Calls `read` for [name] if it is there.
void for_section(Section& top, const std::string& name, const std::function<void(Section&)>& read);

/// Calls `read` for every [name.KEY]; each is finished afterwards.
void for_each_named(Section& parent, const std::string& name,
                    const std::function<void(const std::string& key, Section&)>& read);

/// Reads [analysis], the materials, conditions, loads and combinations.
void read_problem(Section& top, iga::Problem& problem);
void read_materials(Section& top, iga::Problem& problem);
void read_conditions(Section& top, iga::Problem& problem);
void read_loads(Section& top, iga::Problem& problem);

/// Reads the keys of a hyperelastic material.
void read_hyperelastic(Section& section, iga::StoredEnergy energy, iga::Material& material);

/// Warns of a Young's modulus that no such material has.
void warn_implausible_modulus(const std::string& name, const std::string& what, double modulus,
                              const TomlPlace& place, const UnitSystem& units);

/// Reads the tables [amplitude.NAME] into the context.
void read_amplitudes(Section& top);
/// Reads how the values of an entry, read before, follow time: 'amplitude', or t in them.
void read_time(Section& section, iga::CaseEntry& entry);

/// Reads [stepping] and [remeshing], after the problem; notes what of them, of [discretization] and
/// [output] does not fit the materials.
void read_stepping(Section& top, Deck& deck);
/// The times that steps must end at.
[[nodiscard]] std::vector<double> stops_of(const Deck& deck, const DeckContext& context);
/// See Deck::model_text.
[[nodiscard]] std::string model_text_of(const TomlNode& document, const Deck& deck,
                                        const DeckContext& context);

/// Reads [[output.probe]]; needs the problem for the quantities and load cases there are.
void read_probes(Section& output, const Deck& deck, std::vector<Probe>& probes);

}  // namespace couture::io
