#include "iga/topology/locator.h"

#include <limits>

namespace couture::iga {

namespace {

/// Distances below this part of the body's size are rounding.
constexpr double inside = 1e-12;

}  // namespace

template <int d>
Locator<d>::Locator(const MultiPatch<d>& geometry)
    : dimension_(geometry.dimension()), size_(geometry.size()) {
    for (const Patch<d>& patch : geometry.patches) {
        patches_.emplace_back(patch);
    }
}

template <int d>
std::optional<Location<d>> Locator<d>::find(const Vector3& point, double tolerance) const {
    const auto [location, distance] = nearest(point);
    if (distance > tolerance) {
        return std::nullopt;
    }
    return location;
}

template <int d>
std::pair<Location<d>, double> Locator<d>::nearest(const Vector3& point) const {
    Location<d> place{0, Vector<d>::Zero()};
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        const InvertedPoint<d> found = patches_[p].nearest(point.head(dimension_));
        if (found.distance < distance) {
            place = {static_cast<int>(p), found.xi};
            distance = found.distance;
        }
    }
    return {place, distance};
}

template <int d>
std::pair<Location<d>, double> Locator<d>::nearest(const Vector3& point, int patch) const {
    const InvertedPoint<d> found = patches_[patch].nearest(point.head(dimension_));
    if (found.distance <= inside * size_) {
        return {{patch, found.xi}, found.distance};
    }
    return nearest(point);
}

template class Locator<2>;
template class Locator<3>;

}  // namespace couture::iga
