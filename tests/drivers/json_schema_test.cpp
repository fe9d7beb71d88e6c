// Keys and types of a run's JSON are those of its schema, both ways.
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using Json = nlohmann::json;

namespace {

/// Rows "| `key` | type | meaning |" of the first table: key -> type. A type that ends with
/// "optional" may be absent.
std::map<std::string, std::string> read_schema(const std::string& file) {
    std::istringstream text(io::read_text(COUTURE_SOURCE_DIR "/drivers/" + file));
    std::map<std::string, std::string> schema;
    for (std::string line; std::getline(text, line);) {
        if (!line.starts_with("| `")) {
            continue;
        }
        const std::size_t key_end = line.find('`', 3);
        const std::size_t type = line.find("| ", key_end) + 2;
        schema[line.substr(3, key_end - 3)] = line.substr(type, line.find(" |", type) - type);
    }
    return schema;
}

std::string type_of(const Json& value) {
    if (value.is_number_integer()) {
        return "integer";
    }
    if (value.is_array() && value.size() == 3 && value[0].is_number()) {
        return "vector";
    }
    return value.type_name();
}

bool fits(const Json& value, const std::string& type) {
    const std::string actual = type_of(value);
    return actual == type || (type == "number" && actual == "integer") ||
           (type == "array" && actual == "vector");
}

/// Walks through all keys; those that begin with "reactions" have names of sets as keys.
void collect(const Json& object, const std::string& prefix, std::map<std::string, Json>& found) {
    for (const auto& [key, value] : object.items()) {
        const std::string path = prefix + key;
        found[path] = value;
        if (value.is_object() && !key.starts_with("reactions")) {
            collect(value, path + ".", found);
        } else if (value.is_array()) {
            for (const Json& item : value) {
                if (item.is_object()) {
                    collect(item, path + "[].", found);
                }
            }
        }
    }
}

/// Every key is documented with its type, and every one that is not optional is there.
void check_schema(const std::map<std::string, Json>& found, const std::string& file) {
    const std::map<std::string, std::string> schema = read_schema(file);
    REQUIRE(schema.size() >= 6);
    for (const auto& [key, value] : found) {
        CAPTURE(key, value.dump());
        REQUIRE(schema.count(key) == 1);
        std::string type = schema.at(key);
        type = type.substr(0, type.find(','));
        CHECK(fits(value, type));
    }
    for (const auto& [key, type] : schema) {
        CAPTURE(key);
        CHECK((found.count(key) == 1 || type.ends_with("optional")));
    }
}

}  // namespace

TEST_CASE("schema: a run's JSON has the keys and types that are documented", "[drivers]") {
    const tests::TemporaryFolder folder;
    const std::string deck = GENERATE("solve_bar.toml",
                                      "half_seal.toml --set geometry.parameters.divisions=1 "
                                      "--set output.probe.0.t=1 --set output.probe.0.tolerance=1");
    const auto result = tests::run_couture(
        "solve --json '" COUTURE_SOURCE_DIR "/drivers/decks/'" + deck, folder.path());
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    std::map<std::string, Json> found;
    collect(Json::parse(result.output), "", found);
    CHECK(found.count("history[].remeshing.cause") == (deck.starts_with("solve_bar") ? 0 : 1));
    check_schema(found, "schema.md");
}

TEST_CASE("schema: the JSON of mesh has the keys and types that are documented", "[drivers]") {
    const tests::TemporaryFolder folder;
    const std::string job = GENERATE("plate_with_two_holes --edge-length 8",
                                     "pant --open caps --stage surfaces --element-size 20",
                                     "pant --open caps --stage hexes --points 3 --element-size 20",
                                     "pant --open caps --stage field");
    const auto result = tests::run_couture("mesh --json " + job, folder.path());
    REQUIRE(result.exit_code == 0);
    std::map<std::string, Json> found;
    collect(Json::parse(result.output), "", found);
    CHECK(found.count("patches[].boundary[].left") == 1);
    const bool has_hexes = job.find("hexes") != std::string::npos;
    CHECK(found.count("volume.signature") == (has_hexes ? 1 : 0));
    CHECK(found.count("hexes.elements") == (has_hexes ? 1 : 0));
    CHECK(found.count("surfaces.area") == (job.find("surfaces") != std::string::npos ? 1 : 0));
    CHECK(found.count("field.freedom") == (job.ends_with("field") ? 1 : 0));
    check_schema(found, "mesh_schema.md");
}

TEST_CASE("schema: the JSON of a family has the keys and types that are documented", "[drivers]") {
    const tests::TemporaryFolder folder;
    io::write_text(folder.path() / "m.csv", "length\n120\n5000\n");
    io::write_text(folder.path() / "f.toml",
                   "[geometry]\npart = \"cube\"\n[meshing]\nelement_size = 50\n[family]\n"
                   "parameters = \"m.csv\"\n");
    const auto result = tests::run_couture("mesh f.toml --json", folder.path());
    CHECK(result.exit_code == 1);
    Json object = Json::parse(result.output);
    // Names of parameters are those of the part.
    for (Json& member : object["members"]) member["parameters"] = Json::object();
    std::map<std::string, Json> found;
    collect(object, "", found);
    CHECK(found.count("members[].homology.worst_curve") == 1);
    check_schema(found, "mesh_family_schema.md");
}

TEST_CASE("schema: the JSON of shape has the keys and types that are documented", "[drivers]") {
    const tests::TemporaryFolder folder;
    for (const int k : {100, 110, 130, 150}) {
        const std::string length = std::to_string(k);
        const auto result = tests::run_couture("mesh cube --set length=" + length +
                                                   " --stage volume --element-size " +
                                                   std::to_string(3 * k / 5) + " --out " + length,
                                               folder.path());
        REQUIRE(result.exit_code == 0);
    }
    const bool has_volumes = GENERATE(true, false);
    const auto result = tests::run_couture(
        has_volumes ? "shape 100/cube_volume.xml 110/cube_volume.xml 130/cube_volume.xml --virtual "
                      "0.5 --project 150/cube_volume.xml --json"
                    : "shape 100/cube_volume.xml 110/cube_volume.xml --json",
        folder.path());
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    std::map<std::string, Json> found;
    collect(Json::parse(result.output), "", found);
    CHECK(found.count("projections[].nearest[].name") == (has_volumes ? 1 : 0));
    CHECK(found.count("generalisation.values") == (has_volumes ? 1 : 0));
    check_schema(found, "shape_schema.md");
}

TEST_CASE("schema: the JSON of shape inflate has the keys and types that are documented",
          "[drivers]") {
    const tests::TemporaryFolder folder;
    REQUIRE(tests::run_couture("convert cube --edge-length 20 c.ply", folder.path()).exit_code ==
            0);
    const std::string options =
        GENERATE("", " --outlet-strain-limit 2 --hole-size 1 --ball 0,0,0,5,2");
    const auto result = tests::run_couture("shape inflate c.ply --json" + options, folder.path());
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    std::map<std::string, Json> found;
    collect(Json::parse(result.output), "", found);
    CHECK(found.count("hole_size") == (options.empty() ? 0 : 1));
    check_schema(found, "shape_inflate_schema.md");
}

TEST_CASE("schema: the JSON of reduced models has the keys and types that are documented",
          "[drivers]") {
    const tests::TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", R"([geometry]
part = "box"
[material.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[[fixed]]
on = "x_low"
[[traction]]
on = "x_high"
value = [1, 2, 0]
[rom]
[[rom.parameter]]
key = "material.steel.poissons_ratio"
range = [0.2, 0.35]
levels = 3
)");
    io::write_text(folder.path() / "g.toml", R"([geometry]
part = "plate_with_hole_3d"
[material.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
density = 7.85e-9
[[symmetry]]
on = ["cut_x", "cut_y", "z_low"]
[[traction]]
on = "x_high"
value = [10, 0, 0]
[rom]
[[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.6, 1.4]
)");
    const auto check_command = [&](const std::string& command, const std::string& schema) {
        const auto result = tests::run_couture("rom " + command + " --json", folder.path());
        CAPTURE(command, result.errors);
        REQUIRE(result.exit_code == 0);
        std::map<std::string, Json> found;
        collect(Json::parse(result.output), "", found);
        check_schema(found, schema);
    };
    check_command("train f.toml", "rom_train_schema.md");
    check_command("validate f.toml -n 3 --galerkin", "rom_validate_schema.md");
    check_command("eval out/f/f.rom --solve --galerkin", "rom_eval_schema.md");
    check_command("export out/f/f.rom --html f.html", "rom_export_schema.md");
    check_command("export out/f/f.rom --binary f.bin", "rom_export_schema.md");
    check_command("train g.toml", "rom_train_schema.md");
    check_command("optimize out/g/g.rom --stress-limit 1000 --displacement-limit 1 --starts 2",
                  "rom_optimize_schema.md");
    check_command("sensitivity out/g/g.rom --samples 16", "rom_sensitivity_schema.md");
    check_command("merge g.toml out/g --out out/merged", "rom_merge_schema.md");
    check_command("enrich g.toml --tolerance 0.5", "rom_enrich_schema.md");
}
