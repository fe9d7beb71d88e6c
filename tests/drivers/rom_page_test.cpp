// Pages of reduced models, in a browser without a window.
#include <catch2/catch.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "drivers/rom_export_content.h"
#include "io/atomic_file.h"
#include "rom/field_sampler.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

namespace fs = std::filesystem;

/// The page's modes are rounded: relative to the largest value of a field.
constexpr double tolerance = 1e-4;

const std::string deck = R"(title = "A plate < with a hole"
[geometry]
part = "plate_with_hole_3d"
[discretization]
elements = 2
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[[symmetry]]
on = ["cut_x", "cut_y", "z_low"]
[[traction]]
on = "x_high"
value = [10, 0, 0]
)";

const std::string parameters = R"([rom]
design = "full"
samples = 3
[[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.6, 1.4]
unit = "mm"
[[rom.parameter]]
name = "nu"
key = "material.steel.poissons_ratio"
range = [0.25, 0.33]
levels = 3
[[rom.parameter]]
name = "load"
key = "traction.0.value.0"
range = [5, 15]
factored = true
[[rom.parameter]]
name = "E"
key = "material.steel.youngs_modulus"
range = [200, 220]
unit = "GPa"
factored = true
)";

std::string output_of(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string text;
    std::array<char, 4096> part{};
    for (std::size_t n = 0; (n = fread(part.data(), 1, part.size(), pipe)) > 0;) {
        text.append(part.data(), n);
    }
    pclose(pipe);
    return text;
}

/// A browser that runs without a window; empty: there is none.
std::string browser() {
    std::string name = output_of("command -v chromium chromium-browser google-chrome | head -n 1");
    while (!name.empty() && name.back() == '\n') name.pop_back();
    return name;
}

std::string browser_command(const fs::path& folder, const std::string& options,
                            const std::string& page, const std::string& address) {
    return "timeout 240 " + browser() +
           " --headless --no-sandbox --disable-quic --no-first-run --disable-background-networking "
           "--disable-component-update --disable-sync --enable-unsafe-swiftshader "
           "--virtual-time-budget=4000 --user-data-dir=" +
           (folder / "profile").string() + " " + options + " 'file://" + (folder / page).string() +
           "#" + address + "' 2>" + (folder / "browser.log").string();
}

/// What the page leaves for scripts.
Json answer_of(const fs::path& folder, const std::string& page, const std::string& address) {
    const std::string text = output_of(browser_command(folder, "--dump-dom", page, address));
    const std::string begin = R"(<script type="application/json" id="answer">)";
    const std::size_t first = text.find(begin);
    CAPTURE(text.substr(0, 500));
    REQUIRE(first != std::string::npos);
    const std::size_t from = first + begin.size();
    return Json::parse(text.substr(from, text.find("</script>", from) - from));
}

Json run_json(const std::string& arguments, const fs::path& folder) {
    const auto result = run_couture(arguments + " --json", folder);
    CAPTURE(arguments, result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

VectorX vector_of(const Json& list) {
    const auto values = list.get<std::vector<double>>();
    return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

double difference(const VectorX& one, const VectorX& expected) {
    REQUIRE(one.size() == expected.size());
    return (one - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("rom: a page in a browser answers as the program", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck + parameters);
    REQUIRE(run_couture("rom train f.toml --out .", folder.path()).exit_code == 0);
    const Json exported = run_json("rom export f.rom --html page.html", folder.path());
    const std::string page = io::read_text(folder.path() / "page.html");
    CHECK(exported["bytes"] == page.size());
    // One file that asks for no other, with a title that is no tag.
    CHECK_THAT(page, !Contains("http:") && !Contains("https:") && !Contains("src=") &&
                         !Contains("import ") && !Contains("COUTURE_"));
    CHECK_THAT(page, !Contains("plate < with") && Contains("plate \\u003c with"));
    if (browser().empty()) {
        WARN("no browser: the page is not run; the package chromium brings one");
        return;
    }

    const Json answer = answer_of(folder.path(), "page.html",
                                  "hole_radius=0.83&nu=0.31&load=7&E=203&answer=fields");
    CHECK(answer["values"]["hole_radius"] == 0.83);
    const Json expected =
        run_json("rom eval f.rom --set hole_radius=0.83 --set nu=0.31 --set load=7 --set E=203",
                 folder.path());
    CHECK(difference(vector_of(answer["coefficients"]), vector_of(expected["coefficients"])) <
          1e-8);
    CHECK(difference(vector_of(answer["errors"]["standard_errors"]),
                     vector_of(expected["standard_errors"])) < tolerance);
    for (const char* field : {"geometry", "displacement"}) {
        for (const char* kind : {"relative", "total", "truncation", "kriging"}) {
            CAPTURE(field, kind);
            CHECK(answer["errors"][field][kind].get<double>() ==
                  Approx(expected["estimates"][field][kind].get<double>()).epsilon(tolerance));
        }
    }
    CHECK(answer["errors"]["von_mises"].get<double>() ==
          Approx(expected["estimates"]["von_mises"].get<double>()).epsilon(tolerance));

    // All points of the page by the program's own way.
    const drivers::TrainedModel trained(folder.path() / "f.rom");
    const rom::ReducedModel& model = trained.model();
    const VectorX point = trained.point_of({"hole_radius=0.83", "nu=0.31", "load=7", "E=203"});
    const rom::FieldSampler sampler(model.space(), drivers::page_content(trained).grids);
    const rom::Evaluation evaluation = model.evaluate(point);
    const rom::FieldSamples samples = sampler.sample(
        evaluation.control_points, evaluation.displacement, trained.deck_at(point).problem);
    // Both list grid by grid, but the page takes the directions after the normal one in turn.
    std::vector<int> order;
    for (int g = 0; g < static_cast<int>(sampler.grids().size()); ++g) {
        const std::array<int, 3> n = sampler.grids()[g].sizes();
        const auto across = static_cast<int>(std::find(n.begin(), n.end(), 1) - n.begin());
        const std::array<int, 3> strides = {1, n[0], n[0] * n[1]};
        const int a = (across + 1) % 3;
        const int b = (across + 2) % 3;
        for (int j = 0; j < n[b]; ++j) {
            for (int i = 0; i < n[a]; ++i) {
                order.push_back(sampler.first_point(g) + i * strides[a] + j * strides[b]);
            }
        }
    }
    CHECK(order.size() == exported["points"]);
    const MatrixX x = samples.points(Eigen::all, order);
    const MatrixX u = samples.displacements(Eigen::all, order);
    CHECK(difference(vector_of(answer["x"]), x.reshaped()) < tolerance);
    CHECK(difference(vector_of(answer["u"]), u.reshaped()) < tolerance);
    CHECK(difference(vector_of(answer["von_mises"]), samples.von_mises(order)) < tolerance);
    for (const char* most : {"displacement_max", "von_mises_max"}) {
        CAPTURE(most);
        CHECK(answer[most].get<double>() ==
              Approx(expected[most].get<double>()).epsilon(tolerance));
    }

    // The picture shows something: it differs between two members.
    const auto shot = [&](const std::string& name, const std::string& address) {
        (void)output_of(browser_command(
            folder.path(), "--window-size=900,600 --screenshot=" + (folder.path() / name).string(),
            "page.html", address));
        return io::read_text(folder.path() / name);
    };
    CHECK(shot("a.png", "hole_radius=0.6") != shot("b.png", "hole_radius=1.4"));
}

TEST_CASE("rom: pages of problems whose stresses they can't compute say so", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck + R"([[temperature]]
change = 20
[rom]
design = "full"
samples = 2
[[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.6, 1.4]
)");
    REQUIRE(run_couture("rom train f.toml --out .", folder.path()).exit_code == 0);
    const auto result = run_couture("rom export f.rom", folder.path());
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.errors, Contains("the page shows displacements only") &&
                                  Contains("the deck has temperatures"));
    CHECK(fs::exists(folder.path() / "f.html"));
}
