#pragma once

#include "meshing/layout/volumetric_layout.h"

namespace couture::test {

/// Cuboids in a ring, one behind the other; nodes 4 i .. 4 i + 3 between two of them.
inline meshing::VolumetricLayout ring_of_cuboids(int n) {
    meshing::VolumetricLayout ring;
    ring.n_nodes = 4 * n;
    for (int c = 0; c < n; ++c) {
        const int a = 4 * c;
        const int b = 4 * ((c + 1) % n);
        ring.cuboids.push_back({a, b, a + 1, b + 1, a + 2, b + 2, a + 3, b + 3});
    }
    return ring;
}

}  // namespace couture::test
