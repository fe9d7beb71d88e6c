#include "tests/meshing/volume/volume_samples.h"

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/parts.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

std::vector<double> open_knots(const std::vector<double>& breakpoints) {
    std::vector<double> knots = breakpoints;
    knots.insert(knots.begin(), breakpoints.front());
    knots.push_back(breakpoints.back());
    return knots;
}

iga::Volume through_breakpoints(const iga::Volume& patch) {
    const auto linear = [&](int k) {
        return iga::KnotVector(1, open_knots(patch.knots(k).breakpoints()));
    };
    const iga::TensorSpace<3> space{{linear(0), linear(1), linear(2)}};
    MatrixX points(space.n_basis(), 3);
    for (int i = 0; i < space.n_basis(); ++i) {
        const std::array<int, 3> index = space.indices(i);
        Vector3 xi;
        for (int k = 0; k < 3; ++k) {
            xi[k] = patch.knots(k).breakpoints()[index[k]];
        }
        points.row(i) = patch.point(xi).transpose();
    }
    return {space, points};
}

}  // namespace

MultiPatch<3> cube_of(int degree, int n) {
    MultiPatch<3> cube;
    cube.patches.push_back(iga::make_box<3>(Vector3::Ones()));
    return iga::refine<3>(cube, degree, std::array<int, 3>{n, n, n});
}

MultiPatch<3> two_patch_cube(int degree, int n) {
    MultiPatch<3> cube;
    const iga::Volume half = iga::make_box<3>(Vector3(0.5, 1.0, 1.0));
    MatrixX points = half.control_points();
    points.col(0).array() += 0.5;
    cube.patches = {half, iga::Volume(half.space(), points)};
    (void)iga::find_interfaces(cube);
    return iga::refine<3>(cube, degree, std::array<int, 3>{n / 2, n, n});
}

MultiPatch<3> part_of(const std::string& name, int degree, int n) {
    MultiPatch<3> part = iga::refine<3>(std::get<MultiPatch<3>>(make_part(name)),
                                        degree == 1 ? 2 : degree, std::array<int, 3>{n, n, n});
    if (degree == 1) {
        for (iga::Volume& patch : part.patches) {
            patch = through_breakpoints(patch);
        }
    }
    return part;
}

MultiPatch<3> moved(const MultiPatch<3>& volume,
                    const std::function<Vector3(const Vector3&)>& map) {
    MultiPatch<3> result = volume;
    for (iga::Volume& patch : result.patches) {
        MatrixX points = patch.control_points();
        for (int i = 0; i < points.rows(); ++i) {
            points.row(i) = map(points.row(i).transpose()).transpose();
        }
        patch = iga::Volume(patch.space(), points, patch.weights());
    }
    return result;
}

}  // namespace couture::meshing
