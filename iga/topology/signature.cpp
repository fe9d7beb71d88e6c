#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "iga/core/text_hash.h"
#include "iga/topology/multipatch.h"

namespace couture::iga {

namespace {

void append_knots(std::string& text, const KnotVector& knots) {
    fmt::format_to(std::back_inserter(text), "degree {} count {} at", knots.degree(),
                   knots.n_basis());
    // In steps of 1e-10. The shift keeps simple fractions away from the middle between two steps,
    // where their rounding errors would decide.
    constexpr double steps = 1e10;
    constexpr double shift = 0.1234567;
    for (std::size_t i = 0; i < knots.breakpoints().size(); ++i) {
        const double t = (knots.breakpoints()[i] - knots.front()) / (knots.back() - knots.front());
        fmt::format_to(std::back_inserter(text), " {}x{}", std::llround(t * steps + shift),
                       knots.multiplicities()[i]);
    }
    text += '\n';
}

/// The lesser (patch, side) first.
template <int d>
Interface<d> in_order(const Interface<d>& interface) {
    if (std::pair(interface.first_patch, interface.first_side) <=
        std::pair(interface.second_patch, interface.second_side)) {
        return interface;
    }
    return {interface.second_patch, interface.second_side, interface.first_patch,
            interface.first_side, interface.map.inverse()};
}

template <int d>
std::string to_text(const Interface<d>& interface) {
    std::string text =
        fmt::format("interface {} {} {} {}", interface.first_patch, interface.first_side,
                    interface.second_patch, interface.second_side);
    for (int i = 0; i < d - 1; ++i) {
        text += fmt::format(" {}{}", interface.map.reversed[i] ? '-' : '+', interface.map.axis[i]);
    }
    return text + '\n';
}

}  // namespace

template <int d>
std::string signature(const MultiPatch<d>& multipatch) {
    std::string text = fmt::format("parameters {} coordinates {} patches {}\n", d,
                                   multipatch.dimension(), multipatch.n_patches());
    for (const Patch<d>& patch : multipatch.patches) {
        for (int k = 0; k < d; ++k) {
            append_knots(text, patch.knots(k));
        }
    }
    std::vector<std::string> interfaces;
    for (const Interface<d>& interface : multipatch.interfaces) {
        interfaces.push_back(to_text(in_order(interface)));
    }
    std::sort(interfaces.begin(), interfaces.end());
    for (const std::string& line : interfaces) {
        text += line;
    }
    for (const auto& [name, entities] : multipatch.boundary_sets) {
        fmt::format_to(std::back_inserter(text), "set {} of {}\n", name, entities.size());
        BoundarySet<d> sorted = entities;
        std::sort(sorted.begin(), sorted.end());
        for (const PatchEntity<d>& entity : sorted) {
            text += entity.name() + '\n';
        }
    }
    return text_hash(text);
}

template std::string signature(const MultiPatch<2>&);
template std::string signature(const MultiPatch<3>&);

}  // namespace couture::iga
