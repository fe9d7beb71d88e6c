#include "drivers/deck_check.h"

#include <algorithm>
#include <set>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/core/log.h"
#include "io/did_you_mean.h"

namespace couture::drivers {

namespace {

template <int d>
class DeckCheck {
  public:
    DeckCheck(const io::Deck& deck, const iga::MultiPatch<d>& geometry)
        : deck_(deck), problem_(deck.problem), geometry_(geometry) {
        for (const auto& [name, set] : geometry.boundary_sets) {
            set_names_.push_back(name);
        }
    }

    void run() {
        check_kinematics();
        check_materials();
        check_sets();
        check_patches();
        check_probes();
        warn_of_points();
        if (!messages_.empty()) {
            throw InputError("{}", fmt::join(messages_, "\n"));
        }
    }

  private:
    void add(const std::string& source, const std::string& word, const std::string& message) {
        messages_.push_back(io::located_in(deck_, source, word, message));
    }

    /// Too few points leave motions of the elements without energy.
    void warn_of_points() const {
        if (!deck_.discretization.n_gauss_points) {
            return;
        }
        int degree = deck_.discretization.degree.value_or(0);
        for (const iga::Patch<d>& patch : geometry_.patches) {
            for (int k = 0; k < d; ++k) {
                degree = std::max(degree, patch.knots(k).degree());
            }
        }
        if (*deck_.discretization.n_gauss_points <= degree) {
            log::warn(fmt::format(
                "gauss_points = {} of [discretization] are fewer than degree + 1 = {}: the matrix "
                "may be singular and results less accurate",
                *deck_.discretization.n_gauss_points, degree + 1));
        }
    }

    void check_kinematics() {
        const bool is_solid = problem_.kinematics == iga::Kinematics::solid;
        if (problem_.physics == iga::Physics::elasticity && is_solid != (d == 3)) {
            add(deck_.geometry.source, "",
                d == 3 ? "the geometry is a volume: [analysis] must have kinematics = 'solid'"
                       : "the geometry is plane: [analysis] needs kinematics = 'plane_strain', "
                         "'plane_stress' or 'axisymmetric'");
        }
        if (problem_.kinematics == iga::Kinematics::axisymmetric &&
            geometry_.bounding_box()(0, 0) < -1e-9 * geometry_.size()) {
            add(deck_.geometry.source, "",
                fmt::format(
                    "the geometry reaches x = {:g}; in axisymmetric problems x is the radius "
                    "and must be at least 0",
                    geometry_.bounding_box()(0, 0)));
        }
        if (geometry_.dimension() != d) {
            add(deck_.geometry.source, "",
                fmt::format("the geometry is a surface in space ({} coordinates); the solver "
                            "takes volumes, or surfaces in the plane",
                            geometry_.dimension()));
        }
    }

    void check_patch_list(const iga::PatchList& patches, const std::string& source,
                          const std::string& owner) {
        for (const int patch : patches) {
            if (patch >= geometry_.n_patches()) {
                add(source, "patches",
                    fmt::format("{} names patch {}; the geometry has patches 0 to {}", owner, patch,
                                geometry_.n_patches() - 1));
            }
        }
    }

    void check_materials() {
        std::vector<std::string> owner(static_cast<std::size_t>(geometry_.n_patches()));
        for (const iga::Material& material : problem_.materials) {
            const std::string title = fmt::format("[material.{}]", material.name);
            check_patch_list(material.patches, deck_.path.filename().string(), title);
            for (int patch = 0; patch < geometry_.n_patches(); ++patch) {
                const auto& list = material.patches;
                if (!list.empty() && std::find(list.begin(), list.end(), patch) == list.end()) {
                    continue;
                }
                std::string& name = owner[static_cast<std::size_t>(patch)];
                if (!name.empty()) {
                    add(deck_.path.filename().string(), "",
                        fmt::format("patch {} belongs to both [material.{}] and {}; give each "
                                    "material its 'patches'",
                                    patch, name, title));
                    return;
                }
                name = material.name;
            }
        }
        std::vector<int> bare;
        for (int patch = 0; patch < geometry_.n_patches(); ++patch) {
            if (owner[static_cast<std::size_t>(patch)].empty()) {
                bare.push_back(patch);
            }
        }
        if (!bare.empty()) {
            add(deck_.path.filename().string(), "",
                fmt::format("no material holds for patch {}; add it to the 'patches' of one",
                            fmt::join(bare, ", ")));
        }
    }

    /// @param least_dimension  of the entities that the entry can act on
    void check_set(const iga::Entry& entry, const std::string& name, int least_dimension,
                   const std::string& what) {
        const auto found = geometry_.boundary_sets.find(name);
        if (found == geometry_.boundary_sets.end()) {
            std::string help = io::did_you_mean(name, set_names_);
            help += fmt::format("{} {}", help.empty() ? "; there are" : " There are",
                                io::quoted_list(set_names_));
            add(entry.source, name, fmt::format("unknown set '{}'{}", name, help));
            return;
        }
        for (const iga::PatchEntity<d>& entity : found->second) {
            if (entity.dimension() < least_dimension) {
                add(entry.source, name,
                    fmt::format("{} can't act on set '{}': it holds '{}'; it needs {}", what, name,
                                entity.name(),
                                least_dimension == d - 1 ? "sides" : "sides or edges"));
                return;
            }
        }
    }

    void check_sets() {
        for (const auto& support : problem_.supports) {
            check_set(support, support.on, support.normal ? d - 1 : 0, "a normal displacement");
        }
        for (const auto& foundation : problem_.foundations) {
            check_set(foundation, foundation.on, d - 1, "a foundation");
        }
        for (const auto& traction : problem_.tractions) {
            check_set(traction, traction.on, 1, "a traction");
        }
        for (const auto& pressure : problem_.pressures) {
            check_set(pressure, pressure.on, d - 1, "a pressure");
        }
        for (const auto& resultant : problem_.resultants) {
            check_set(resultant, resultant.on, d - 1, "a resultant");
        }
        for (const auto& load : problem_.point_loads) {
            if (!load.at) {
                check_set(load, load.on, 0, "a point load");
            }
        }
    }

    void check_patches() {
        for (const auto& force : problem_.body_forces) {
            check_patch_list(force.patches, force.source, "this load");
        }
        for (const auto& temperature : problem_.temperatures) {
            check_patch_list(temperature.patches, temperature.source, "[[temperature]]");
        }
    }

    void check_probes() {
        std::set<std::string> supported;
        for (const auto& support : problem_.supports) {
            supported.insert(support.on);
        }
        for (const io::Probe& probe : deck_.probes) {
            if (!probe.on.empty() && supported.count(probe.on) == 0) {
                add(probe.source, probe.on,
                    fmt::format("'{}' needs the set of a support; supported are {}", probe.quantity,
                                io::quoted_list({supported.begin(), supported.end()})));
            }
            if (probe.patch && *probe.patch >= geometry_.n_patches()) {
                check_patch_list({*probe.patch}, probe.source, "the probe");
            }
            if (probe.patch && probe.xi.size() != d) {
                add(probe.source, "xi",
                    fmt::format("'xi' has {} numbers; the patch has {} directions", probe.xi.size(),
                                d));
            }
        }
    }

    const io::Deck& deck_;
    const iga::Problem& problem_;
    const iga::MultiPatch<d>& geometry_;
    std::vector<std::string> set_names_;
    std::vector<std::string> messages_;
};

}  // namespace

namespace {

/// Warns of folds that no quadrature point may see, and of places where the map is singular.
template <int d>
GeometryCertificate certify_patches(const iga::MultiPatch<d>& geometry) {
    GeometryCertificate whole;
    for (int p = 0; p < geometry.n_patches(); ++p) {
        const iga::PatchCertificate<d> certificate = iga::certify(geometry.patches[p]);
        whole.validity = std::max(whole.validity, certificate.validity);
        if (certificate.min_jacobian < whole.min_jacobian) {
            whole.min_jacobian = certificate.min_jacobian;
            whole.patch = p;
        }
        const std::string where = fmt::format(
            "det J = {:.3g} at parameter {}, position {}",
            certificate.orientation * certificate.min_jacobian, format_point(certificate.min_xi),
            format_point(geometry.patches[p].point(certificate.min_xi)));
        switch (certificate.validity) {
            case iga::Validity::folded:
                log::warn(
                    fmt::format("patch {} is folded: {}; results near it mean nothing, repair "
                                "the geometry there",
                                p, where));
                break;
            case iga::Validity::degenerate:
                log::warn(
                    fmt::format("patch {} is singular on a side, edge or corner: {}; "
                                "stresses there are not defined",
                                p, where));
                break;
            case iga::Validity::undecided:
                log::warn(fmt::format("patch {}: not proven free of folds; smallest {}", p, where));
                break;
            case iga::Validity::valid:
                break;
        }
    }
    return whole;
}

}  // namespace

template <int d>
GeometryCertificate check_deck(const io::Deck& deck, const iga::MultiPatch<d>& geometry) {
    DeckCheck<d>(deck, geometry).run();
    return certify_patches(geometry);
}

template GeometryCertificate check_deck<2>(const io::Deck&, const iga::MultiPatch<2>&);
template GeometryCertificate check_deck<3>(const io::Deck&, const iga::MultiPatch<3>&);

}  // namespace couture::drivers
