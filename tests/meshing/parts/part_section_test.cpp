#include "meshing/parts/part_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

namespace couture::meshing {

namespace {

/// Of what is left, closed by the cut face: integral of x . n / 3.
double volume_of(const PartSection& section) {
    double six_volumes = 0.0;
    for (const TriangleSoup* soup : {&section.rest, &section.cut}) {
        for (const auto& [a, b, c] : soup->triangles) {
            six_volumes += soup->points[a].dot(soup->points[b].cross(soup->points[c]));
        }
    }
    return six_volumes / 6.0;
}

Vector3 cut_area(const PartSection& section) {
    Vector3 area = Vector3::Zero();
    for (const auto& [a, b, c] : section.cut.triangles) {
        const std::vector<Vector3>& x = section.cut.points;
        area += 0.5 * (x[b] - x[a]).cross(x[c] - x[a]);
    }
    return area;
}

/// Outlines leave out what is shorter than a hundred-thousandth of the part.
constexpr double accuracy = 1e-4;

}  // namespace

TEST_CASE("cut_part: both halves make the whole", "[parts]") {
    struct Cut {
        std::string part;
        int axis = 0;
        double place = 0.0;
        std::size_t n_outlines = 0;
    };
    // Through vertices and past them; through holes and windows.
    for (const Cut& cut : std::vector<Cut>{{"wheel", 0, 0.0, 2},
                                           {"wheel", 1, 0.0, 4},
                                           {"wheel", 2, 1.0, 4},
                                           {"casting", 1, 0.0, 4},
                                           {"torus", 2, 3.0, 2},
                                           {"sierpinski", 0, 45.0, 4},
                                           {"cube", 0, 50.0, 1}}) {
        CAPTURE(cut.part, cut.axis, cut.place);
        const PartSurface part = make_part_surface(cut.part);
        const PartSection low = cut_part(part, cut.axis, cut.place, -1);
        const PartSection high = cut_part(part, cut.axis, cut.place, 1);
        double whole = 0.0;
        for (const auto& [a, b, c] : part.soup.triangles) {
            const std::vector<Vector3>& x = part.soup.points;
            whole += x[a].dot(x[b].cross(x[c])) / 6.0;
        }
        CHECK(volume_of(low) > 0.0);
        CHECK(volume_of(high) > 0.0);
        CHECK(volume_of(low) + volume_of(high) == Approx(whole).epsilon(accuracy));
        CHECK(low.outlines.size() == cut.n_outlines);
        CHECK(high.outlines.size() == cut.n_outlines);
        CHECK(cut_area(low)[cut.axis] > 0.0);
        CHECK(cut_area(low)[cut.axis] == Approx(-cut_area(high)[cut.axis]).epsilon(accuracy));
        for (const Vector3& x : low.rest.points) {
            CHECK(x[cut.axis] <= cut.place);
        }
        CHECK(low.face_of_triangle.size() == low.rest.triangles.size());
    }
}

TEST_CASE("cut_part: the cut face has the closed form's area, curves end in it", "[parts]") {
    const PartSurface wheel = make_part_surface("wheel");
    const PartSection section = cut_part(wheel, 0, 0.0, -1);
    // Twice: hub with boss, web, rim.
    const double area = 2.0 * (29.25 * (27.625 - 8.775) + 2.0 * 4.0 * (14.95 - 8.775) +
                               8.9375 * (77.025 - 27.625) + 29.25 * (89.3 - 77.025));
    // The cut goes through facets of the cylinders, which lie inside of them.
    constexpr double facets = 2e-3;
    CHECK(cut_area(section).x() == Approx(area).epsilon(facets));
    CHECK(cut_area(section).tail<2>().norm() < accuracy);
    for (const std::vector<Vector3>& curve : section.feature_curves) {
        CHECK(curve.size() > 1);
        for (const Vector3& x : curve) {
            CHECK(x.x() <= 0.0);
        }
    }
    CHECK(section.feature_curves.size() > 10);
}

TEST_CASE("cut_part: a plane beside the part is an error", "[parts]") {
    CHECK_THROWS_WITH(cut_part(make_part_surface("cube"), 1, 200.0, 1),
                      "cut_part: the plane y = 200 does not meet the part, which lies in [0, 100]; "
                      "choose a place in it");
}

}  // namespace couture::meshing
