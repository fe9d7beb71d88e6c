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

/// Calls `read` for every [name.KEY]; each is finished afterwards.
void for_each_named(Section& parent, const std::string& name,
                    const std::function<void(const std::string& key, Section&)>& read);

/// Reads [analysis], the materials, conditions, loads and combinations.
void read_problem(Section& top, iga::Problem& problem);
void read_materials(Section& top, iga::Problem& problem);
void read_conditions(Section& top, iga::Problem& problem);
void read_loads(Section& top, iga::Problem& problem);

/// Reads [[output.probe]]; needs the problem for the quantities and load cases there are.
void read_probes(Section& output, const iga::Problem& problem, std::vector<Probe>& probes);

}  // namespace couture::io
