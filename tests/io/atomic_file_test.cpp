#include "io/atomic_file.h"

#include <catch2/catch.hpp>

#include "tests/io/temporary_folder.h"

using namespace couture::io;

TEST_CASE("remove_leftovers: only what killed writes left", "[io]") {
    const TemporaryFolder folder;
    for (const char* name : {"part_0001.vtu", ".part_0001.123.vtu", ".part.77.pvd", ".other.5.vtu",
                             ".part_0001.vtu", ".part.x1.vtu", "part.123.vtu"}) {
        write_text(folder / "files" / name, "x");
    }
    remove_leftovers(folder / "files", "part");
    const auto is_there = [&](const char* name) {
        return std::filesystem::exists(folder / "files" / name);
    };
    CHECK_FALSE(is_there(".part_0001.123.vtu"));
    CHECK_FALSE(is_there(".part.77.pvd"));
    for (const char* name :
         {"part_0001.vtu", ".other.5.vtu", ".part_0001.vtu", ".part.x1.vtu", "part.123.vtu"}) {
        CAPTURE(name);
        CHECK(is_there(name));
    }
    remove_leftovers(folder / "missing", "part");
}
