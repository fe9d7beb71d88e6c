#pragma once

#include <optional>
#include <string>
#include <vector>

#include "iga/mechanics/elastic_constants.h"
#include "rom/reduced_model.h"
#include "rom/sample_grid.h"

namespace couture::io {

/// A number, or that number times a parameter of the model.
struct PageModulus {
    double value = 0.0;
    std::optional<int> i_parameter = std::nullopt;
};

/// Of a linear elastic solid: constant, or isotropic with moduli that follow parameters.
struct PageMaterial {
    iga::ElasticStiffness stiffness = iga::ElasticStiffness::Zero();
    bool follows_parameters = false;
    PageModulus youngs_modulus;
    PageModulus poissons_ratio;
};

/// What a page shows beside the model.
struct PageContent {
    std::string title;
    /// Units of displacements and stresses, for legends.
    std::string length_unit;
    std::string stress_unit;
    /// Points of outer sides: one parameter in the direction that each is normal to.
    std::vector<rom::SampleGrid> grids;
    /// Of these per element and direction; largest values are those at the ends of elements.
    int n_cells = 1;
    std::vector<PageMaterial> materials;
    /// For each patch.
    std::vector<int> material_of_patch;
    /// Why the page can't compute stresses; empty: it can.
    std::string no_stress;
};

/// A page (HTML, one file) that evaluates a reduced model in a browser: geometry, displacement and
/// von Mises stress at the points of grids, by the formulas of ReducedModel and FieldSampler.
///
/// It holds only nodes that the grids see. Modes are rounded so that the field changes by no more
/// than 1e-7 of its largest mode's share: to 8 or 16 bits the weak ones, to single precision the
/// others. All else is in double precision.
///
/// @throws InputError  for a grid that is no side: with more than one parameter in all directions
[[nodiscard]] std::string make_rom_page(const rom::ReducedModel& model, const PageContent& content);

}  // namespace couture::io
