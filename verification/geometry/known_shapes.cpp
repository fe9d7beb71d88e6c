#include "verification/geometry/known_shapes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/element_quality.h"
#include "iga/topology/jacobian_certificate.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;
using std::numbers::pi;

namespace {

constexpr double volume_bound = 1e-13;

void volumes(Recorder& recorder) {
    recorder.set_source("closed form");
    const auto compare = [&](const std::string& what, double expected, double obtained) {
        recorder.relative(what, expected, obtained, volume_bound);
    };
    compare("quarter annulus, area", 0.75 * pi, volume(part<2>("quarter_annulus")));
    compare("plate with a hole, area", 16.0 - pi / 4.0, volume(part<2>("plate_with_hole")));
    compare("LE1 membrane, area", pi / 4.0 * (3.25 * 2.75 - 2.0 * 1.0),
            volume(part<2>("le1_membrane")));
    compare("hollow sphere, octant", pi / 6.0 * 7.0, volume(part<3>("hollow_sphere")));
    compare("sphere shell, collapsed edge", pi / 6.0 * 7.0, [] {
        MultiPatch<3> shell;
        shell.patches = {make_sphere_shell_patch(1.0, 2.0)};
        return volume(shell);
    }());
    compare("O-grid cylinder", 2.0 * pi, volume(part<3>("cylinder_o_grid")));
    compare("Cook's membrane, area", 48.0 * (44.0 + 16.0) / 2.0, volume(part<2>("cook")));
    // Half ring, and the arm's box less what the cylinder takes of it.
    const double half_width = 13.0;
    const double outer = 40.0;
    const double in_cylinder = half_width * std::sqrt(outer * outer - half_width * half_width) +
                               outer * outer * std::asin(half_width / outer);
    compare("half seal",
            pi / 2.0 * (outer * outer - 25.0 * 25.0) * 31.5 +
                (2.0 * half_width * 65.0 - in_cylinder) * 13.0,
            volume(part<3>("half_seal")));
}

void pipe_tee(Recorder& recorder) {
    constexpr double inner = 0.7;
    constexpr double outer = 1.0;
    constexpr double reach = 2.5;
    const MultiPatch<3> tee = part<3>("pipe_tee");
    recorder.set_source("Steinmetz solid, closed form");
    recorder.relative("volume",
                      (outer * outer - inner * inner) * pi * 3.0 * reach -
                          8.0 / 3.0 * (std::pow(outer, 3) - std::pow(inner, 3)),
                      volume(tee), volume_bound);
    recorder.set_source("count");
    recorder.absolute("interfaces", 18.0, static_cast<double>(tee.interfaces.size()), 0.0);
    recorder.absolute("outer sides", 36.0, static_cast<double>(tee.outer_sides().size()), 0.0);
    int n_valid = 0;
    for (const Patch<3>& patch : tee.patches) {
        n_valid += certify(patch).validity == Validity::valid ? 1 : 0;
    }
    recorder.set_source("Bernstein certificate");
    recorder.absolute("patches proven valid", 12.0, n_valid, 0.0);
    // Where it is smallest, in the middle of the arcs, is a corner of halved elements.
    recorder.set_source("mitre angle, closed form");
    recorder.relative("smallest scaled Jacobian, 2 arcs", 2.0 / 3.0,
                      element_quality(refine<3>(tee, {}, std::array{1, 2, 1})).min_at_corners,
                      1e-12);
    double smallest = std::numeric_limits<double>::infinity();
    for (const Patch<3>& patch : tee.patches) {
        for (int corner = 0; corner < 8; ++corner) {
            const Matrix<3> J = patch.jacobian(Vector3(corner & 1, corner >> 1 & 1, corner >> 2));
            smallest = std::min(smallest, J.determinant());
        }
    }
    recorder.set_source("computed, two digits");
    recorder.absolute("smallest det J at corners", 0.53, smallest, 5e-3);
}

/// Volumes with a determinant known in closed form: valid, left-handed, collapsed, folded.
void certificates(Recorder& recorder) {
    recorder.set_source("determinant in closed form");
    const auto is = [](const Patch<3>& patch, Validity validity, int orientation) {
        const PatchCertificate<3> found = certify(patch);
        return found.validity == validity && found.orientation == orientation ? 1.0 : 0.0;
    };
    const Patch<3> box = make_box<3>(Vector3(1.0, 2.0, 3.0));
    recorder.absolute("box: smallest det J", 6.0, certify(box).min_jacobian, 1e-13);
    recorder.absolute("box: valid", 1.0, is(box, Validity::valid, 1), 0.0);
    MatrixX mirrored = box.control_points();
    mirrored.col(0) *= -1.0;
    recorder.absolute("mirrored box: valid, left-handed", 1.0,
                      is({box.space(), mirrored}, Validity::valid, -1), 0.0);
    recorder.absolute("sphere shell: collapsed on one side", 1.0,
                      is(make_sphere_shell_patch(1.0, 2.0), Validity::degenerate, 1), 0.0);
    MatrixX folded = box.control_points();
    folded.row(7) = Vector3(-1.0, -1.0, 3.0).transpose();
    recorder.absolute("corner pushed through: folded", 1.0,
                      certify(Patch<3>(box.space(), folded)).validity == Validity::folded, 0.0);
}

}  // namespace

std::vector<Case> known_shape_cases() {
    return {{"geometry: volumes", false, volumes},
            {"geometry: pipe tee", false, pipe_tee},
            {"geometry: certificates", false, certificates}};
}

}  // namespace couture::verification
