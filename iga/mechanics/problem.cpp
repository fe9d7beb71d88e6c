#include "iga/mechanics/problem.h"

#include <algorithm>

namespace couture::iga {

double Amplitude::operator()(double t) const {
    const auto next = std::upper_bound(times.begin(), times.end(), t);
    if (next == times.begin()) {
        return values.front();
    }
    if (next == times.end()) {
        return values.back();
    }
    const auto i = next - times.begin();
    const double share = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return (1.0 - share) * values[i - 1] + share * values[i];
}

std::vector<std::string> Problem::load_cases() const {
    std::vector<std::string> names;
    const auto add = [&names](const auto& entries) {
        for (const CaseEntry& entry : entries) {
            if (!entry.load_case.empty() &&
                std::find(names.begin(), names.end(), entry.load_case) == names.end()) {
                names.push_back(entry.load_case);
            }
        }
    };
    add(supports);
    add(tractions);
    add(pressures);
    add(body_forces);
    add(point_loads);
    add(resultants);
    add(temperatures);
    if (names.empty()) {
        names.emplace_back();
    }
    return names;
}

Problem at_time(const Problem& problem, double t, double end) {
    const auto share = [&](const CaseEntry& entry) {
        if (entry.amplitude) {
            return (*entry.amplitude)(t);
        }
        return entry.follows_time ? 1.0 : t / end;
    };
    const auto freeze = [&](const CaseEntry& entry, Function& value) {
        if (value) {
            value = [value, t, factor = share(entry)](const Vector3& x, double) {
                return factor * value(x, t);
            };
        }
    };
    Problem now = problem;
    for (Support& support : now.supports) {
        for (std::optional<Function>& component : support.components) {
            if (component) {
                freeze(support, *component);
            }
        }
        if (support.normal) {
            freeze(support, *support.normal);
        }
    }
    for (Traction& traction : now.tractions) {
        for (Function& component : traction.components) {
            freeze(traction, component);
        }
    }
    for (Pressure& pressure : now.pressures) {
        freeze(pressure, pressure.value);
    }
    for (BodyForce& force : now.body_forces) {
        for (Function& component : force.components) {
            freeze(force, component);
        }
    }
    for (Temperature& temperature : now.temperatures) {
        freeze(temperature, temperature.change);
    }
    for (PointLoad& load : now.point_loads) {
        load.force *= share(load);
    }
    for (Resultant& load : now.resultants) {
        load.force *= share(load);
        load.moment *= share(load);
    }
    return now;
}

Material make_isotropic(const std::string& name, double youngs_modulus, double poissons_ratio) {
    Material material;
    material.name = name;
    material.stiffness = isotropic_stiffness(youngs_modulus, poissons_ratio);
    return material;
}

Support make_support(const std::string& on, std::optional<double> x, std::optional<double> y,
                     std::optional<double> z) {
    Support support;
    support.on = on;
    const std::array<std::optional<double>, 3> values = {x, y, z};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i]) {
            support.components[i] = constant(*values[i]);
        }
    }
    return support;
}

Support make_symmetry(const std::string& on) {
    Support support;
    support.on = on;
    support.normal = constant(0.0);
    return support;
}

Pressure make_pressure(const std::string& on, double value) {
    Pressure load;
    load.on = on;
    load.value = constant(value);
    return load;
}

}  // namespace couture::iga
