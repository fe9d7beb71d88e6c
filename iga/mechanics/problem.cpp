#include "iga/mechanics/problem.h"

#include <algorithm>

namespace couture::iga {

std::vector<std::string> Problem::load_cases() const {
    std::vector<std::string> names;
    const auto add = [&names](const auto& entries) {
        for (const Entry& entry : entries) {
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

}  // namespace couture::iga
