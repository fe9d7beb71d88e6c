#include "meshing/surface/cavity_center.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double least_enclosed = 0.75;

/// Cubes along the longest side of the box; the centres of all cubes are samples.
constexpr int n_samples = 24;

std::vector<CavityPlace> samples_by_distance(const TriangleTree& wall) {
    const auto [low, high] = wall.box();
    const double step = (high - low).maxCoeff() / n_samples;
    Eigen::Vector3i counts;
    for (int axis = 0; axis < 3; ++axis) {
        counts[axis] =
            std::clamp(static_cast<int>(std::ceil((high - low)[axis] / step)), 1, n_samples);
    }
    std::vector<CavityPlace> samples;
    for (int k = 0; k < counts[2]; ++k) {
        for (int j = 0; j < counts[1]; ++j) {
            for (int i = 0; i < counts[0]; ++i) {
                const Vector3 position = low + step * Vector3(i + 0.5, j + 0.5, k + 0.5);
                samples.push_back({position, std::sqrt(wall.nearest(position).squared_distance)});
            }
        }
    }
    std::ranges::stable_sort(samples, std::greater(), &CavityPlace::distance);
    return samples;
}

constexpr int n_directions = 200;

/// Number i of a spiral from pole to pole, by the golden angle.
Vector3 direction(int i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n_directions;
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    return Vector3(r * std::cos(angle), r * std::sin(angle), z).normalized();
}

bool meets_wall(const TriangleTree& wall, const Vector3& position, int i) {
    return wall.first_contact(position, direction(i), 0.0).has_value();
}

/// The same as by enclosed_part, but most places outside are known after a few directions.
bool is_inside(const TriangleTree& wall, const Vector3& position) {
    // All around from the start: without common divisor with the number of directions.
    constexpr int stride = 77;
    const int most_open = static_cast<int>((1.0 - least_enclosed) * n_directions);
    int n_open = 0;
    for (int i = 0; i < n_directions && n_open <= most_open; ++i) {
        n_open += meets_wall(wall, position, i * stride % n_directions) ? 0 : 1;
    }
    return n_open <= most_open;
}

/// Steps along the axes to farther places, halved when there is none.
CavityPlace climb(const TriangleTree& wall, CavityPlace place, double step) {
    const double last_step = step / 64.0;
    while (step > last_step) {
        CavityPlace best = place;
        for (int direction = 0; direction < 6; ++direction) {
            Vector3 position = place.position;
            position[direction / 2] += direction % 2 == 0 ? step : -step;
            const double distance = std::sqrt(wall.nearest(position).squared_distance);
            if (distance > best.distance && is_inside(wall, position)) best = {position, distance};
        }
        if (best.distance > place.distance) {
            place = best;
        } else {
            step /= 2.0;
        }
    }
    return place;
}

}  // namespace

double enclosed_part(const TriangleTree& wall, const Vector3& position) {
    int n_met = 0;
    for (int i = 0; i < n_directions; ++i) n_met += meets_wall(wall, position, i) ? 1 : 0;
    return static_cast<double>(n_met) / n_directions;
}

std::optional<CavityPlace> find_cavity_center(const TriangleTree& wall) {
    const auto [low, high] = wall.box();
    for (const CavityPlace& sample : samples_by_distance(wall)) {
        if (is_inside(wall, sample.position)) {
            return climb(wall, sample, (high - low).maxCoeff() / n_samples);
        }
    }
    return {};
}

}  // namespace couture::meshing
