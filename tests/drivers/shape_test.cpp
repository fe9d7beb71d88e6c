#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/obj_surface.h"
#include "io/spline_file.h"
#include "io/surface_file.h"
#include "io/surface_reader.h"
#include "meshing/surface/cube_sphere.h"
#include "tests/drivers/run_program.h"
#include "verification/geometry/synthetic_aneurysm.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

/// Ellipsoids of a sphere of 54 quads: a_0 .. a_8, axes as in tests/rom/shape_samples.h.
void write_ellipsoids(const std::filesystem::path& folder) {
    const meshing::QuadMesh sphere = meshing::make_cube_sphere(3);
    for (int k = 0; k < 9; ++k) {
        const Vector3 axes(1.0 + 0.1 * (k / 3 - 1), 1.0 + 0.05 * (k % 3 - 1), 1.0);
        meshing::QuadMesh member = sphere;
        for (Vector3& point : member.points) point = point.cwiseProduct(axes);
        io::write_obj(folder / ("a_" + std::to_string(k) + ".obj"), member, "");
    }
}

Json run_json(const std::string& arguments, const std::filesystem::path& folder) {
    const ProgramResult result = run_couture(arguments + " --json", folder);
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

}  // namespace

TEST_CASE("shape: two modes of ellipsoids, a projection and a virtual member", "[drivers]") {
    const TemporaryFolder folder;
    write_ellipsoids(folder.path());
    // Between the members, and turned: x and y exchanged (and z, to keep it a rotation).
    meshing::QuadMesh other = meshing::make_cube_sphere(3);
    for (Vector3& p : other.points) p = Vector3(-0.98 * p.y(), 1.06 * p.x(), p.z() + 5.0);
    io::write_obj(folder.path() / "new.obj", other, "");
    const Json object = run_json(
        "shape a_*.obj --modes 2 --project new.obj --virtual 1,-0.5 --png --out o", folder.path());
    CHECK(object["kind"] == "quad mesh");
    CHECK(object["points"] == 56);
    CHECK(object["reference"] == "a_4");
    REQUIRE(object["modes"].size() == 2);
    // Squares of x and of y on the sphere have the same sum.
    CHECK(object["compactness"][1].get<double>() == Approx(0.8).epsilon(1e-9));
    CHECK(object["compactness"][2] == 1.0);
    CHECK(object["generalisation"]["values"][2].get<double>() < 1e-12);
    const Json& projection = object["projections"][0];
    CHECK(projection["distance"].get<double>() < 1e-9);
    CHECK(std::abs(projection["scores"][0].get<double>()) == Approx(0.6 / std::sqrt(0.75)));
    CHECK(std::abs(projection["scores"][1].get<double>()) == Approx(0.4 / std::sqrt(0.75)));
    CHECK(projection["nearest"][0]["name"] == "a_7");
    for (const auto* file :
         {"shape_mean.vtp", "shape_mode_1_-3.vtp", "shape_mode_2_+3.vtp", "shape_mode_1.pvd",
          "shape_projected_new.vtp", "shape_virtual_1.vtp", "shape_curves.csv",
          "shape_coefficients.csv", "shape_modes.png", "shape_curves.png", "shape_members.png"}) {
        CAPTURE(file);
        CHECK(std::filesystem::exists(folder.path() / "o" / file));
    }
    CHECK(object["files"].size() == 1 + 2 * 8 + 2 + 2 + 3);
    // What was written is the mean and so many standard deviations away from it.
    const io::RawSurface mean = io::read_polygons(folder.path() / "o/shape_mean.vtp");
    const io::RawSurface made = io::read_polygons(folder.path() / "o/shape_virtual_1.vtp");
    double squares = 0.0;
    for (std::size_t v = 0; v < mean.points.size(); ++v) {
        CHECK(mean.points[v].norm() == Approx(1.0).epsilon(1e-9));
        squares += (made.points[v] - mean.points[v]).squaredNorm();
    }
    const double first = object["modes"][0]["standard_deviation"];
    const double second = object["modes"][1]["standard_deviation"];
    CHECK(std::sqrt(squares) == Approx(std::hypot(first, 0.5 * second)));
    // A virtual member is projected onto what it was made of.
    const Json again =
        run_json("shape a_*.obj --modes 2 --project o/shape_virtual_1.vtp --out p", folder.path());
    CHECK(again["projections"][0]["scores"][0].get<double>() == Approx(1.0));
    CHECK(again["projections"][0]["scores"][1].get<double>() == Approx(-0.5));
    CHECK_THAT(io::read_text(folder.path() / "o/shape_curves.csv"),
               Contains("modes,compactness,generalisation"));
}

TEST_CASE("shape: alignment, scaling and the reference by name", "[drivers]") {
    const TemporaryFolder folder;
    meshing::QuadMesh shape = meshing::make_cube_sphere(2);
    for (int k = 0; k < 3; ++k) {
        meshing::QuadMesh member = shape;
        for (Vector3& p : member.points)
            p = (1.0 + k) * p.cwiseProduct(Vector3(1.0, 2.0, 3.0 + 0.1 * k * k));
        for (Vector3& p : member.points) p.x() += 10.0 * k;
        io::write_obj(folder.path() / ("m_" + std::to_string(k) + ".obj"), member, "");
    }
    const auto deviation = [&](const std::string& options) {
        return run_json("shape m_0.obj m_1.obj m_2.obj " + options,
                        folder.path())["modes"][0]["standard_deviation"]
            .get<double>();
    };
    const double as_given = deviation("--no-align");
    const double rigid = deviation("");
    const double scaled = deviation("--scale");
    CHECK(as_given > 2.0 * rigid);
    CHECK(rigid > 5.0 * scaled);
    const Json object = run_json("shape m_0.obj m_1.obj m_2.obj --reference m_2", folder.path());
    CHECK(object["reference"] == "m_2");
    CHECK(object["alignment"] == "rigid");
}

TEST_CASE("shape: volumes of a family", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml",
                   "[geometry]\npart = \"cube\"\n[meshing]\nelement_size = 50\n[family]\n"
                   "parameters = \"m.csv\"\n");
    io::write_text(folder.path() / "m.csv", "name,length\na,110\nb,120\nwrong,5000\nc,95\n");
    CHECK_THAT(run_couture("shape f.toml", folder.path()).errors,
               Contains("no results of this family in out/f"));
    REQUIRE(run_couture("mesh f.toml --json", folder.path()).exit_code == 1);
    const Json object = run_json("shape f.toml --virtual 1 --png", folder.path());
    CHECK(object["kind"] == "volume");
    CHECK(object["reference"] == "reference");
    CHECK(object["members"].size() == 4);
    CHECK(object["mean_certificate"] == "valid");
    CHECK(object["virtual"][0]["certificate"] == "valid");
    // A cube has one size.
    CHECK(object["compactness"][1].get<double>() > 0.999);
    const auto made = io::read_splines(folder.path() / "out/f_shape/f_shape_virtual_1.xml");
    CHECK(iga::signature(std::get<iga::MultiPatch<3>>(made.multipatch)) == object["signature"]);
    CHECK(std::filesystem::exists(folder.path() / "out/f_shape/f_shape_mode_1_+3.vtu"));
    // The folder does the same, and a member lies on the line of the others.
    const Json again =
        run_json("shape out/f --project out/f/b_volume.xml --out again", folder.path());
    CHECK(again["signature"] == object["signature"]);
    CHECK(again["projections"][0]["nearest"][0]["name"] == "b");
}

TEST_CASE("shape: refuses members that can't be compared", "[drivers]") {
    const TemporaryFolder folder;
    write_ellipsoids(folder.path());
    const auto errors = [&](const std::string& arguments) {
        const ProgramResult result = run_couture("shape " + arguments, folder.path());
        CHECK(result.exit_code == 2);
        return result.errors;
    };
    meshing::QuadMesh other = meshing::make_cube_sphere(2);
    io::write_obj(folder.path() / "coarse.obj", other, "");
    CHECK_THAT(errors("a_0.obj a_1.obj coarse.obj"),
               Contains("coarse.obj: 26 points and 24 polygons; a_0.obj has 56 and 54"));
    other = meshing::make_cube_sphere(3);
    std::swap(other.quads[5][0], other.quads[5][2]);
    io::write_obj(folder.path() / "turned.obj", other, "");
    CHECK_THAT(errors("a_0.obj turned.obj"), Contains("turned.obj: polygon 5 has the points"));
    CHECK_THAT(errors("a_0.obj a_1.obj --project coarse.obj"), Contains("coarse.obj: 26 points"));
    CHECK_THAT(errors("a_0.obj"), Contains("1 member; a population has 2 or more"));
    CHECK_THAT(errors(""), Contains("no members"));
    CHECK_THAT(errors("a_0.obj a_0.obj"), Contains("a_0.obj is given more than once"));
    CHECK_THAT(errors("a_0.obj missing.obj"), Contains("missing.obj"));
    std::filesystem::copy_file(folder.path() / "a_0.obj", folder.path() / "copy.obj");
    CHECK_THAT(errors("a_0.obj copy.obj"), Contains("the 2 members are equal"));
    CHECK_THAT(errors("."), Contains("no files NAME_members.json"));
    CHECK_THAT(errors("a_0.obj a_1.obj --modes 2"), Contains("--modes 2: 2 members have 1 to 1"));
    CHECK_THAT(errors("a_0.obj a_1.obj --virtual 1,x"), Contains("--virtual '1,x' is no list"));
    CHECK_THAT(errors("a_0.obj a_1.obj --virtual 1,2"), Contains("2 numbers; there are 1 modes"));
    CHECK_THAT(errors("a_0.obj a_1.obj --reference b"), Contains("no such member; there are a_0"));
    CHECK_THAT(errors("a_0.obj a_1.obj --scale --no-align"), Contains("exclude each other"));
    REQUIRE(run_couture("convert cube c.stl", folder.path()).exit_code == 0);
    CHECK_THAT(errors("c.stl a_0.obj"), Contains("c.stl: the triangles of STL files share no"));
    REQUIRE(run_couture("convert '" COUTURE_SOURCE_DIR "/drivers/decks/solve_bar.toml' bar.xml",
                        folder.path())
                .exit_code == 0);
    CHECK_THAT(errors("a_0.obj bar.xml"), Contains("bar.xml: is a volume, a_0.obj a quad mesh"));
    REQUIRE(run_couture("convert '" COUTURE_SOURCE_DIR "/drivers/decks/pipe_tee.toml' tee.xml",
                        folder.path())
                .exit_code == 0);
    CHECK_THAT(errors("bar.xml tee.xml"), Contains("tee.xml: signature "));
    CHECK_THAT(errors("a_0.obj m.toml"), Contains("m.toml: is neither a mesh"));
}

TEST_CASE("shape: warns of mirror images and copies", "[drivers]") {
    const TemporaryFolder folder;
    // A shape without symmetry.
    const auto member = [](double a) {
        meshing::QuadMesh mesh = meshing::make_cube_sphere(3);
        for (Vector3& p : mesh.points) {
            p = Vector3((1.0 + a) * p.x() + 0.5 * p.y() * p.z(), 2.0 * p.y() + 0.7 * p.x() * p.x(),
                        3.0 * p.z() + 0.9 * p.x() * p.y() + 0.8 * p.y() * p.y());
        }
        return mesh;
    };
    for (int k = 0; k < 5; ++k) {
        meshing::QuadMesh mesh = member(0.01 * k);
        if (k == 3) {
            for (Vector3& p : mesh.points) p.x() = -p.x();
        }
        io::write_obj(folder.path() / ("m_" + std::to_string(k) + ".obj"), mesh, "");
    }
    io::write_obj(folder.path() / "n_0.obj", member(0.0), "");
    const ProgramResult result =
        run_couture("shape m_0.obj m_1.obj m_2.obj m_3.obj m_4.obj n_0.obj", folder.path());
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.errors, Contains("m_3 is much nearer to the mean when it is mirrored"));
    CHECK_THAT(result.errors, Contains("m_0 and n_0 have the same shape"));
}

TEST_CASE("shape inflate: twenty aneurysms, and a new one among them", "[drivers]") {
    const TemporaryFolder folder;
    constexpr int n_members = 20;
    for (int k = 0; k <= n_members; ++k) {
        const auto aneurysm = verification::make_synthetic_aneurysm(k);
        CAPTURE(aneurysm.name, verification::to_string(aneurysm.defect));
        io::write_surface(folder.path() / (aneurysm.name + ".ply"), aneurysm.surface);
        const std::string where = k < n_members ? " --out population" : " --out new";
        const Json object =
            run_json("shape inflate " + aneurysm.name + ".ply" + where, folder.path());
        CHECK(object["quads"] == 1536);
        CHECK(object["points"] == 1538);
        CHECK(object["contacts"].get<int>() > 1538 / 2);
        CHECK(object["max_strain"].get<double>() <= 3.0 + 1e-9);
    }
    const Json object =
        run_json("shape population/*.vtp --project new/aneurysm_20_inflated.vtp --png --out shape",
                 folder.path());
    CHECK(object["members"].size() == n_members);
    CHECK(object["kind"] == "quad mesh");
    CHECK(object["converged"] == true);
    CHECK(object["compactness"].back().get<double>() == Approx(1.0));
    const Json& projection = object["projections"][0];
    CHECK(projection["distance"].get<double>() < projection["distance_to_mean"].get<double>());
    CHECK(projection["nearest"].size() == 3);
}

TEST_CASE("shape inflate: options and mistakes", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("convert cube --edge-length 10 c.ply", folder.path()).exit_code == 0);
    const Json found = run_json("shape inflate c.ply --divisions 4 --png", folder.path());
    CHECK(found["quads"] == 96);
    for (const double x : found["center"])
        CHECK(std::abs(x - found["center"][0].get<double>()) < 5);
    CHECK(std::filesystem::exists(folder.path() / "out/c/c_inflated.png"));
    CHECK(std::filesystem::exists(folder.path() / "out/c/c_inflated.obj"));
    const auto errors = [&](const std::string& arguments) {
        const ProgramResult result = run_couture("shape inflate " + arguments, folder.path());
        CHECK(result.exit_code == 2);
        return result.errors;
    };
    CHECK_THAT(errors("c.ply --center 1,2"), Contains("--center '1,2' is no list"));
    CHECK_THAT(errors("c.ply --ball 1,2,3,4"), Contains("write X,Y,Z,RADIUS,LIMIT"));
    CHECK_THAT(errors("c.ply --strain-limit -1"), Contains("the strain limit is -1"));
    CHECK_THAT(errors("c.ply --divisions 0"), Contains("0 quads along an edge"));
    CHECK_THAT(errors("c.ply --center 900,0,0 --radius 1"), Contains("inflate_sphere: from"));
    CHECK_THAT(errors("c.ply --radius 1e5"), Contains("is not inside"));
    CHECK_THAT(errors("missing.ply"), Contains("missing.ply"));
}
