#pragma once

#include <optional>
#include <string>
#include <vector>

#include "iga/mechanics/elastic_constants.h"
#include "rom/reduced_model.h"
#include "rom/sample_grid.h"

namespace couture::io {

/// A number, or that number times a parameter of the model.
struct ExportModulus {
    double value = 0.0;
    std::optional<int> i_parameter = std::nullopt;
};

/// Of a linear elastic solid: constant, or isotropic with moduli that follow parameters.
struct ExportMaterial {
    iga::ElasticStiffness stiffness = iga::ElasticStiffness::Zero();
    bool follows_parameters = false;
    ExportModulus youngs_modulus;
    ExportModulus poissons_ratio;
};

/// What programs outside of this one are given beside the model.
struct ExportContent {
    std::string title;
    /// Units of displacements and stresses, for legends.
    std::string length_unit;
    std::string stress_unit;
    /// Where fields are evaluated; a page takes points of outer sides: one parameter in the
    /// direction that each is normal to.
    std::vector<rom::SampleGrid> grids;
    /// Of these per element and direction; largest values are those at the ends of elements.
    int n_cells = 1;
    std::vector<ExportMaterial> materials;
    /// For each patch.
    std::vector<int> material_of_patch;
    /// Why stresses can't be computed; empty: they can.
    std::string no_stress;
};

}  // namespace couture::io
