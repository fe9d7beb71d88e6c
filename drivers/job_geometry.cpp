#include "drivers/job_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "drivers/meshed_geometry.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/topology/multipatch_interpolate.h"
#include "meshing/parts/parts.h"

namespace couture::drivers {

namespace {

template <int d>
void add_sets(const io::GeometrySource& source, iga::MultiPatch<d>& geometry) {
    for (const auto& [name, entities] : source.sets) {
        iga::BoundarySet<d> set;
        for (const std::string& text : entities) {
            try {
                set.push_back(parse_entity<d>(text, geometry.n_patches()));
            } catch (const InputError& error) {
                throw InputError("{}: set '{}' of [geometry.sets]: {}", source.source, name,
                                 error.what());
            }
        }
        geometry.boundary_sets[name] = std::move(set);
    }
}

}  // namespace

template <int d>
std::optional<std::array<int, d>> elements_per_direction(const io::Discretization& discretization) {
    const std::vector<int>& given = discretization.elements;
    if (given.empty()) {
        return {};
    }
    if (given.size() != 1 && given.size() != d) {
        throw InputError(
            "{}: 'elements' of [discretization] has {} numbers; the geometry has {} "
            "directions: give one number or {}",
            discretization.source, given.size(), d, d);
    }
    std::array<int, d> result;
    for (std::size_t k = 0; k < d; ++k) {
        result[k] = given.size() == 1 ? given[0] : given[k];
    }
    return result;
}

template <int d>
iga::PatchEntity<d> parse_entity(const std::string& text, int n_patches) {
    const auto fail = [&](const std::string& why) {
        throw InputError(
            "'{}': {}; write for example 'patch 3 side 0:low' or 'patch 3 {} 0:low "
            "1:high'",
            text, why, d == 3 ? "edge" : "corner");
    };
    std::istringstream words(text);
    std::string patch_word;
    std::string kind;
    iga::PatchEntity<d> entity;
    if (!(words >> patch_word >> entity.patch >> kind) || patch_word != "patch") {
        fail("is no patch entity");
    }
    if (entity.patch < 0 || entity.patch >= n_patches) {
        fail(fmt::format("there is no patch {}, the geometry has patches 0 to {}", entity.patch,
                         n_patches - 1));
    }
    for (std::string word; words >> word;) {
        const int direction = word.size() > 2 && word[1] == ':' ? word[0] - '0' : -1;
        const std::string end = word.substr(std::min<std::size_t>(2, word.size()));
        if (direction < 0 || direction >= d || (end != "low" && end != "high")) {
            fail(fmt::format("'{}' is none of 0:low ... {}:high", word, d - 1));
        }
        entity.position[direction] = end == "low" ? iga::End::low : iga::End::high;
    }
    if (kind != "side" && kind != "corner" && (kind != "edge" || d == 2)) {
        fail(fmt::format("'{}' is none of {}", kind,
                         d == 3 ? "side, edge, corner" : "side, corner"));
    }
    const int dimension = kind == "side" ? d - 1 : kind == "edge" ? 1 : 0;
    if (entity.dimension() != dimension) {
        fail(fmt::format("{} {} fixes {} directions", kind == "edge" ? "an" : "a", kind,
                         d - dimension));
    }
    return entity;
}

io::AnyMultiPatch load_geometry(const io::Deck& deck) {
    io::AnyMultiPatch geometry;
    if (!deck.geometry.file.empty()) {
        io::SplineFile file = io::read_splines(deck.geometry.file);
        for (const std::string& note : file.notes) {
            log::info(fmt::format("{}: {}", deck.geometry.file.filename().string(), note));
        }
        geometry = std::move(file.multipatch);
    } else if (!deck.geometry.mesh.empty()) {
        geometry = std::move(mesh_geometry(deck).solid->volume->volume);
    } else {
        try {
            geometry = meshing::make_part(deck.geometry.part, deck.geometry.parameters);
        } catch (const InputError& error) {
            throw InputError("{}: {}", deck.geometry.source, error.what());
        }
    }
    add_deck_sets(deck.geometry, geometry);
    return geometry;
}

void add_deck_sets(const io::GeometrySource& source, io::AnyMultiPatch& geometry) {
    std::visit([&](auto& multipatch) { add_sets(source, multipatch); }, geometry);
}

namespace {

constexpr double gigabyte = 1024.0 * 1024.0 * 1024.0;

/// What a deck asks for, before anything of that size is made.
struct ProblemSize {
    double n_functions = 0.0;
    /// Bytes of one triangle of the block matrix: every function meets (2 degree + 1)^d others.
    double matrix_memory = 0.0;
    /// Of the same applied without it.
    double operator_memory = 0.0;
};

template <int d>
ProblemSize estimate_size(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                          int n_components) {
    ProblemSize size;
    const std::vector<int>& elements = deck.discretization.elements;
    const double block_bytes = 8.0 * n_components * n_components + 4.0;
    for (const iga::Patch<d>& patch : geometry.patches) {
        double functions = 1.0;
        double blocks = 1.0;
        double points = 1.0;
        for (int k = 0; k < d; ++k) {
            const iga::KnotVector& knots = patch.knots(k);
            const bool is_exact = !deck.discretization.interpolates_geometry;
            const int given = deck.discretization.degree.value_or(knots.degree());
            const int degree = is_exact ? std::max(given, knots.degree()) : given;
            const double now = knots.n_elements();
            const double wanted =
                elements.empty() ? now : elements[std::min<std::size_t>(k, elements.size() - 1)];
            // At least: new knots simple, those of the geometry as often as they are.
            const double n = std::max(now * std::ceil(wanted / now) + degree,
                                      is_exact ? static_cast<double>(knots.n_basis()) : 0.0);
            functions *= n;
            blocks *= n * std::min(2.0 * degree + 1.0, n);
            points *= (n - degree) * deck.discretization.n_gauss_points.value_or(degree + 1);
        }
        size.n_functions += functions;
        size.matrix_memory += 0.5 * blocks * block_bytes;
        // The map's derivatives at each point, and the vectors of conjugate gradients.
        constexpr double vectors = 20.0;
        const double numbers_per_point = patch.is_rational() ? (d + 1) * (d + 1) + 1 : d * d + 1;
        size.operator_memory +=
            8.0 * (points * numbers_per_point + vectors * n_components * functions);
    }
    return size;
}

/// Throws before the first large array is made.
template <int d>
void check_size(const io::Deck& deck, const iga::MultiPatch<d>& geometry, int n_components) {
    const ProblemSize size = estimate_size<d>(deck, geometry, n_components);
    const auto available = static_cast<double>(available_memory());
    const std::string& solver = deck.solver.name;
    const bool is_matrix_free =
        solver == "matrix_free" || (solver == "auto" && d == 3 && !deck.is_hyperelastic());
    // "auto" goes by what fits.
    double needed = is_matrix_free ? size.operator_memory : size.matrix_memory;
    if (solver == "auto") {
        needed = std::min(needed, size.matrix_memory);
    }
    if (needed > available) {
        throw SolverError(
            "{}: the {} of {:.3g} unknowns takes about {:.3g} GB, {:.3g} GB of memory are "
            "free; "
            "take fewer 'elements' or a lower 'degree' in [discretization]",
            deck.path.string(), is_matrix_free ? "operator" : "matrix",
            n_components * size.n_functions, needed / gigabyte, available / gigabyte);
    }
    if (n_components * size.n_functions > std::numeric_limits<int>::max()) {
        throw SolverError(
            "{}: {:.3g} unknowns are more than can be numbered ({}); take fewer "
            "'elements' in [discretization]",
            deck.path.string(), n_components * size.n_functions, std::numeric_limits<int>::max());
    }
}

}  // namespace

template <int d>
iga::SpacePtr<d> make_space(const io::Deck& deck, const iga::MultiPatch<d>& geometry) {
    const io::Discretization& discretization = deck.discretization;
    check_size<d>(deck, geometry, deck.problem.physics == iga::Physics::poisson ? 1 : d);
    const auto elements = elements_per_direction<d>(discretization);
    try {
        return std::make_shared<const iga::Space<d>>(
            discretization.interpolates_geometry
                ? iga::interpolate<d>(geometry, discretization.degree, elements)
                : iga::refine<d>(geometry, discretization.degree, elements));
    } catch (const InputError& error) {
        throw InputError("{}: [discretization]: {}", discretization.source, error.what());
    }
}

template std::optional<std::array<int, 2>> elements_per_direction<2>(const io::Discretization&);
template std::optional<std::array<int, 3>> elements_per_direction<3>(const io::Discretization&);
template iga::PatchEntity<2> parse_entity<2>(const std::string&, int);
template iga::PatchEntity<3> parse_entity<3>(const std::string&, int);
template iga::SpacePtr<2> make_space<2>(const io::Deck&, const iga::MultiPatch<2>&);
template iga::SpacePtr<3> make_space<3>(const io::Deck&, const iga::MultiPatch<3>&);

}  // namespace couture::drivers
