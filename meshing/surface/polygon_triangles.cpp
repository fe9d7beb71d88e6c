#include "meshing/surface/polygon_triangles.h"

#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

/// Twice the area along the mean normal (Newell).
Vector3 area_vector(std::span<const Vector3> points, std::span<const int> polygon) {
    Vector3 sum = Vector3::Zero();
    const Vector3& origin = points[polygon[0]];
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum += (points[polygon[i]] - origin).cross(points[polygon[i + 1]] - origin);
    }
    return sum;
}

/// Clips the corners of one polygon.
class Clipping {
  public:
    Clipping(std::span<const Vector3> points, std::span<const int> polygon)
        : points_(points), polygon_(polygon), normal_(area_vector(points, polygon)) {
        const auto n = static_cast<int>(polygon.size());
        for (int i = 0; i < n; ++i) {
            next_.push_back((i + 1) % n);
            previous_.push_back((i + n - 1) % n);
        }
        for (int i = 0; i < n; ++i) is_ear_.push_back(is_ear(i));
    }

    [[nodiscard]] std::vector<std::array<int, 3>> run() {
        std::vector<std::array<int, 3>> triangles;
        int start = 0;
        for (std::size_t left = polygon_.size(); left >= 3; --left) {
            // Corners of a polygon that is not simple may all fail.
            const int ear = left == 3 ? start : find_ear(start, left).value_or(next_[start]);
            const int before = previous_[ear];
            const int after = next_[ear];
            triangles.push_back({polygon_[before], polygon_[ear], polygon_[after]});
            next_[before] = after;
            previous_[after] = before;
            if (ear == start) start = after;
            if (left == 3) break;
            is_ear_[before] = is_ear(before);
            is_ear_[after] = is_ear(after);
        }
        return triangles;
    }

  private:
    [[nodiscard]] const Vector3& at(int i) const { return points_[polygon_[i]]; }

    /// Positive if a, b, c turn as the polygon does.
    [[nodiscard]] double turn(int a, int b, int c) const {
        return (at(b) - at(a)).cross(at(c) - at(a)).dot(normal_);
    }

    [[nodiscard]] bool is_ear(int i) const {
        const int a = previous_[i];
        const int c = next_[i];
        if (!(turn(a, i, c) > 0.0)) return false;
        for (int k = next_[c]; k != a; k = next_[k]) {
            const int number = polygon_[k];
            if (number == polygon_[a] || number == polygon_[i] || number == polygon_[c]) continue;
            if (turn(a, i, k) >= 0.0 && turn(i, c, k) >= 0.0 && turn(c, a, k) >= 0.0) return false;
        }
        return true;
    }

    /// The ear with the shortest diagonal, the first one of equally long ones.
    [[nodiscard]] std::optional<int> find_ear(int start, std::size_t left) {
        for (const bool is_second_try : {false, true}) {
            std::optional<int> best;
            double shortest = std::numeric_limits<double>::infinity();
            int i = start;
            for (std::size_t k = 0; k < left; ++k, i = next_[i]) {
                // What stood in the way may be gone.
                if (is_second_try) is_ear_[i] = is_ear(i);
                const double length = (at(next_[i]) - at(previous_[i])).squaredNorm();
                if (is_ear_[i] && length < shortest) {
                    best = i;
                    shortest = length;
                }
            }
            if (best) return best;
        }
        return {};
    }

    std::span<const Vector3> points_;
    std::span<const int> polygon_;
    Vector3 normal_;
    std::vector<int> next_;
    std::vector<int> previous_;
    std::vector<bool> is_ear_;
};

std::vector<std::array<int, 3>> split_quad(std::span<const Vector3> points,
                                           std::span<const int> quad) {
    const auto [a, b, c, d] = std::array{quad[0], quad[1], quad[2], quad[3]};
    const Vector3 normal = area_vector(points, quad);
    const auto turn = [&](int i, int j, int k) {
        return (points[j] - points[i]).cross(points[k] - points[i]).dot(normal);
    };
    const bool first_fits = turn(a, b, c) > 0.0 && turn(a, c, d) > 0.0;
    const bool second_fits = turn(a, b, d) > 0.0 && turn(b, c, d) > 0.0;
    const bool first_is_short =
        (points[c] - points[a]).squaredNorm() <= (points[d] - points[b]).squaredNorm();
    if (first_fits == second_fits ? first_is_short : first_fits) return {{a, b, c}, {a, c, d}};
    return {{a, b, d}, {b, c, d}};
}

}  // namespace

std::vector<std::array<int, 3>> split_polygon(std::span<const Vector3> points,
                                              std::span<const int> polygon) {
    if (polygon.size() < 3 || polygon.size() > max_polygon_corners) {
        throw InputError("split_polygon: a polygon with {} corners; from 3 to {} can be split",
                         polygon.size(), max_polygon_corners);
    }
    if (polygon.size() == 3) return {{polygon[0], polygon[1], polygon[2]}};
    if (polygon.size() == 4) return split_quad(points, polygon);
    return Clipping(points, polygon).run();
}

}  // namespace couture::meshing
