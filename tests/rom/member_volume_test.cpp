#include "rom/member_volume.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "rom/member_geometry.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using couture::tests::BoxFamily;

namespace {

VectorX somewhere() { return BoxFamily::point({0.3, 0.7, 0.9, 0.2, 0.1, 0.6}); }

iga::MultiPatch<3> quarter_ring() {
    iga::MultiPatch<3> part;
    part.patches = {
        iga::make_extrusion(iga::make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 3.0))};
    return iga::refine<3>(part, 2, std::array<int, 3>{3, 2, 1});
}

}  // namespace

TEST_CASE("MemberVolume: volumes of the patches", "[rom]") {
    const iga::MultiPatch<3> reference = BoxFamily::geometry(BoxFamily::parameters().centre());
    const auto space = std::make_shared<const iga::Space<3>>(reference);
    const MemberVolume volume(space);
    // Width times the mean height 6 (1 - taper x / 20) of each half.
    const VectorX point = somewhere();
    const VectorX values = volume.values(to_field(*space, BoxFamily::geometry(point)));
    const double taper = point[BoxFamily::taper];
    CHECK(values[0] == Approx(60.0 * point[BoxFamily::width] * (1.0 - taper / 4.0)).epsilon(1e-13));
    CHECK(values[1] ==
          Approx(60.0 * point[BoxFamily::width] * (1.0 - 3.0 * taper / 4.0)).epsilon(1e-13));
    CHECK_THROWS_AS(volume.values(VectorX::Zero(5)), InputError);
}

TEST_CASE("MemberVolume: rational patches", "[rom]") {
    const auto space = std::make_shared<const iga::Space<3>>(quarter_ring());
    const double value = MemberVolume(space).values(to_field(*space, quarter_ring())).sum();
    CHECK(value == Approx(iga::volume(quarter_ring())).epsilon(1e-6));
    constexpr double exact = 3.0 * 3.14159265358979 * 3.0 / 4.0;
    CHECK(value == Approx(exact).epsilon(1e-6));
}

TEST_CASE("MemberVolume: changes agree with differences", "[rom]") {
    const iga::MultiPatch<3> part = GENERATE(BoxFamily::geometry(somewhere()), quarter_ring());
    const auto space = std::make_shared<const iga::Space<3>>(part);
    const MemberVolume volume(space);
    const VectorX X = to_field(*space, part);
    const MatrixX directions = rom::random_design(2, static_cast<int>(X.size()), 3).array() - 0.5;
    const MatrixX changes = volume.changes(X, directions);
    constexpr double step = 1e-4;
    for (int j = 0; j < 2; ++j) {
        const VectorX shift = step * directions.col(j);
        const VectorX slope = (volume.values(X + shift) - volume.values(X - shift)) / (2.0 * step);
        CHECK((changes.col(j) - slope).norm() < 1e-6 * slope.norm());
    }
}
