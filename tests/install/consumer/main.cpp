// A quarter of a ring, refined, evaluated and written, by a program outside of Couture's tree that
// is compiled for any processor. Matrices and their memory go both ways across the library's
// border.
#include <cmath>
#include <cstdio>
#include <exception>

#include "iga/spline/patch.h"

namespace {

using namespace couture;

// The quarter ring between radius 1 and 2, in homogeneous rows (w x, w y, w).
iga::Surface make_ring() {
    const double w = std::sqrt(0.5);
    const std::array knots = {iga::KnotVector(1, {0, 0, 1, 1}),
                              iga::KnotVector(2, {0, 0, 0, 1, 1, 1})};
    MatrixX rows(6, 3);
    rows << 1, 0, 1, 2, 0, 1, w, w, w, 2 * w, 2 * w, w, 0, 1, 1, 0, 2, 1;
    return iga::Surface::from_homogeneous({knots}, rows, true);
}

bool is_near(const char* what, double value, double expected) {
    std::printf("%-28s %.15g (expected %.15g)\n", what, value, expected);
    return std::abs(value - expected) < 1e-12;
}

}  // namespace

int main() try {
    const iga::Surface ring = make_ring();
    // Ours, moved into the library, copied there and back, freed here.
    MatrixX rows = ring.homogeneous();
    rows *= 2.0;
    const iga::Surface same = iga::Surface::from_homogeneous(ring.space(), rows, true);

    bool is_good = true;
    for (const double eta : {0.0, 0.3, 1.0}) {
        const VectorX x = same.point(Vector2(0.5, eta));
        is_good &= is_near("radius at half thickness", x.norm(), 1.5);
    }
    const MatrixX J = same.jacobian(Vector2(0.0, 0.0));
    is_good &=
        is_near("det J at the corner", J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0), std::sqrt(2.0));
    return is_good ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
