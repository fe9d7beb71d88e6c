#include "iga/post/locator.h"

#include <limits>

namespace couture::iga {

template <int d>
Locator<d>::Locator(const MultiPatch<d>& geometry) : dimension_(geometry.dimension()) {
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

template class Locator<2>;
template class Locator<3>;

}  // namespace couture::iga
