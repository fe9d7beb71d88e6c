#pragma once

#include "iga/mechanics/problem.h"

namespace couture::iga::tests {

/// A neo-Hookean body, mu = 3, kappa = 20.
inline Problem rubber(Kinematics kinematics) {
    Problem problem;
    problem.kinematics = kinematics;
    problem.materials.resize(1);
    problem.materials[0].name = "rubber";
    problem.materials[0].hyperelastic = make_hyperelastic(StoredEnergy::neo_hookean, 3.0, 20.0);
    return problem;
}

/// A block of sides "side_0" to "side_5" stretched along x, free across.
inline Problem stretched_block(double stretch) {
    Problem problem = rubber(Kinematics::solid);
    problem.supports = {make_symmetry("side_0"), make_symmetry("side_2"), make_symmetry("side_4"),
                        make_support("side_1", stretch - 1.0, {}, {})};
    return problem;
}

}  // namespace couture::iga::tests
