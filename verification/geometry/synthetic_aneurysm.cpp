#include "verification/geometry/synthetic_aneurysm.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "iga/core/error.h"

namespace couture::verification {

namespace {

using meshing::TriangleSoup;

struct Ellipsoid {
    Vector3 center;
    Vector3 radii;
};

/// A vessel along a polyline.
struct Vessel {
    std::vector<Vector3> points;
    double radius;
};

/// The shape: negative inside, about a distance near the wall.
struct Anatomy {
    Ellipsoid dome;
    Ellipsoid bleb;
    std::vector<Vessel> vessels;

    [[nodiscard]] double value(const Vector3& x) const;
};

double ellipsoid_value(const Ellipsoid& shape, const Vector3& x) {
    return ((x - shape.center).cwiseQuotient(shape.radii).norm() - 1.0) * shape.radii.minCoeff();
}

double vessel_value(const Vessel& vessel, const Vector3& x) {
    double least = 1e30;
    for (std::size_t i = 0; i + 1 < vessel.points.size(); ++i) {
        const Vector3 axis = vessel.points[i + 1] - vessel.points[i];
        const double t =
            std::clamp((x - vessel.points[i]).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (x - vessel.points[i] - t * axis).norm());
    }
    return least - vessel.radius;
}

double Anatomy::value(const Vector3& x) const {
    // A smooth least of all: necks are rounded by about this length.
    constexpr double rounding = 0.4;
    double sum = std::exp(-ellipsoid_value(dome, x) / rounding) +
                 std::exp(-ellipsoid_value(bleb, x) / rounding);
    for (const Vessel& vessel : vessels) sum += std::exp(-vessel_value(vessel, x) / rounding);
    return -rounding * std::log(sum);
}

/// Uniform numbers that are the same everywhere.
class Random {
  public:
    explicit Random(int number) : engine_(1000 + static_cast<std::uint64_t>(number)) {}
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
    }

  private:
    std::mt19937_64 engine_;
};

Anatomy make_anatomy(int n_outlets, Random& random) {
    Anatomy anatomy;
    const double x = random.between(3.2, 4.4);
    const double y = random.between(3.0, 4.0);
    const double z = random.between(4.5, 6.5);
    anatomy.dome = {Vector3::Zero(), Vector3(x, y, z)};
    const double turn = random.between(-0.5, 0.5);
    const Vector3 towards(std::cos(turn), std::sin(turn), random.between(0.4, 0.8));
    anatomy.bleb = {towards.normalized().cwiseProduct(0.75 * anatomy.dome.radii),
                    Vector3::Constant(random.between(1.4, 2.2))};
    const std::array directions{Vector3(0.0, 0.0, -1.0), Vector3(-0.8, 0.5, -0.5),
                                Vector3(-0.2, -0.9, -0.4)};
    for (int i = 0; i < n_outlets; ++i) {
        const Vector3 out = directions[i].normalized();
        const Vector3 bend(random.between(-1.0, 1.0), random.between(-1.0, 1.0), -0.5);
        const double length = out.cwiseProduct(anatomy.dome.radii).norm();
        const Vector3 middle = (length + random.between(1.5, 2.5)) * out;
        const Vector3 end = middle + random.between(2.5, 4.0) * (out + 0.6 * bend).normalized();
        // From inside the dome, and farther than where it is cut off.
        anatomy.vessels.push_back(
            {{0.5 * length * out, middle, end, end + 2.0 * (end - middle).normalized()},
             random.between(0.9, 1.5)});
    }
    return anatomy;
}

/// The surface value = 0 by marching tetrahedra: each cube of a grid is cut into six around its
/// diagonal, so that neighbours agree.
class Marching {
  public:
    Marching(const std::function<double(const Vector3&)>& value, const Vector3& low,
             const Vector3& high, double cell)
        : low_(low), cell_(cell) {
        for (int axis = 0; axis < 3; ++axis) {
            n_[axis] = static_cast<int>(std::ceil((high - low)[axis] / cell)) + 1;
        }
        values_.reserve(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2]);
        for (int k = 0; k < n_[2]; ++k) {
            for (int j = 0; j < n_[1]; ++j) {
                for (int i = 0; i < n_[0]; ++i) values_.push_back(value(position(i, j, k)));
            }
        }
    }

    TriangleSoup run() {
        // Orders in which the corner 000 goes to 111 along the axes.
        constexpr std::array<std::array<int, 3>, 6> paths{
            {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
        for (int k = 0; k + 1 < n_[2]; ++k) {
            for (int j = 0; j + 1 < n_[1]; ++j) {
                for (int i = 0; i + 1 < n_[0]; ++i) {
                    for (const auto& path : paths) {
                        std::array<int, 3> node{i, j, k};
                        std::array<int, 4> corners{number(node)};
                        for (int step = 0; step < 3; ++step) {
                            ++node[path[step]];
                            corners[step + 1] = number(node);
                        }
                        add_tetrahedron(corners);
                    }
                }
            }
        }
        return std::move(soup_);
    }

  private:
    [[nodiscard]] Vector3 position(int i, int j, int k) const {
        return low_ + cell_ * Vector3(i, j, k);
    }
    [[nodiscard]] int number(const std::array<int, 3>& node) const {
        return (node[2] * n_[1] + node[1]) * n_[0] + node[0];
    }
    [[nodiscard]] Vector3 position(int number) const {
        return position(number % n_[0], number / n_[0] % n_[1], number / n_[0] / n_[1]);
    }

    int crossing(int a, int b) {
        const auto [found, is_new] =
            points_.try_emplace(std::minmax(a, b), static_cast<int>(soup_.points.size()));
        if (is_new) {
            const double t = values_[a] / (values_[a] - values_[b]);
            // Not at the nodes, where triangles would have no area.
            const double inner = std::clamp(t, 0.02, 0.98);
            soup_.points.push_back((1.0 - inner) * position(a) + inner * position(b));
        }
        return found->second;
    }

    /// Turned so that it is seen counter-clockwise from outside.
    void add_triangle(std::array<int, 3> triangle, const Vector3& inside) {
        const auto& [a, b, c] = triangle;
        const Vector3 normal =
            (soup_.points[b] - soup_.points[a]).cross(soup_.points[c] - soup_.points[a]);
        if (normal.dot(inside - soup_.points[a]) > 0.0) std::swap(triangle[1], triangle[2]);
        soup_.triangles.push_back(triangle);
    }

    void add_tetrahedron(std::array<int, 4> corners) {
        const auto first_outside = std::ranges::stable_partition(
            corners, [&](int corner) { return values_[corner] < 0.0; });
        const auto n_inside = std::distance(corners.begin(), first_outside.begin());
        const auto& [a, b, c, d] = corners;
        const Vector3 inside = position(a);
        if (n_inside == 1) {
            add_triangle({crossing(a, b), crossing(a, c), crossing(a, d)}, inside);
        } else if (n_inside == 3) {
            add_triangle({crossing(a, d), crossing(b, d), crossing(c, d)}, inside);
        } else if (n_inside == 2) {
            add_triangle({crossing(a, c), crossing(a, d), crossing(b, d)}, inside);
            add_triangle({crossing(a, c), crossing(b, d), crossing(b, c)}, inside);
        }
    }

    Vector3 low_;
    double cell_;
    std::array<int, 3> n_{};
    std::vector<double> values_;
    std::map<std::pair<int, int>, int> points_;
    TriangleSoup soup_;
};

Vector3 center_of(const TriangleSoup& soup, const std::array<int, 3>& triangle) {
    return (soup.points[triangle[0]] + soup.points[triangle[1]] + soup.points[triangle[2]]) / 3.0;
}

/// Takes off what lies behind the ends of the vessels.
void open_vessels(const Anatomy& anatomy, TriangleSoup& soup) {
    std::erase_if(soup.triangles, [&](const std::array<int, 3>& triangle) {
        const Vector3 x = center_of(soup, triangle);
        return std::ranges::any_of(anatomy.vessels, [&](const Vessel& vessel) {
            const Vector3& end = vessel.points[2];
            const Vector3 axis = (vessel.points[3] - end).normalized();
            return (x - end).dot(axis) > 0.0 && (x - end).norm() < 2.0 + 2.0 * vessel.radius;
        });
    });
}

void add_duplicates(TriangleSoup& soup) {
    const std::size_t n = soup.triangles.size();
    for (std::size_t t = 0; t < n; t += 20) {
        std::array<int, 3> copy = soup.triangles[t];
        if (t % 40 == 0) {
            for (int& v : copy) {
                soup.points.push_back(Vector3(soup.points[v]));
                v = static_cast<int>(soup.points.size()) - 1;
            }
        }
        soup.triangles.push_back(copy);
    }
    for (std::size_t t = 0; t < n; t += 7) {
        std::swap(soup.triangles[t][1], soup.triangles[t][2]);
    }
}

/// Triangles that stand on the surface outside.
void add_fins(TriangleSoup& soup) {
    const std::size_t n = soup.triangles.size();
    for (std::size_t t = 0; t < n; t += 50) {
        const auto [a, b, c] = soup.triangles[t];
        const Vector3 normal =
            (soup.points[b] - soup.points[a]).cross(soup.points[c] - soup.points[a]).normalized();
        const Vector3 top = center_of(soup, soup.triangles[t]) + 0.3 * normal;
        const int apex = static_cast<int>(soup.points.size());
        soup.points.push_back(top);
        soup.points.emplace_back(top + 0.2 * normal);
        soup.triangles.push_back({a, b, apex});
        soup.triangles.push_back({c, apex, apex + 1});
    }
}

void make_holes(TriangleSoup& soup) {
    TriangleSoup parted;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (t % 300 == 150) continue;
        const int first = static_cast<int>(parted.points.size());
        for (const int v : soup.triangles[t]) parted.points.push_back(soup.points[v]);
        parted.triangles.push_back({first, first + 1, first + 2});
    }
    soup = std::move(parted);
}

}  // namespace

std::string to_string(ScanDefect defect) {
    switch (defect) {
        case ScanDefect::none:
            return "none";
        case ScanDefect::duplicates:
            return "duplicates";
        case ScanDefect::non_manifold:
            return "non-manifold";
        case ScanDefect::holes:
            return "holes";
    }
    return "";
}

SyntheticAneurysm make_synthetic_aneurysm(int number, double cell) {
    if (number < 0) {
        throw InputError("make_synthetic_aneurysm: number {}; there are those from 0", number);
    }
    Random random(number);
    SyntheticAneurysm aneurysm;
    aneurysm.name = fmt::format("aneurysm_{:02}", number);
    aneurysm.n_outlets = 1 + number % 3;
    aneurysm.defect = static_cast<ScanDefect>(number % 4);
    const Anatomy anatomy = make_anatomy(aneurysm.n_outlets, random);
    const Vector3 reach(12.0, 12.0, 16.0);
    aneurysm.surface = Marching([&](const Vector3& x) { return anatomy.value(x); }, Vector3(-reach),
                                Vector3(reach.x(), reach.y(), 9.0), cell)
                           .run();
    open_vessels(anatomy, aneurysm.surface);
    for (const Vessel& vessel : anatomy.vessels) {
        aneurysm.outlets.emplace_back(2.0 * vessel.points[0]);
    }
    if (aneurysm.defect == ScanDefect::duplicates) add_duplicates(aneurysm.surface);
    if (aneurysm.defect == ScanDefect::non_manifold) {
        add_fins(aneurysm.surface);
        add_duplicates(aneurysm.surface);
    }
    if (aneurysm.defect == ScanDefect::holes) make_holes(aneurysm.surface);
    return aneurysm;
}

}  // namespace couture::verification
