// Shapes of a cycle: one periodic parameter.
#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/atomic_file.h"
#include "io/off_surface.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Json = nlohmann::json;

namespace {

namespace fs = std::filesystem;

constexpr double turn = 2.0 * std::numbers::pi;

// Half an ellipsoid below the plane z = 0 that contracts, shortens and twists.
struct Ventricle {
    explicit Ventricle(double phase) {
        const double t = phase / 100.0;
        const double contraction = 0.5 * (1.0 - std::cos(turn * t)) + 0.12 * std::sin(2 * turn * t);
        width = 25.0 * (1.0 - 0.16 * contraction);
        height = 60.0 * (1.0 - 0.1 * contraction);
        twist = 0.35 * contraction;
    }
    static constexpr double flatness = 0.9;
    double width = 0.0;
    double height = 0.0;
    double twist = 0.0;

    [[nodiscard]] double volume() const { return turn / 3.0 * flatness * width * width * height; }
};

// Triangles of rings from the apex to the rim and on to the middle of the base.
//
// @param n  rings of each
meshing::TriangleSoup triangulated(const Ventricle& shape, int n) {
    const int n_around = 4 * n;
    meshing::TriangleSoup soup;
    const auto add_ring = [&](double radius, double z, double shift) {
        for (int j = 0; j < n_around; ++j) {
            const double angle = turn * (j + shift) / n_around + shape.twist * z / shape.height;
            soup.points.emplace_back(radius * std::cos(angle),
                                     Ventricle::flatness * radius * std::sin(angle), z);
        }
    };
    soup.points.emplace_back(0.0, 0.0, -shape.height);
    std::vector<int> rings;
    for (int i = 1; i <= n; ++i) {
        const double angle = 0.25 * turn * i / n;
        rings.push_back(static_cast<int>(soup.points.size()));
        add_ring(shape.width * std::sin(angle), i == n ? 0.0 : -shape.height * std::cos(angle),
                 0.5 * (i % 2));
    }
    for (int i = n - 1; i > 0; --i) {
        rings.push_back(static_cast<int>(soup.points.size()));
        add_ring(shape.width * i / n, 0.0, 0.5 * (i % 2));
    }
    const int last = static_cast<int>(soup.points.size());
    soup.points.emplace_back(0.0, 0.0, 0.0);
    for (int j = 0; j < n_around; ++j) {
        const int next = (j + 1) % n_around;
        soup.triangles.push_back({0, rings.front() + next, rings.front() + j});
        soup.triangles.push_back({last, rings.back() + j, rings.back() + next});
        for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
            const int a = rings[i];
            const int b = rings[i + 1];
            // Rings of odd number, from 1, are half an edge ahead.
            if (i % 2 == 0) {
                soup.triangles.push_back({a + j, a + next, b + next});
                soup.triangles.push_back({a + j, b + next, b + j});
            } else {
                soup.triangles.push_back({a + j, a + next, b + j});
                soup.triangles.push_back({a + next, b + next, b + j});
            }
        }
    }
    return soup;
}

void write_cycle(const fs::path& folder, const std::string& table, const std::string& stem,
                 const std::vector<double>& phases) {
    std::string lines = "phase, surface\n";
    for (std::size_t i = 0; i < phases.size(); ++i) {
        const std::string file = fmt::format("{}_{}.off", stem, i);
        io::write_off(folder / file,
                      triangulated(Ventricle(phases[i]), 14 + static_cast<int>(i % 3)), "");
        lines += fmt::format("{}, {}\n", phases[i], file);
    }
    io::write_text(folder / table, lines);
}

Json run_json(const std::string& arguments, const fs::path& folder) {
    const ProgramResult result = run_couture(arguments + " --json", folder);
    INFO(arguments);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

}  // namespace

TEST_CASE("rom: a heart beat is one periodic parameter", "[drivers]") {
    const TemporaryFolder folder;
    const fs::path& at = folder.path();
    for (const char* deck : {"mesh_beating_ventricle.toml", "rom_beating_ventricle.toml"}) {
        fs::copy_file(fs::path(COUTURE_SOURCE_DIR) / "tests/drivers/decks" / deck, at / deck);
    }
    std::vector<double> phases;
    for (int i = 0; i < 10; ++i) phases.push_back(10.0 * i);
    write_cycle(at, "ventricle_phases.csv", "ventricle", phases);
    // Contraction and expansion, as in Fig. 5.8 of [Maquart19].
    const std::array<double, 2> between{38.7, 81.0};
    write_cycle(at, "ventricle_between.csv", "between", {between[0], between[1]});
    run_json("rom train rom_beating_ventricle.toml --out o", at);
    const auto volume_at = [&](double phase) {
        const Json answer =
            run_json(fmt::format("rom eval o/rom_beating_ventricle.rom --set phase={}", phase), at);
        CHECK(answer.at("certificate") == "valid");
        return answer.at("volume").get<double>();
    };
    // Splines of this size are up to 1 % of the diagonal from the ellipsoid.
    constexpr double tolerance = 0.015;
    for (const double phase : {0.0, 15.0, between[0], 60.0, between[1], 97.0}) {
        CAPTURE(phase);
        CHECK(volume_at(phase) == Approx(Ventricle(phase).volume()).epsilon(tolerance));
    }
    // The end of a beat is the start of the next.
    CHECK(volume_at(100.0) == Approx(volume_at(0.0)).epsilon(1e-9));
    CHECK(volume_at(138.7) == Approx(volume_at(between[0])).epsilon(1e-9));

    const Json validation = run_json("rom validate rom_beating_ventricle.toml --out o", at);
    CAPTURE(validation.dump());
    CHECK(validation.at("points") == 2);
    // Points may slide around the axis: the shape is nearly one of revolution.
    CHECK(validation.at("errors").at("geometry").at("worst") < 0.1);
}
