#include "io/calculix.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "iga/assembly/constraints.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"

namespace couture::io {

using namespace iga;

namespace {

/// At most 20 characters, which is what CalculiX reads.
std::string number(double value) {
    return fmt::format("{:.13e}", std::abs(value) < 1e-99 ? 0.0 : value);
}

void append_nodal_values(std::string& text, const char* keyword,
                         const std::vector<NodalValue>& values, bool names_a_range, long n_nodes) {
    if (values.empty()) {
        return;
    }
    text += keyword;
    for (const NodalValue& entry : values) {
        if (entry.node < 0 || entry.node >= n_nodes || entry.component < 0 || entry.component > 2) {
            throw InputError("calculix: node {}, component {}; must be below {} and 3", entry.node,
                             entry.component, n_nodes);
        }
        const int component = entry.component + 1;
        text += names_a_range
                    ? fmt::format("{}, {}, {}, {}\n", entry.node + 1, component, component,
                                  number(entry.value))
                    : fmt::format("{}, {}, {}\n", entry.node + 1, component, number(entry.value));
    }
}

/// Numbers from 1, 12 a line.
template <typename Range>
void append_numbers(std::string& text, const Range& numbers) {
    constexpr int per_line = 12;
    int n = 0;
    for (const int one : numbers) {
        text += fmt::format("{}{}", n == 0 ? "" : n % per_line == 0 ? ",\n" : ", ", one + 1);
        ++n;
    }
    text += "\n";
}

std::string upper(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
        return std::isalnum(c) != 0 ? static_cast<char>(std::toupper(c)) : '_';
    });
    return name;
}

std::string mesh_text(const HexMesh& mesh, const std::string& title, bool is_reduced) {
    const bool is_quadratic = mesh.elements.cols() == 20;
    std::string text = fmt::format("*HEADING\n{}\n*NODE, NSET=ALL_NODES\n", title);
    for (long i = 0; i < mesh.nodes.rows(); ++i) {
        text += fmt::format("{}, {}, {}, {}\n", i + 1, number(mesh.nodes(i, 0)),
                            number(mesh.nodes(i, 1)), number(mesh.nodes(i, 2)));
    }
    text += fmt::format("*ELEMENT, TYPE=C3D{}{}, ELSET=ALL_ELEMENTS\n", is_quadratic ? 20 : 8,
                        is_quadratic && is_reduced ? "R" : "");
    for (long e = 0; e < mesh.elements.rows(); ++e) {
        std::vector<int> line = {static_cast<int>(e)};
        for (const int node : mesh.elements.row(e)) {
            line.push_back(node);
        }
        append_numbers(text, line);
    }
    for (const auto& [name, nodes] : mesh.node_sets) {
        text += fmt::format("*NSET, NSET={}\n", upper(name));
        append_numbers(text, nodes);
    }
    return text;
}

}  // namespace

CalculixModel make_calculix_model(const SpacePtr<3>& space, const Problem& problem) {
    CalculixModel model;
    model.mesh = make_hexahedra(*space);
    if (model.mesh.elements.cols() != 8) {
        throw InputError("calculix: the space has degree 2; nodal forces are those of degree 1");
    }
    if (problem.materials.size() != 1 || !problem.materials[0].hyperelastic) {
        throw InputError("calculix: {} materials; expected one, which is hyperelastic",
                         problem.materials.size());
    }
    model.material = *problem.materials[0].hyperelastic;
    for (const Pressure& load : problem.pressures) {
        if (load.follows_body) {
            throw InputError(
                "calculix: the pressure on '{}' follows the body; only dead loads are "
                "written",
                load.on);
        }
    }
    if (!problem.foundations.empty()) {
        throw InputError("calculix: the foundation on '{}' can't be written",
                         problem.foundations[0].on);
    }
    const Problem at_end = at_time(problem, 1.0, 1.0);
    const Constraints<3> constraints = make_constraints(*space, at_end, {""});
    if (!constraints.frames.empty()) {
        throw InputError(
            "calculix: {} functions are held along slanted normals; only directions of the axes "
            "are written",
            constraints.frames.size());
    }
    const MatrixX loads = assemble_loads(*space, at_end, "");
    for (int node = 0; node < space->n_dofs(); ++node) {
        for (int a = 0; a < 3; ++a) {
            const int unknown = 3 * node + a;
            if (constraints.is_fixed[unknown] != 0) {
                model.displacements.push_back({node, a, constraints.values(unknown, 0)});
            } else if (loads(node, a) != 0.0) {
                model.forces.push_back({node, a, loads(node, a)});
            }
        }
    }
    return model;
}

std::string to_calculix(const CalculixModel& model, const std::string& title) {
    if (model.material.energy != StoredEnergy::neo_hookean) {
        throw InputError("calculix: the material is not neo_hookean; no other energy is written");
    }
    const HexMesh& mesh = model.mesh;
    std::string text = mesh_text(mesh, title, model.is_reduced);
    text += fmt::format(
        "*MATERIAL, NAME=RUBBER\n*HYPERELASTIC, NEO HOOKE\n{}, {}\n"
        "*SOLID SECTION, ELSET=ALL_ELEMENTS, MATERIAL=RUBBER\n",
        number(0.5 * model.material.shear_modulus), number(2.0 / model.material.bulk_modulus));
    // Residual and correction: as small as rounding allows.
    text += fmt::format(
        "*STEP, NLGEOM, INC=10000\n*STATIC{}\n{}, 1.\n"
        "*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-8, , , , , , 1e-10\n",
        model.is_automatic ? "" : ", DIRECT", number(model.increment));
    append_nodal_values(text, "*BOUNDARY\n", model.displacements, true, mesh.nodes.rows());
    append_nodal_values(text, "*CLOAD\n", model.forces, false, mesh.nodes.rows());
    text +=
        "*NODE PRINT, NSET=ALL_NODES, FREQUENCY=10000\nU\n"
        "*NODE PRINT, NSET=ALL_NODES, FREQUENCY=10000\nRF\n"
        "*EL PRINT, ELSET=ALL_ELEMENTS, FREQUENCY=10000\nCOORD\n"
        "*EL PRINT, ELSET=ALL_ELEMENTS, FREQUENCY=10000\nS\n"
        "*END STEP\n";
    return text;
}

std::string to_calculix(const HexMesh& mesh, const std::string& title) {
    return mesh_text(mesh, title, false);
}

}  // namespace couture::io
