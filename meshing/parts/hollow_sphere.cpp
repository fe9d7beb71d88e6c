#include "meshing/parts/hollow_sphere.h"

#include <cmath>
#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

/// One coefficient of a biquadratic (biquartic) Bernstein polynomial per entry, first index xi.
using Quadratic = Matrix<3>;
using Quartic = Matrix<5>;

/// Bernstein coefficients of the product.
Quartic product(const Quadratic& a, const Quadratic& b) {
    constexpr std::array<double, 3> two = {1, 2, 1};
    constexpr std::array<double, 5> four = {1, 4, 6, 4, 1};
    Quartic result = Quartic::Zero();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k) {
                for (int l = 0; l < 3; ++l) {
                    result(i + k, j + l) += two[i] * two[j] * two[k] * two[l] /
                                            (four[i + k] * four[j + l]) * a(i, j) * b(k, l);
                }
            }
        }
    }
    return result;
}

/// Biquadratic Coons patch of one homogeneous coordinate from its boundary coefficients; the
/// middle one of `boundary` is not read.
Quadratic blend_boundary(Quadratic boundary) {
    const Quadratic& b = boundary;
    boundary(1, 1) =
        (b(0, 1) + b(2, 1) + b(1, 0) + b(1, 2)) / 2 - (b(0, 0) + b(2, 0) + b(0, 2) + b(2, 2)) / 4;
    return boundary;
}

/// The third of the octant around e_x, seen from -e_x: (U, V, W) with stereographic coordinates
/// u = U / W, v = V / W. Bounded by v = 0, u = 0 and the images of the planes x = y and x = z,
/// arcs of 15 degrees of the circles of radius sqrt 2 about (-1, 0) and (0, -1).
std::array<Quadratic, 3> make_plane_region() {
    constexpr double half_arc = std::numbers::pi / 24;
    const double radius = std::numbers::sqrt2;
    const double a = radius - 1;                     // image of (1, 1, 0) / sqrt 2
    const double c = (std::numbers::sqrt3 - 1) / 2;  // of (1, 1, 1) / sqrt 3
    const double weight = std::cos(half_arc);        // middle of the arc
    const double tangent = radius * std::tan(half_arc);
    Quadratic U;
    Quadratic V;
    Quadratic W;
    U << 0, 0, 0,                    //
        a / 2, 0, weight * tangent,  //
        a, weight * a, c;
    V = U.transpose();
    W << 1, 1, 1,      //
        1, 0, weight,  //
        1, weight, 1;
    return {blend_boundary(U), blend_boundary(V), blend_boundary(W)};
}

/// A third of the octant of the sphere: coordinate i of the point goes to axis (i + turn) mod 3.
iga::Surface make_tile(double radius, int turn) {
    const auto [U, V, W] = make_plane_region();
    const Quartic UU = product(U, U);
    const Quartic VV = product(V, V);
    const Quartic WW = product(W, W);
    const std::array<Quartic, 3> x = {WW - UU - VV, 2 * product(U, W), 2 * product(V, W)};
    const Quartic w = WW + UU + VV;
    const iga::KnotVector knots = iga::KnotVector::uniform(4, 1);
    const iga::TensorSpace<2> space{{knots, knots}};
    MatrixX rows(space.n_basis(), 4);
    for (int index = 0; index < space.n_basis(); ++index) {
        const auto [i, j] = space.indices(index);
        for (int axis = 0; axis < 3; ++axis) {
            rows(index, (axis + turn) % 3) = radius * x[axis](i, j);
        }
        rows(index, 3) = w(i, j);
    }
    return iga::Surface::from_homogeneous(space, rows, true);
}

iga::MultiPatch<3> make_hollow_sphere(const PartValues& values) {
    check_less("hollow_sphere", values, "inner_radius", "outer_radius");
    iga::MultiPatch<3> octant;
    iga::BoundarySet<3> inner;
    iga::BoundarySet<3> outer;
    for (int turn = 0; turn < 3; ++turn) {
        octant.patches.push_back(blend<2>(make_tile(values.at("inner_radius"), turn),
                                          make_tile(values.at("outer_radius"), turn)));
        inner.push_back(iga::make_side<3>(turn, 0));
        outer.push_back(iga::make_side<3>(turn, 1));
    }
    iga::find_interfaces(octant, interface_tolerance);
    octant.boundary_sets = {{"inner", inner}, {"outer", outer}};
    const double tolerance = place_tolerance(octant);
    name_outer_sides(octant, "cut_x", on_plane(0, 0.0, tolerance));
    name_outer_sides(octant, "cut_y", on_plane(1, 0.0, tolerance));
    name_outer_sides(octant, "cut_z", on_plane(2, 0.0, tolerance));
    return octant;
}

}  // namespace

std::vector<PartDefinition> hollow_sphere_parts() {
    return {
        {{"hollow_sphere",
          "First octant of a spherical shell about the origin, three patches of degree (1, 4, 4). "
          "Sets: inner, outer, cut_x (x = 0), cut_y (y = 0), cut_z (z = 0).",
          {length_parameter("inner_radius", 1.0, "inner radius"),
           length_parameter("outer_radius", 2.0, "outer radius, larger than the inner")},
          3},
         make_hollow_sphere}};
}

}  // namespace couture::meshing
