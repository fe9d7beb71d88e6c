#include "meshing/parts/half_seal.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "iga/core/error.h"
#include "iga/topology/jacobian_certificate.h"
#include "iga/topology/multipatch_interpolate.h"
#include "iga/topology/space.h"
#include "tests/meshing/parts/part_probe.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;
using Values = std::map<std::string, double>;

constexpr std::array<const char*, 6> lengths = {"arm_half_width", "inner_radius", "outer_radius",
                                                "ring_height",    "arm_height",   "arm_length"};

/// Half ring, and the arm less what the cylinder takes of its box.
double exact_volume(double R1, double R2, double R3, double H1, double H2, double L1) {
    const double chord = std::sqrt(R3 * R3 - R1 * R1);
    const double in_cylinder = R1 * chord + R3 * R3 * std::asin(R1 / R3);
    return pi / 2 * (R3 * R3 - R2 * R2) * H1 + (2 * R1 * L1 - in_cylinder) * H2;
}

const PartInfo& info() {
    return *std::find_if(parts().begin(), parts().end(),
                         [](const PartInfo& part) { return part.name == "half_seal"; });
}

const PartParameter& parameter(const std::string& name) {
    return *std::find_if(info().parameters.begin(), info().parameters.end(),
                         [&](const PartParameter& p) { return p.name == name; });
}

/// Cuboids, interfaces, proof of the Jacobian's sign, volume.
void check_seal(const Values& values) {
    const iga::MultiPatch<3> seal = make_solid_part("half_seal", values);
    CHECK(seal.interfaces.size() == 13);
    for (const iga::Patch<3>& patch : seal.patches) {
        const iga::PatchCertificate<3> certificate = iga::certify(patch);
        CHECK(certificate.validity == iga::Validity::valid);
        CHECK(certificate.orientation == 1);
    }
    constexpr double rounding = 1e-13;
    std::array<double, 6> v;
    std::transform(lengths.begin(), lengths.end(), v.begin(),
                   [&](const char* name) { return values.at(name); });
    CHECK(iga::volume(seal) ==
          Approx(exact_volume(v[0], v[1], v[2], v[3], v[4], v[5])).epsilon(rounding));
}

/// Places of the entities of one dimension, each once; of outer sides only if asked.
int n_places(const iga::MultiPatch<3>& part, int dimension, bool is_outer) {
    std::vector<iga::PatchEntity<3>> entities;
    if (is_outer) {
        for (const iga::PatchEntity<3>& side : part.outer_sides()) {
            for (const auto& entity : iga::entities_of_patch<3>(side.patch, dimension)) {
                const int k = iga::side_direction(side.side());
                if (entity.position[k] == side.position[k]) {
                    entities.push_back(entity);
                }
            }
        }
    } else {
        for (int patch = 0; patch < part.n_patches(); ++patch) {
            const auto some = iga::entities_of_patch<3>(patch, dimension);
            entities.insert(entities.end(), some.begin(), some.end());
        }
    }
    std::vector<VectorX> middles;
    for (const iga::PatchEntity<3>& entity : entities) {
        Vector3 xi;
        for (int k = 0; k < 3; ++k) {
            xi[k] = entity.position[k] == iga::End::free  ? 0.5
                    : entity.position[k] == iga::End::low ? 0.0
                                                          : 1.0;
        }
        const VectorX x = part.patches[entity.patch].point(xi);
        if (std::none_of(middles.begin(), middles.end(),
                         [&](const VectorX& other) { return (other - x).norm() < 1e-9; })) {
            middles.push_back(x);
        }
    }
    return static_cast<int>(middles.size());
}

int n_elements(const iga::MultiPatch<3>& part) {
    int total = 0;
    for (const iga::Patch<3>& patch : part.patches) {
        const std::array<int, 3> n = patch.space().n_elements();
        total += n[0] * n[1] * n[2];
    }
    return total;
}

}  // namespace

TEST_CASE("half_seal: 10 cuboids, 13 interfaces, 34 outer sides in named sets", "[parts]") {
    const iga::MultiPatch<3> seal = make_solid_part("half_seal");
    CHECK(seal.n_patches() == 10);
    CHECK(seal.interfaces.size() == 13);
    CHECK(seal.outer_sides().size() == 34);
    const std::map<std::string, std::size_t> sizes = {
        {"cap", 1},       {"cut_low", 3},    {"cut_high", 3}, {"cuts", 6}, {"inner", 9},
        {"outer", 8},     {"bottom", 3},     {"top", 3},      {"root", 4}, {"arm_left", 1},
        {"arm_right", 1}, {"arm_bottom", 1}, {"arm_top", 1}};
    CHECK(seal.boundary_sets.size() == sizes.size());
    for (const auto& [name, size] : sizes) {
        CAPTURE(name);
        CHECK(seal.boundary_set(name).size() == size);
    }
}

TEST_CASE("half_seal: a ball with a sphere around it", "[parts]") {
    const iga::MultiPatch<3> seal = make_solid_part("half_seal");
    CHECK(n_places(seal, 0, false) - n_places(seal, 1, false) + n_places(seal, 2, false) -
              seal.n_patches() ==
          1);
    CHECK(n_places(seal, 0, true) - n_places(seal, 1, true) + n_places(seal, 2, true) == 2);
}

TEST_CASE("half_seal: the sets lie where they are named", "[parts]") {
    const iga::MultiPatch<3> seal = make_solid_part("half_seal", {{"divisions", 2.0}});
    constexpr double rounding = 1e-13;
    const auto off = [&](const std::string& set, const std::function<double(const VectorX&)>& f) {
        return largest_on<3>(seal, set, f) / 65.0;
    };
    const auto plane = [](int axis, double value) {
        return [=](const VectorX& x) { return x[axis] - value; };
    };
    const auto cylinder = [](double radius) {
        return [=](const VectorX& x) { return std::hypot(x[0], x[1]) - radius; };
    };
    CHECK(off("cap", plane(0, 65.0)) < rounding);
    CHECK(off("cuts", plane(0, 0.0)) < rounding);
    CHECK(off("cut_low", [](const VectorX& x) { return std::max(x[1], 0.0); }) < rounding);
    CHECK(off("cut_high", [](const VectorX& x) { return std::min(x[1], 0.0); }) < rounding);
    CHECK(off("inner", cylinder(25.0)) < rounding);
    CHECK(off("outer", cylinder(40.0)) < rounding);
    CHECK(off("root", cylinder(40.0)) < rounding);
    CHECK(off("bottom", plane(2, -15.75)) < rounding);
    CHECK(off("top", plane(2, 15.75)) < rounding);
    CHECK(off("arm_left", plane(1, 13.0)) < rounding);
    CHECK(off("arm_right", plane(1, -13.0)) < rounding);
    CHECK(off("arm_bottom", plane(2, -6.5)) < rounding);
    CHECK(off("arm_top", plane(2, 6.5)) < rounding);
}

TEST_CASE("half_seal: lines along the arm are parallel to x", "[parts]") {
    const iga::MultiPatch<3> seal = make_solid_part("half_seal");
    const iga::Patch<3>& arm = seal.patches.back();
    for (const double eta : {0.2, 0.5, 0.9}) {
        const Vector3 tangent = arm.jacobian(Vector3(0.3, eta, 0.4)).col(0);
        CHECK(std::abs(tangent[1]) + std::abs(tangent[2]) < 1e-13 * tangent[0]);
    }
}

TEST_CASE("half_seal: valid and of exact volume at all corners of the ranges", "[parts]") {
    for (int corner = 0; corner < 64; ++corner) {
        CAPTURE(corner);
        Values values;
        for (int i = 0; i < 6; ++i) {
            const PartParameter& p = parameter(lengths[i]);
            values[p.name] = (corner >> i & 1) != 0 ? p.max : p.min;
        }
        check_seal(values);
    }
}

TEST_CASE("half_seal: valid and of exact volume at random values", "[parts]") {
    std::mt19937 generator(7);
    for (int sample = 0; sample < 50; ++sample) {
        CAPTURE(sample);
        Values values;
        for (const char* name : lengths) {
            const PartParameter& p = parameter(name);
            values[name] = std::uniform_real_distribution<double>(p.min, p.max)(generator);
        }
        check_seal(values);
    }
}

TEST_CASE("half_seal: k divisions give 144 k^3 elements and change no point", "[parts]") {
    const iga::MultiPatch<3> coarse = make_solid_part("half_seal");
    for (const int k : {1, 2, 3}) {
        CAPTURE(k);
        const iga::MultiPatch<3> fine =
            make_solid_part("half_seal", {{"divisions", static_cast<double>(k)}});
        CHECK(n_elements(fine) == 144 * k * k * k);
        CHECK_NOTHROW(iga::check(fine, 1e-14));
        CHECK_NOTHROW(iga::Space<3>(fine));
        for (int p = 0; p < fine.n_patches(); ++p) {
            const Vector3 xi(0.3, 0.6, 0.9);
            CHECK((fine.patches[p].point(xi) - coarse.patches[p].point(xi)).norm() < 1e-13 * 65.0);
        }
    }
}

TEST_CASE(
    "half_seal: interpolated, the volume's error falls with h^(degree + 1), planes stay plane",
    "[parts]") {
    const iga::MultiPatch<3> exact = make_solid_part("half_seal");
    const double volume = exact_volume(13.0, 25.0, 40.0, 31.5, 13.0, 65.0);
    for (int degree = 1; degree <= 3; ++degree) {
        CAPTURE(degree);
        const auto interpolated = [&](int divisions) {
            return iga::interpolate<3>(
                make_solid_part("half_seal", {{"divisions", static_cast<double>(divisions)}}),
                degree, {});
        };
        const iga::MultiPatch<3> coarse = interpolated(1);
        const iga::MultiPatch<3> fine = interpolated(2);
        const double coarse_error = std::abs(iga::volume(coarse) - volume) / volume;
        const double fine_error = std::abs(iga::volume(fine) - volume) / volume;
        CHECK(coarse_error < std::pow(0.2, degree + 1));
        // Elements of unequal size around: the coarse ones are not quite asymptotic.
        CHECK(std::log2(coarse_error / fine_error) > degree + 0.6);
        CHECK(n_elements(fine) == 1152);
        CHECK_NOTHROW(iga::check(fine, 1e-14));
        CHECK(iga::Space<3>(fine).is_isoparametric());
        CHECK(fine.boundary_sets == exact.boundary_sets);
        for (const iga::Patch<3>& patch : coarse.patches) {
            CHECK(iga::certify(patch).validity == iga::Validity::valid);
        }
        CHECK(largest_on<3>(fine, "cuts", [](const VectorX& x) { return x[0]; }) < 1e-12);
        CHECK(largest_on<3>(fine, "cap", [](const VectorX& x) { return x[0] - 65.0; }) < 1e-12);
        CHECK(largest_on<3>(fine, "top", [](const VectorX& x) { return x[2] - 15.75; }) < 1e-12);
    }
}

TEST_CASE("half_seal: whole cuboids without divisions", "[parts]") {
    const iga::MultiPatch<3> seal = make_solid_part("half_seal", {{"divisions", 0.0}});
    CHECK(n_elements(seal) == 10);
    CHECK(seal.interfaces.size() == 13);
    CHECK(iga::volume(seal) ==
          Approx(exact_volume(13.0, 25.0, 40.0, 31.5, 13.0, 65.0)).epsilon(1e-13));
}

TEST_CASE("half_seal: values out of range and parts of a division are refused", "[parts]") {
    CHECK_THROWS_WITH(make_part("half_seal", {{"arm_half_width", 16.0}}),
                      Catch::Contains("half_seal: arm_half_width = 16 is out of range; it must lie "
                                      "in [11, 15]"));
    CHECK_THROWS_WITH(make_part("half_seal", {{"divisions", 1.5}}),
                      "half_seal: divisions = 1.5 is not a whole number; take 1 or 2");
}

}  // namespace couture::meshing
