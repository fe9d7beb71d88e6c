#include "iga/mechanics/kinematics.h"

#include <algorithm>
#include <numbers>

#include "iga/core/error.h"

namespace couture::iga {

template <int d>
Eigen::Matrix<double, 6, d*(d + 1)> strain_operator(Kinematics kinematics, const Vector3& x) {
    Eigen::Matrix<double, 6, d*(d + 1)> E = Eigen::Matrix<double, 6, d*(d + 1)>::Zero();
    const auto column = [](int a, int s) { return a * (d + 1) + s; };
    for (int a = 0; a < d; ++a) {
        E(a, column(a, a)) = 1.0;
    }
    E(5, column(0, 1)) = E(5, column(1, 0)) = 1.0;
    if constexpr (d == 3) {
        E(3, column(1, 2)) = E(3, column(2, 1)) = 1.0;
        E(4, column(0, 2)) = E(4, column(2, 0)) = 1.0;
    } else if (kinematics == Kinematics::axisymmetric) {
        E(2, column(0, d)) = 1.0 / x[0];
    }
    return E;
}

double measure(Kinematics kinematics, double thickness, const Vector3& x) {
    switch (kinematics) {
        case Kinematics::solid:
            return 1.0;
        case Kinematics::axisymmetric:
            return 2.0 * std::numbers::pi * x[0];
        case Kinematics::plane_strain:
        case Kinematics::plane_stress:
            break;
    }
    return thickness;
}

ElasticStiffness effective_stiffness(Kinematics kinematics, const ElasticStiffness& stiffness) {
    return kinematics == Kinematics::plane_stress ? condense_plane_stress(stiffness) : stiffness;
}

std::vector<int> materials_of_patches(const Problem& problem, int n_patches) {
    std::vector<int> result(n_patches, -1);
    for (std::size_t m = 0; m < problem.materials.size(); ++m) {
        const Material& material = problem.materials[m];
        PatchList patches = material.patches;
        if (patches.empty()) {
            patches.resize(n_patches);
            for (int p = 0; p < n_patches; ++p) {
                patches[p] = p;
            }
        }
        for (const int p : patches) {
            if (p < 0 || p >= n_patches) {
                throw InputError("material '{}': patch {}; the part has patches 0 to {}",
                                 material.name, p, n_patches - 1);
            }
            if (result[p] >= 0) {
                throw InputError(
                    "patch {} has two materials, '{}' and '{}'; list the patches of "
                    "each",
                    p, problem.materials[result[p]].name, material.name);
            }
            result[p] = static_cast<int>(m);
        }
    }
    const auto without = std::find(result.begin(), result.end(), -1);
    if (without != result.end()) {
        throw InputError("patch {} has no material; give one without 'patches', or list it",
                         without - result.begin());
    }
    return result;
}

void check_kinematics(const Problem& problem, int dimension) {
    if (problem.physics == Physics::elasticity && dimension == 3 &&
        problem.kinematics != Kinematics::solid) {
        throw InputError(
            "a volume is solved as kinematics = \"solid\"; plane and axisymmetric "
            "kinematics need a part in the plane");
    }
    if (problem.physics == Physics::elasticity && dimension == 2 &&
        problem.kinematics == Kinematics::solid) {
        throw InputError(
            "a part in the plane needs kinematics = \"plane_strain\", "
            "\"plane_stress\" or \"axisymmetric\"");
    }
    if (!(problem.thickness > 0.0)) {
        throw InputError("thickness = {}; must be positive", problem.thickness);
    }
}

template Eigen::Matrix<double, 6, 6> strain_operator<2>(Kinematics, const Vector3&);
template Eigen::Matrix<double, 6, 12> strain_operator<3>(Kinematics, const Vector3&);

}  // namespace couture::iga
