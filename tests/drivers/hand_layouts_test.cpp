// Layouts of cuboids that are written by hand, by the names of their nodes: those of [Maquart19]
// Fig. 6.4 and 6.5, and such as can't be drawn on the surface.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/atomic_file.h"
#include "meshing/layout/polycube_templates.h"
#include "meshing/layout/volumetric_layout.h"
#include "tests/drivers/run_program.h"
#include "tests/meshing/layout/layout_samples.h"

using namespace couture;
using namespace couture::meshing;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace fs = std::filesystem;

namespace {

constexpr double size = 10.0;

PlacedLayout polycube(const std::vector<GridCell>& cells) {
    const CuboidTemplate shape = make_polycube_template("polycube", cells, {});
    PlacedLayout placed{shape.layout, shape.positions};
    for (Vector3& x : placed.positions) x *= size;
    return placed;
}

// A triangular prism as three cuboids around its axis: sides of the triangle are halved.
PlacedLayout prism_of_three() {
    PlacedLayout placed;
    placed.layout.n_nodes = 14;
    for (const double z : {0.0, 1.5 * size}) {
        std::vector<Vector3> corners;
        for (int k = 0; k < 3; ++k) {
            const double angle = std::numbers::pi * (0.5 + 2.0 * k / 3.0);
            corners.emplace_back(size * std::cos(angle), size * std::sin(angle), z);
        }
        for (int k = 0; k < 3; ++k) {
            placed.positions.push_back(corners[k]);
            placed.positions.emplace_back(0.5 * (corners[k] + corners[(k + 1) % 3]));
        }
        placed.positions.emplace_back(0.0, 0.0, z);
    }
    for (int k = 0; k < 3; ++k) {
        const int corner = 2 * k;
        const int before = (2 * k + 5) % 6;
        placed.layout.cuboids.push_back(
            {corner, corner + 1, before, 6, corner + 7, corner + 8, before + 7, 13});
    }
    return placed;
}

// A square ring of square section, mitred.
PlacedLayout square_ring() {
    PlacedLayout placed{test::ring_of_cuboids(4), {}};
    for (int k = 0; k < 4; ++k) {
        const double x = k == 1 || k == 2 ? 1.0 : -1.0;
        const double y = k >= 2 ? 1.0 : -1.0;
        // Corners of a section: direction 1 outwards, direction 2 upwards.
        for (const auto& [radius, z] : {std::pair{3.0, 0.0}, {1.0, 0.0}, {3.0, 2.0}, {1.0, 2.0}}) {
            placed.positions.emplace_back(size * radius * x, size * radius * y, size * z);
        }
    }
    return placed;
}

std::string name_of(int node) { return fmt::format("n{}", node); }

std::string point_of(const Vector3& x) {
    return fmt::format("[{:.12g}, {:.12g}, {:.12g}]", x.x(), x.y(), x.z());
}

std::string text_of(const PlacedLayout& placed) {
    std::string text = "[nodes]\n";
    for (int n = 0; n < placed.layout.n_nodes; ++n) {
        text += fmt::format("{} = {}\n", name_of(n), point_of(placed.positions[n]));
    }
    for (const auto& nodes : placed.layout.cuboids) {
        std::string names;
        for (const int node : nodes) names += fmt::format("\"{}\", ", name_of(node));
        text += fmt::format("[[cuboid]]\nnodes = [{}]\n", names);
    }
    return text;
}

// The boundary of a layout, each quad divided into triangles.
std::string surface_of(const PlacedLayout& placed) {
    constexpr int n = 4;
    std::map<std::array<long, 3>, int> numbers;
    std::vector<Vector3> points;
    const auto number = [&](const Vector3& x) {
        constexpr double unit = 1e-6;
        const auto [at, is_new] =
            numbers.emplace(std::array{std::lround(x.x() / unit), std::lround(x.y() / unit),
                                       std::lround(x.z() / unit)},
                            static_cast<int>(points.size()));
        if (is_new) points.push_back(x);
        return at->second;
    };
    std::string triangles;
    int n_triangles = 0;
    const LayoutBoundary boundary = layout_boundary(placed.layout);
    for (const auto& quad : boundary.layout.quads()) {
        const auto point = [&](int i, int j) {
            const double s = static_cast<double>(i) / n;
            const double t = static_cast<double>(j) / n;
            const auto& x = placed.positions;
            return number((1 - t) * ((1 - s) * x[quad[0]] + s * x[quad[1]]) +
                          t * ((1 - s) * x[quad[3]] + s * x[quad[2]]));
        };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const int a = point(i, j);
                const int c = point(i + 1, j + 1);
                triangles += fmt::format("3 {} {} {}\n3 {} {} {}\n", a, point(i + 1, j), c, a, c,
                                         point(i, j + 1));
                n_triangles += 2;
            }
        }
    }
    std::string text = fmt::format("OFF\n{} {} 0\n", points.size(), n_triangles);
    for (const Vector3& x : points) {
        text += fmt::format("{:.17g} {:.17g} {:.17g}\n", x.x(), x.y(), x.z());
    }
    return text + triangles;
}

void write_deck(const fs::path& folder, const std::string& geometry, const std::string& layout) {
    io::write_text(folder / "hand.toml", layout);
    io::write_text(folder / "job.toml", "[geometry]\n" + geometry +
                                            "[meshing]\nelement_size = 5\nstage = \"volume\"\n"
                                            "layout = \"hand.toml\"\n");
}

// Nothing is written but what an error names.
void check_refused(const fs::path& folder, const std::string& text) {
    fs::remove_all(folder / "o");
    const ProgramResult result = run_couture("mesh job.toml --out o", folder);
    CAPTURE(result.output, result.errors);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.errors, Contains(text));
    // Stages before are kept, there is no volume.
    CHECK_FALSE(fs::exists(folder / "o/job_volume.xml"));
}

const std::vector<GridCell> bar{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
const std::vector<GridCell> tee{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}};

}  // namespace

TEST_CASE("mesh: cuboids of the reference's figures, written by hand", "[drivers]") {
    std::vector<GridCell> plate{{1, 1, 1}};
    for (int k = 0; k < 9; ++k) plate.push_back({k % 3, k / 3, 0});
    std::vector<GridCell> double_bar = bar;
    for (const GridCell& cell : {GridCell{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1, 0, 2}}) {
        double_bar.push_back(cell);
    }
    const auto [figure, placed, n_nodes] = GENERATE_COPY(
        table<std::string, PlacedLayout, int>({{"6.4 A", polycube(double_bar), 28},
                                               {"6.4 B", polycube(plate), 36},
                                               {"6.4 C", polycube(tee), 20},
                                               {"6.5 D", prism_of_three(), 14},
                                               {"6.5 E", square_ring(), 16},
                                               {"6.5 F", polycube({{0, 0, 0}, {1, 0, 0}}), 12}}));
    CAPTURE(figure);
    REQUIRE(placed.layout.n_nodes == n_nodes);
    const TemporaryFolder folder;
    io::write_text(folder.path() / "solid.off", surface_of(placed));
    write_deck(folder.path(), "surface = \"solid.off\"\n", text_of(placed));
    const auto result = run_couture("mesh job.toml --json --out o", folder.path());
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["layout"]["cuboids"] == placed.layout.n_cuboids());
    CHECK(object["volume"]["certificate"] == "valid");
    CHECK(object["volume"]["hausdorff"].get<double>() < 1e-9);
    CHECK(object["warnings"].empty());
}

TEST_CASE("mesh: the flattened cuboids of a round cylinder of 12 nodes are padded", "[drivers]") {
    // [Maquart19] Fig. 6.5 C. The part's axis is x.
    const TemporaryFolder folder;
    const auto info =
        nlohmann::json::parse(run_couture("info cylinder --json", folder.path()).output);
    const auto low = info["bounding_box"]["low"].get<std::vector<double>>();
    const auto high = info["bounding_box"]["high"].get<std::vector<double>>();
    int axis = 0;
    for (int d = 1; d < 3; ++d) {
        if (high[d] - low[d] > high[axis] - low[axis]) axis = d;
    }
    const double radius = 0.5 * (high[(axis + 1) % 3] - low[(axis + 1) % 3]);
    PlacedLayout placed = polycube({{0, 0, 0}, {1, 0, 0}});
    REQUIRE(placed.layout.n_nodes == 12);
    for (Vector3& x : placed.positions) {
        const Vector3 unit = x / size;
        x[axis] = low[axis] + 0.5 * unit.x() * (high[axis] - low[axis]);
        for (int k = 1; k < 3; ++k) {
            const int d = (axis + k) % 3;
            x[d] = 0.5 * (low[d] + high[d]) + (2.0 * unit[k] - 1.0) * radius * std::sqrt(0.5);
        }
    }
    write_deck(folder.path(), "part = \"cylinder\"\n", text_of(placed));
    const auto result =
        run_couture("mesh job.toml --json --out o --set meshing.element_size=20", folder.path());
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["layout"]["cuboids"] == 10);
    CHECK(object["volume"]["certificate"] == "valid");
    CHECK(object["volume"]["min_scaled_jacobian"].get<double>() > 0.5);
}

TEST_CASE("mesh: prisms are no cuboids, and what to do instead is said", "[drivers]") {
    // [Maquart19] Fig. 6.5 A, and B: a ring of them.
    const TemporaryFolder folder;
    const PlacedLayout placed = prism_of_three();
    io::write_text(folder.path() / "solid.off", surface_of(placed));
    const std::string nodes = text_of(placed).substr(0, text_of(placed).find("[[cuboid]]"));
    write_deck(folder.path(), "surface = \"solid.off\"\n",
               nodes +
                   "[[cuboid]]\nnodes = [\"n0\", \"n2\", \"n4\", \"n4\", \"n7\", \"n9\", "
                   "\"n11\", \"n11\"]\n");
    check_refused(folder.path(),
                  "hand.toml:17: node 'n4' stands twice in the cuboid; its 8 nodes "
                  "must be different. A prism of triangles is no cuboid: halve");
    CHECK_THAT(run_couture("check job.toml", folder.path()).errors, Contains("'n4' stands twice"));
}

TEST_CASE("mesh: layouts by hand that can't be drawn are refused by their nodes", "[drivers]") {
    const TemporaryFolder folder;
    const PlacedLayout placed = polycube(tee);
    io::write_text(folder.path() / "solid.off", surface_of(placed));
    const auto refused = [&](const PlacedLayout& changed, const std::string& text) {
        write_deck(folder.path(), "surface = \"solid.off\"\n", text_of(changed));
        check_refused(folder.path(), text);
    };
    const auto at = [&](double x, double y, double z) {
        const Vector3 place(x, y, z);
        const auto found = std::ranges::find_if(
            placed.positions, [&](const Vector3& p) { return (p - place).norm() < 1e-9; });
        REQUIRE(found != placed.positions.end());
        return static_cast<int>(found - placed.positions.begin());
    };
    PlacedLayout off = placed;
    off.positions[at(0, 0, 10)].z() = 13.0;
    refused(off, fmt::format("layout: node '{}' at (0, 0, 13) lies 3 from the surface",
                             name_of(at(0, 0, 10))));
    PlacedLayout same = placed;
    same.positions[at(20, 0, 10)].y() = 9.9;
    refused(same, "both come to (20, 10, 10) on the surface");
    // Two nodes in each other's place: quads fold.
    PlacedLayout swapped = placed;
    std::swap(swapped.positions[at(20, 0, 10)], swapped.positions[at(20, 10, 10)]);
    refused(swapped, "in the quad of nodes '");
    // Cuboids that touch at a node only, and the wrong genus.
    PlacedLayout touching;
    touching.layout.n_nodes = 15;
    touching.layout.cuboids = {{0, 1, 2, 3, 4, 5, 6, 7}, {7, 8, 9, 10, 11, 12, 13, 14}};
    for (int n = 0; n < 15; ++n) {
        const int corner = n < 8 ? n : n - 7;
        const Vector3 unit(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        touching.positions.emplace_back(size * (unit + (n < 8 ? 0.0 : 1.0) * Vector3::Ones()));
    }
    refused(touching, "quads touch at node 'n7' only; around a node they form one fan");
    io::write_text(folder.path() / "solid.off", surface_of(square_ring()));
    PlacedLayout ball = polycube({{0, 0, 0}});
    for (Vector3& x : ball.positions) x = Vector3(-30, -30, 0) + x.cwiseProduct(Vector3(6, 6, 2));
    refused(ball,
            "its boundary has Euler characteristic 2, the surface 0; they must have the same "
            "genus");
}

TEST_CASE("mesh: sharp edges that no arc runs along are told", "[drivers]") {
    const TemporaryFolder folder;
    // A box with a step on one side that is no cuboid of its own.
    PlacedLayout placed = polycube({{0, 0, 0}, {1, 0, 0}});
    PlacedLayout bent = placed;
    for (Vector3& x : bent.positions) {
        if (std::abs(x.x() - size) < 1e-9) x.z() += x.z() > 0.0 ? 4.0 : 0.0;
    }
    io::write_text(folder.path() / "solid.off", surface_of(bent));
    // One cuboid from end to end: the ridge in the middle runs across two of its quads.
    PlacedLayout one = polycube({{0, 0, 0}});
    for (Vector3& x : one.positions) x.x() *= 2.0;
    write_deck(folder.path(), "surface = \"solid.off\"\n", text_of(one));
    const auto result =
        run_couture("mesh job.toml --json --out o --set meshing.feature_angle=20", folder.path());
    CAPTURE(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto object = nlohmann::json::parse(result.output);
    CHECK_THAT(object["warnings"].dump(),
               Contains("no arc runs along 10 of the length 10 of the sharp edge") &&
                   Contains("near (10, ") && Contains("it is rounded there") &&
                   Contains("are rounded by "));
    // Splines of whole elements round it, but not by nothing.
    CHECK(object["volume"]["certificate"] == "valid");
}
