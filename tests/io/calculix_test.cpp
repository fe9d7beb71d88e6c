#include "io/calculix.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>

#include "io/atomic_file.h"
#include "io/calculix_run.h"
#include "meshing/parts/parts.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::iga;
using namespace couture::io;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const std::string sample = R"(
 displacements (vx,vy,vz) for set ALL_NODES and time  0.5000000E+00

         1  9.000000E+00  9.000000E+00  9.000000E+00
         2  9.000000E+00  9.000000E+00  9.000000E+00

 displacements (vx,vy,vz) for set ALL_NODES and time  0.1000000E+01

         1  1.000000E+00  0.000000E+00 -2.500000E-01
         2  0.000000E+00  1.234567-101  3.000000E+00

 forces (fx,fy,fz) for set ALL_NODES and time  0.1000000E+01

         1  1.000000E+00  2.000000E+00  3.000000E+00
         2 -1.000000E+00 -2.000000E+00 -3.000000E+00

 global coordinates (elem, integ.pnt.,x,y,z) for set ALL_ELEMENTS and time  0.1000000E+01

         1   1  1.000000E-01  2.000000E-01  3.000000E-01
         1   2  4.000000E-01  5.000000E-01  6.000000E-01
         2   1  7.000000E-01  8.000000E-01  9.000000E-01
         2   2  1.000000E+00  1.100000E+00  1.200000E+00

 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set ALL_ELEMENTS and time  0.1000000E+01

         1   1  1.100000E+01  2.200000E+01  3.300000E+01  1.200000E+01  1.300000E+01  2.300000E+01
         1   2  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00  6.000000E+00
         2   1  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00  6.000000E+00
         2   2  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  5.000000E+00  6.000000E+00
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

SpacePtr<3> brick(const std::array<int, 3>& n_elements = {1, 1, 1}) {
    const auto box = std::get<MultiPatch<3>>(meshing::make_part("box", {}));
    return std::make_shared<const Space<3>>(refine<3>(box, 1, n_elements));
}

Problem rubber() {
    Problem problem;
    problem.materials.resize(1);
    problem.materials[0].hyperelastic = make_hyperelastic(StoredEnergy::neo_hookean, 3.0, 20.0);
    return problem;
}

/// The unit cube pulled to 1.5 along x, free across.
CalculixModel uniaxial() {
    Problem problem = rubber();
    problem.supports = {make_support("x_low", 0.0, {}, {}), make_support("y_low", {}, 0.0, {}),
                        make_support("z_low", {}, {}, 0.0), make_support("x_high", 0.5, {}, {})};
    return make_calculix_model(brick(), problem);
}

/// Whether live tests can run; without the program they are skipped with a message, except in
/// continuous integration.
bool has_calculix() {
    if (find_calculix()) {
        return true;
    }
    if (std::getenv("CI") != nullptr) {
        FAIL("ccx is not installed (Debian's package calculix-ccx)");
    }
    WARN("skipped: ccx is not installed (Debian's package calculix-ccx)");
    return false;
}

}  // namespace

TEST_CASE("to_calculix: one brick, as the keywords of Abaqus", "[io]") {
    const std::string text = to_calculix(uniaxial(), "a brick");
    CHECK_THAT(text, StartsWith("*HEADING\na brick\n*NODE, NSET=ALL_NODES\n"
                                "1, 0.0000000000000e+00, 0.0000000000000e+00, "
                                "0.0000000000000e+00\n"));
    CHECK_THAT(text, Contains("*ELEMENT, TYPE=C3D8, ELSET=ALL_ELEMENTS\n"
                              "1, 1, 2, 4, 3, 5, 6, 8, 7\n"));
    CHECK_THAT(text, Contains("*NSET, NSET=X_HIGH\n2, 4, 6, 8\n"));
    CHECK_THAT(text, Contains("*HYPERELASTIC, NEO HOOKE\n"
                              "1.5000000000000e+00, 1.0000000000000e-01\n"));
    CHECK_THAT(text, Contains("*STATIC, DIRECT\n1.0000000000000e-01, 1.\n"));
    CHECK_THAT(text, Contains("*BOUNDARY\n1, 1, 1, 0.0000000000000e+00\n"));
    CHECK_THAT(text, Contains("\n8, 1, 1, 5.0000000000000e-01\n"));
    CHECK_THAT(text, !Contains("*CLOAD"));
}

TEST_CASE("to_calculix: dead loads are consistent nodal forces", "[io]") {
    Problem problem = rubber();
    problem.supports = {make_support("x_low", 0.0, 0.0, 0.0)};
    Traction load;
    load.on = "x_high";
    load.components = {constant(0.0), constant(4.0), constant(0.0)};
    problem.tractions = {load};
    CalculixModel model = make_calculix_model(brick({1, 2, 1}), problem);
    double sum = 0.0;
    for (const NodalValue& force : model.forces) {
        CHECK(force.component == 1);
        sum += force.value;
    }
    CHECK(model.forces.size() == 6);
    CHECK(sum == Approx(4.0).epsilon(1e-14));
    model.is_automatic = true;
    CHECK_THAT(to_calculix(model, ""),
               Contains("*STATIC\n") && Contains("*CLOAD\n2, 2, 5.0000000000000e-01\n"));
}

TEST_CASE("to_calculix: no number is longer than 20 characters", "[io]") {
    CalculixModel model = uniaxial();
    model.mesh.nodes(0, 0) = -1.2345678901234567e-10;
    model.mesh.nodes(0, 1) = -1.2345678901234567e-110;
    std::istringstream text(to_calculix(model, "t"));
    for (std::string word; text >> word;) {
        if (word.find("e+") != std::string::npos || word.find("e-") != std::string::npos) {
            CHECK(word.size() - (word.back() == ',' ? 1 : 0) <= 20);
        }
    }
}

TEST_CASE("make_calculix_model: what it can't say is named", "[io]") {
    Problem problem = rubber();
    problem.supports = {make_support("x_low", 0.0, 0.0, 0.0)};
    problem.pressures = {make_pressure("x_high", 1.0)};
    CHECK_THROWS_WITH(make_calculix_model(brick(), problem),
                      "calculix: the pressure on 'x_high' follows the body; only dead loads are "
                      "written");
    problem.pressures.clear();
    problem.foundations.resize(1);
    problem.foundations[0].on = "x_high";
    CHECK_THROWS_WITH(make_calculix_model(brick(), problem),
                      "calculix: the foundation on 'x_high' can't be written");
    problem.foundations.clear();
    problem.materials.push_back(problem.materials[0]);
    CHECK_THROWS_WITH(make_calculix_model(brick(), problem),
                      "calculix: 2 materials; expected one, which is hyperelastic");
    CHECK_THROWS_WITH(
        make_calculix_model(make_hexahedral_space(brick()->geometry(), 2, {1, 1, 1}), rubber()),
        "calculix: the space has degree 2; nodal forces are those of degree 1");
    CalculixModel model = uniaxial();
    model.forces.push_back({8, 0, 1.0});
    CHECK_THROWS_WITH(to_calculix(model, ""),
                      "calculix: node 8, component 0; must be below 8 and 3");
    model.material.energy = StoredEnergy::saint_venant_kirchhoff;
    CHECK_THROWS_WITH(to_calculix(model, ""),
                      "calculix: the material is not neo_hookean; no other energy is written");
}

TEST_CASE("parse_calculix_dat: the last increment, stresses in Voigt order", "[io]") {
    const CalculixResult result = parse_calculix_dat("job.dat", sample);
    CHECK(result.time == 1.0);
    MatrixX u(2, 3);
    u << 1.0, 0.0, -0.25, 0.0, 0.0, 3.0;
    CHECK(result.displacements == u);
    CHECK(result.forces(1, 2) == -3.0);
    CHECK(result.points(3, 1) == 1.1);
    Vector<6> first;
    first << 11.0, 22.0, 33.0, 23.0, 13.0, 12.0;
    CHECK(Vector<6>(result.stresses.row(0)) == first);
    CHECK(result.stresses.rows() == 4);
}

TEST_CASE("parse_calculix_dat: damaged files are told with their line", "[io]") {
    const auto parse = [](const std::string& text) { return parse_calculix_dat("job.dat", text); };
    CHECK_THROWS_WITH(parse(replaced(sample, "-2.500000E-01", "-2.5x0000E-01")),
                      "job.dat:9: found '-2.5x0000E-01'; expected a number: a displacement");
    CHECK_THROWS_WITH(parse(replaced(sample, "-3.000000E+00", "NaN")), StartsWith("job.dat:15: "));
    CHECK_THROWS_WITH(parse(replaced(sample, "         2 -1.0", "         3 -1.0")),
                      "job.dat:15: found '3'; expected the number of the next node, a whole number "
                      "from 2 to 2");
    CHECK_THROWS_WITH(parse(replaced(sample, "         2   2  1.0000", "         2   3  1.0000")),
                      "job.dat:22: found '3'; expected the number of an integration point, a whole "
                      "number from 2 to 2");
    CHECK_THROWS_WITH(parse(replaced(sample, "stresses (", "strains (")),
                      "job.dat:24: found 'strains'; expected displacements, forces, stresses or "
                      "global coordinates");
    CHECK_THROWS_WITH(parse(sample.substr(0, sample.size() - 20)), StartsWith("job.dat:29: "));
    CHECK_THROWS_WITH(parse(sample.substr(0, sample.find(" forces"))),
                      "job.dat: there are 2 displacements and 0 forces; the run has not come to "
                      "its end");
    CHECK_THROWS_WITH(parse("nonsense\n"),
                      "job.dat:1: found 'nonsense '; expected a heading that ends with the time");
    CHECK_THROWS_WITH(parse(""),
                      "job.dat: there are no displacements; the run has not come to its "
                      "end");
}

TEST_CASE("run_calculix: a brick under uniaxial stress has its closed form", "[io]") {
    if (!has_calculix()) {
        return;
    }
    const TemporaryFolder folder;
    write_text(folder / "brick.inp", to_calculix(uniaxial(), "uniaxial stretch 1.5"));
    const CalculixResult result = run_calculix(folder / "", "brick");
    CHECK(result.time == 1.0);
    // Seven printed digits.
    REQUIRE(result.stresses.rows() == 8);
    for (long i = 0; i < 8; ++i) {
        CHECK(result.stresses(i, 0) == Approx(4.1282217920).epsilon(1e-6));
    }
    CHECK(1.0 + result.displacements(7, 1) == Approx(0.8441183553).epsilon(1e-6));
    CHECK(result.forces.col(0).head(8).cwiseAbs().sum() ==
          Approx(2.0 * 2.9415058076).epsilon(1e-6));
}

TEST_CASE("run_calculix: a run that fails or takes too long shows its last words", "[io]") {
    if (!has_calculix()) {
        return;
    }
    const TemporaryFolder folder;
    CalculixModel inside_out = uniaxial();
    inside_out.mesh.nodes.col(0) *= -1.0;
    write_text(folder / "broken.inp", to_calculix(inside_out, "negative volume"));
    CHECK_THROWS_WITH(run_calculix(folder / "", "broken"),
                      StartsWith("ccx: broken failed, exit code ") && Contains("jacobian"));
    CalculixModel model = uniaxial();
    model.increment = 1e-4;
    write_text(folder / "slow.inp", to_calculix(model, "ten thousand increments"));
    CHECK_THROWS_WITH(run_calculix(folder / "", "slow", std::chrono::seconds(0)),
                      StartsWith("ccx: slow was not done after 0 s and has been ended"));
}

TEST_CASE("run_calculix: a missing program is told with its package", "[io]") {
    const TemporaryFolder folder;
    const char* const old = std::getenv("PATH");
    const std::string path = old == nullptr ? "" : old;
    ::setenv("PATH", (folder / "").c_str(), 1);
    CHECK_FALSE(find_calculix());
    CHECK_THROWS_WITH(run_calculix(folder / "", "job"),
                      "ccx: the program is not in any folder of PATH; install Debian's package "
                      "calculix-ccx");
    ::setenv("PATH", path.c_str(), 1);
}
