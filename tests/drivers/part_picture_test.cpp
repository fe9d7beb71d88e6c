#include "drivers/part_picture.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "io/atomic_file.h"
#include "meshing/parts/part_dimensions.h"
#include "meshing/parts/part_surface.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::drivers;
using Catch::Matchers::Contains;

TEST_CASE("make_part_views: every size and cap of every part has its text", "[drivers]") {
    for (const meshing::PartInfo& part : meshing::part_surfaces()) {
        CAPTURE(part.name);
        std::multiset<std::string> texts;
        std::size_t n_sections = 0;
        for (const auto& row : make_part_views(part.name)) {
            for (const io::Scene& view : row) {
                for (const io::Label& label : view.labels) {
                    texts.insert(label.text);
                    n_sections += label.text.starts_with("section ") ? 1 : 0;
                }
                CHECK(view.width < 1200);
                CHECK(view.height < 800);
            }
        }
        for (const meshing::PartParameter& parameter : part.parameters) {
            CHECK(std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
                return text.starts_with(parameter.name + " = ");
            }));
        }
        // In the whole and in a view to scale.
        for (const meshing::PartFace& face : meshing::make_part_surface(part.name).faces) {
            CHECK((!face.is_cap || texts.count(face.name) == 2));
        }
        const bool has_section =
            part.name == "wheel" || part.name == "casting" || part.name == "torus";
        CHECK(n_sections == (has_section ? 1 : 0));
    }
    CHECK_THROWS_WITH(make_part_views("whel"), Contains("did you mean 'wheel'?"));
    CHECK_THROWS_WITH(make_part_views("plate", {{"P1", 60.0}}),
                      Contains("P1 = 60 is out of range"));
}

TEST_CASE("make_part_views: given values are shown", "[drivers]") {
    std::set<std::string> texts;
    for (const auto& row : make_part_views("pant", {{"X1", 12.5}})) {
        for (const io::Scene& view : row) {
            for (const io::Label& label : view.labels) {
                texts.insert(label.text);
            }
        }
    }
    CHECK(texts.contains("X1 = 12.5"));
    CHECK(texts.contains("Y1 = -30"));
}

TEST_CASE("write_part_picture: a picture appears", "[drivers]") {
    if (const auto missing = io::missing_for_pictures()) {
        if (std::getenv("CI") != nullptr) {
            FAIL(*missing);
        }
        WARN("skipped: " << *missing);
        return;
    }
    const io::TemporaryFolder folder;
    write_part_picture(folder / "wheel.png", "wheel");
    CHECK(std::filesystem::file_size(folder / "wheel.png") > 10000);
    CHECK(std::filesystem::file_size(folder / "wheel.png") < 100000);
}
