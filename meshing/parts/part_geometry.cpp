#include "meshing/parts/part_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "iga/spline/shapes.h"

namespace couture::meshing {

namespace {

using iga::KnotVector;
using iga::MultiPatch;
using iga::Patch;
using iga::PatchEntity;
using iga::TensorSpace;

template <int d, std::size_t... k>
TensorSpace<d + 1> with_linear_first(const TensorSpace<d>& space, std::index_sequence<k...>) {
    return {{KnotVector::uniform(1, 1), space.knots[k]...}};
}

/// Points of an entity on a grid that is not symmetric about its centre.
template <int d>
std::vector<Vector3> sample(const MultiPatch<d>& multipatch, const PatchEntity<d>& entity) {
    constexpr std::array<double, 5> fractions = {0.0, 0.3, 0.5, 0.8, 1.0};
    const Patch<d>& patch = multipatch.patches[entity.patch];
    std::vector<Vector<d>> parameters = {Vector<d>::Zero()};
    for (int k = 0; k < d; ++k) {
        const double front = patch.knots(k).front();
        const double back = patch.knots(k).back();
        std::vector<Vector<d>> next;
        for (Vector<d> xi : parameters) {
            if (entity.position[k] != iga::End::free) {
                xi[k] = entity.position[k] == iga::End::low ? front : back;
                next.push_back(xi);
                continue;
            }
            for (const double fraction : fractions) {
                xi[k] = fraction == 1.0 ? back : front + fraction * (back - front);
                next.push_back(xi);
            }
        }
        parameters = std::move(next);
    }
    std::vector<Vector3> points;
    for (const Vector<d>& xi : parameters) {
        Vector3 point = Vector3::Zero();
        const VectorX x = patch.point(xi);
        for (int i = 0; i < x.size(); ++i) {
            point[i] = x[i];
        }
        points.push_back(point);
    }
    return points;
}

template <int d>
bool lies_on(const MultiPatch<d>& multipatch, const PatchEntity<d>& entity, const Place& place) {
    const std::vector<Vector3> points = sample(multipatch, entity);
    return std::all_of(points.begin(), points.end(), place);
}

/// The middle of the grid of `sample`: the same point for entities that coincide.
template <int d>
Vector3 centre(const MultiPatch<d>& multipatch, const PatchEntity<d>& entity) {
    const std::vector<Vector3> points = sample(multipatch, entity);
    return points[points.size() / 2];
}

}  // namespace

iga::Curve make_segment(const VectorX& from, const VectorX& to, int degree) {
    MatrixX control_points(degree + 1, from.size());
    for (int i = 0; i <= degree; ++i) {
        control_points.row(i) = (from + (to - from) * i / degree).transpose();
    }
    return {TensorSpace<1>{{KnotVector::uniform(degree, 1)}}, control_points};
}

template <int d>
Patch<d + 1> blend(const Patch<d>& low, const Patch<d>& high) {
    const MatrixX low_rows = low.homogeneous();
    const MatrixX high_rows = high.homogeneous();
    MatrixX rows(2 * low_rows.rows(), low_rows.cols());
    for (int i = 0; i < low_rows.rows(); ++i) {
        rows.row(2 * i) = low_rows.row(i);
        rows.row(2 * i + 1) = high_rows.row(i);
    }
    return Patch<d + 1>::from_homogeneous(
        with_linear_first<d>(low.space(), std::make_index_sequence<d>()), rows,
        low.is_rational() || high.is_rational());
}

template <int d>
Patch<d> mapped(const Patch<d>& patch, const std::function<VectorX(const VectorX&)>& map) {
    const MatrixX& from = patch.control_points();
    MatrixX to(from.rows(), map(from.row(0).transpose()).size());
    for (int i = 0; i < from.rows(); ++i) {
        to.row(i) = map(from.row(i).transpose()).transpose();
    }
    return {patch.space(), to, patch.weights()};
}

iga::Volume make_slab(const iga::Surface& surface, double z_low, double z_high) {
    const auto at_height = [&](double z) {
        return mapped<2>(surface,
                         [z](const VectorX& x) -> VectorX { return Vector3(x[0], x[1], z); });
    };
    return iga::make_ruled(at_height(z_low), at_height(z_high));
}

MultiPatch<3> make_slabs(const MultiPatch<2>& plane, double z_low, double z_high) {
    MultiPatch<3> result;
    for (const iga::Surface& surface : plane.patches) {
        result.patches.push_back(make_slab(surface, z_low, z_high));
    }
    return result;
}

Place on_plane(int axis, double value, double tolerance) {
    return [=](const Vector3& x) { return std::abs(x[axis] - value) <= tolerance; };
}

Place on_cylinder(int axis, double radius, double tolerance) {
    return [=](const Vector3& x) {
        const double distance = std::hypot(x[(axis + 1) % 3], x[(axis + 2) % 3]);
        return std::abs(distance - radius) <= tolerance;
    };
}

template <int d>
double place_tolerance(const MultiPatch<d>& multipatch) {
    return 1e-9 * multipatch.size();
}

template <int d>
void name_outer_sides(MultiPatch<d>& multipatch, const std::string& name, const Place& place) {
    for (const PatchEntity<d>& side : multipatch.outer_sides()) {
        if (lies_on(multipatch, side, place)) {
            multipatch.boundary_sets[name].push_back(side);
        }
    }
}

template <int d>
void name_entities(MultiPatch<d>& multipatch, const std::string& name, int dimension,
                   const Place& place) {
    std::vector<Vector3> centres;
    const double tolerance = place_tolerance(multipatch);
    for (int patch = 0; patch < multipatch.n_patches(); ++patch) {
        for (const PatchEntity<d>& entity : iga::entities_of_patch<d>(patch, dimension)) {
            if (!lies_on(multipatch, entity, place)) {
                continue;
            }
            const Vector3 middle = centre(multipatch, entity);
            const bool is_known = std::any_of(
                centres.begin(), centres.end(),
                [&](const Vector3& other) { return (other - middle).norm() <= tolerance; });
            if (!is_known) {
                centres.push_back(middle);
                multipatch.boundary_sets[name].push_back(entity);
            }
        }
    }
}

template Patch<2> blend(const Patch<1>&, const Patch<1>&);
template Patch<3> blend(const Patch<2>&, const Patch<2>&);
template Patch<1> mapped(const Patch<1>&, const std::function<VectorX(const VectorX&)>&);
template Patch<2> mapped(const Patch<2>&, const std::function<VectorX(const VectorX&)>&);
template Patch<3> mapped(const Patch<3>&, const std::function<VectorX(const VectorX&)>&);
template double place_tolerance(const MultiPatch<2>&);
template double place_tolerance(const MultiPatch<3>&);
template void name_outer_sides(MultiPatch<2>&, const std::string&, const Place&);
template void name_outer_sides(MultiPatch<3>&, const std::string&, const Place&);
template void name_entities(MultiPatch<2>&, const std::string&, int, const Place&);
template void name_entities(MultiPatch<3>&, const std::string&, int, const Place&);

}  // namespace couture::meshing
