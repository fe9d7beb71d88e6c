// The evaluator for other programs beside the program's own answers.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "drivers/rom_answer.h"
#include "io/atomic_file.h"
#include "rom/designs.h"
#include "rom/embed/couture_rom.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

namespace fs = std::filesystem;

const std::string part = R"([geometry]
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
[[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.6, 1.4]
unit = "mm"
)";

const std::string mechanics = R"([[rom.parameter]]
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

/// Of the values, relative to the largest.
constexpr double tolerance = 1e-10;

double difference(const VectorX& one, const VectorX& expected) {
    REQUIRE(one.size() == expected.size());
    return (one - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

VectorX vector_of(const std::vector<double>& values) {
    return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

struct Printed {
    std::map<std::string, VectorX> numbers;
    std::string text;
};

/// What tests/embed/main.cpp prints, a list to a line.
Printed run_example(const std::string& arguments, const fs::path& folder) {
    const auto result = run_couture("--version", folder,
                                    std::string(COUTURE_EMBED_EXAMPLE) + " " + arguments + " #");
    CAPTURE(arguments, result.errors);
    REQUIRE(result.exit_code == 0);
    Printed printed{{}, result.output};
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name;
        words >> name;
        std::vector<double> values;
        for (double value = 0.0; words >> value;) values.push_back(value);
        printed.numbers[name] = vector_of(values);
    }
    return printed;
}

/// Compares with rom eval and with all sample points.
void compare(const fs::path& folder, const std::vector<std::string>& settings) {
    std::string list;
    std::string set;
    for (const std::string& one : settings) {
        list += " '" + one + "'";
        set += " --set '" + one + "'";
    }
    const auto eval = run_couture("rom eval f.rom --json" + set, folder);
    REQUIRE(eval.exit_code == 0);
    const Json expected = Json::parse(eval.output);
    const Printed found = run_example("f.bin" + list, folder);
    const auto list_of = [&](const char* name) {
        return vector_of(expected[name].get<std::vector<double>>());
    };
    CHECK(difference(found.numbers.at("coefficients"), list_of("coefficients")) < tolerance);
    CHECK(difference(found.numbers.at("standard_errors"), list_of("standard_errors")) < 1e-6);
    CHECK(found.numbers.at("maxima")[0] ==
          Approx(expected["displacement_max"].get<double>()).epsilon(tolerance));
    CHECK(found.numbers.at("maxima")[1] ==
          Approx(expected["von_mises_max"].get<double>()).epsilon(tolerance));
    for (const char* field : {"geometry", "displacement"}) {
        const Json& estimate = expected["estimates"][field];
        const VectorX& one = found.numbers.at(std::string(field) + "_error");
        int i = 0;
        for (const char* kind : {"relative", "total", "truncation", "kriging"}) {
            CAPTURE(field, kind);
            // Of kriging's variances rounding leaves fewer digits.
            CHECK(one[i++] == Approx(estimate[kind].get<double>()).epsilon(1e-6));
        }
    }
    CHECK(found.numbers.at("von_mises_error")[0] ==
          Approx(expected["estimates"]["von_mises"].get<double>()).epsilon(1e-6));

    const drivers::TrainedModel trained(folder / "f.rom");
    const VectorX point = trained.point_of(settings);
    const rom::FieldSampler sampler = drivers::answer_sampler(trained.model());
    const rom::Evaluation evaluation = trained.model().evaluate(point);
    const rom::FieldSamples samples = sampler.sample(
        evaluation.control_points, evaluation.displacement, trained.deck_at(point).problem);
    CHECK(difference(found.numbers.at("points"), samples.points.reshaped()) < tolerance);
    CHECK(difference(found.numbers.at("displacements"), samples.displacements.reshaped()) <
          tolerance);
    CHECK(difference(found.numbers.at("von_mises"), samples.von_mises) < tolerance);
}

/// The bytes with the size and the checksum that they should have.
std::string with_checksum(std::string bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (std::size_t i = 32; i < bytes.size(); ++i) {
        hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3ULL;
    }
    for (unsigned i = 0; i < 8; ++i) {
        bytes[16 + i] = static_cast<char>(bytes.size() >> (8 * i) & 0xffU);
        bytes[24 + i] = static_cast<char>(hash >> (8 * i) & 0xffU);
    }
    return bytes;
}

void train(const fs::path& folder, const std::string& deck) {
    io::write_text(folder / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out .", folder).exit_code == 0);
    const auto exported = run_couture("rom export f.rom --binary f.bin", folder);
    CAPTURE(exported.errors);
    REQUIRE(exported.exit_code == 0);
}

}  // namespace

TEST_CASE("rom: the evaluator for other programs answers as the program", "[drivers]") {
    const TemporaryFolder folder;
    // A tensor design; one factor; a stacked basis; other correlation and trend.
    const std::string rom = GENERATE(
        "[rom]\ndesign = \"full\"\nsamples = 3\n", "[rom]\ndesign = \"lhs\"\nsamples = 4\n",
        "[rom]\ndesign = \"full\"\nsamples = 3\nbasis = \"stacked\"\ntrend = \"linear\"\n",
        "[rom]\ndesign = \"full\"\nsamples = 3\ncorrelation = \"gaussian\"\nmodes = 2\n");
    CAPTURE(rom);
    const bool has_mechanics = rom.find("lhs") == std::string::npos;
    train(folder.path(), rom + part + (has_mechanics ? mechanics : ""));
    if (has_mechanics) {
        compare(folder.path(), {"hole_radius=0.83", "nu=0.31", "load=7", "E=203"});
        compare(folder.path(), {"hole_radius=1.5", "load=4"});
    } else {
        compare(folder.path(), {"hole_radius=0.83"});
    }
    const Printed outside = run_example("f.bin hole_radius=1.6", folder.path());
    CHECK_THAT(outside.text, Contains("warning hole_radius = 1.6") && Contains("by 25 % of"));
    CHECK_THAT(outside.text, Contains("title f\nunits mm MPa\nparameter hole_radius 0.59999") &&
                                 Contains("1.3999999999999999 mm"));
}

TEST_CASE("rom: the evaluator takes temperatures for displacements only", "[drivers]") {
    const TemporaryFolder folder;
    train(folder.path(),
          "[rom]\ndesign = \"full\"\nsamples = 2\n" + part + "[[temperature]]\nchange = 20\n");
    const Printed found = run_example("f.bin", folder.path());
    CHECK(found.numbers.at("von_mises").size() == 0);
    CHECK(found.numbers.at("maxima")[0] >= 0.0);
    CHECK_THAT(found.text, Contains("no_stress the deck has temperatures"));
}

TEST_CASE("rom: the evaluator refuses files that are not whole or of another version",
          "[drivers]") {
    const TemporaryFolder folder;
    train(folder.path(), "[rom]\ndesign = \"full\"\nsamples = 2\n" + part);
    const std::string whole = io::read_text(folder.path() / "f.bin");
    const auto error_of = [](const std::string& bytes) -> std::string {
        try {
            static_cast<void>(couture_rom::Model::from_bytes({bytes.begin(), bytes.end()}, "m"));
        } catch (const couture_rom::Error& error) {
            return error.what();
        }
        return {};
    };
    CHECK(error_of(whole).empty());
    // Cut at every of many places.
    for (std::size_t n = 0; n < whole.size(); n += 1 + whole.size() / 97) {
        CHECK_THAT(error_of(whole.substr(0, n)),
                   Contains("m: is no model") || Contains("it was cut off or changed"));
    }
    CHECK_THAT(error_of(whole + "x"), Contains("it was cut off or changed"));
    for (std::size_t i = 0; i < whole.size(); i += 1 + whole.size() / 97) {
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ 0x10);
        CHECK_FALSE(error_of(changed).empty());
    }
    std::string newer = whole;
    newer[8] = 3;
    CHECK_THAT(error_of(newer), Contains("is of version 3, this program reads version 2"));
    CHECK_THAT(error_of("solid part"), Contains("is no model of 'couture rom export --binary'"));
    // What a checksum does not find: files that were written wrong.
    CHECK_THAT(error_of(with_checksum(whole.substr(0, whole.size() - 8))),
               Contains("m: does not fit together"));
    CHECK_THAT(error_of(with_checksum(whole + "12345678")),
               Contains("there are bytes after its end"));
    const MatrixX places = rom::random_design(2, 400, 11);
    for (Eigen::Index i = 0; i < places.rows(); ++i) {
        // Most of them among the counts at the beginning.
        const double part = std::pow(places(i, 0), 4);
        std::string wrong = whole;
        wrong[32 + static_cast<std::size_t>(part * static_cast<double>(whole.size() - 33))] =
            static_cast<char>(256.0 * places(i, 1));
        wrong = with_checksum(wrong);
        try {
            static_cast<void>(
                couture_rom::Model::from_bytes({wrong.begin(), wrong.end()}).evaluate({1.0}));
        } catch (const couture_rom::Error&) {
            // Also well: nothing else may happen.
        }
    }

    const auto model = couture_rom::Model::load(folder.path() / "f.bin");
    CHECK_THROWS_WITH(couture_rom::Model::load("/nowhere"), Contains("/nowhere: can't be opened"));
    CHECK_THROWS_WITH(model.evaluate({1.0, 2.0}), Contains("one for each of 1 parameters"));
    CHECK_THROWS_WITH(model.evaluate({std::nan("")}), Contains("it must be finite"));
    CHECK_THROWS_WITH(model.index_of("radius"),
                      Contains("no parameter is called 'radius'; there are hole_radius"));
    CHECK(model.parameters()[0].reference == 1.0);
    CHECK(model.n_validated() == 0);
}
