#include "io/snapshot_store.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "io/atomic_file.h"
#include "meshing/parts/parts.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

const std::string job = "{\"model\": \"a\", \"points\": 3}\n";
const std::string signature = "0123456789abcdef";

MatrixX some_numbers(int rows, int columns) {
    MatrixX values(rows, columns);
    for (Eigen::Index i = 0; i < values.size(); ++i) values.data()[i] = 1.0 / (3.0 + i);
    return values;
}

}  // namespace

TEST_CASE("snapshot store: what is written is read again, bit by bit", "[io]") {
    const io::TemporaryFolder folder;
    const MatrixX points = some_numbers(4, 3);
    const MatrixX displacements = some_numbers(12, 2);
    {
        io::SnapshotStore store(folder / "store", job);
        CHECK_FALSE(store.has_geometry(3));
        store.write_geometry(3, points, signature);
        store.write_solution(3, 1, displacements, signature);
        store.write_geometry_failure(4, "folded");
    }
    io::SnapshotStore store(folder / "store", job);
    CHECK(store.has_geometry(3));
    CHECK(store.geometry(3, signature) == points);
    CHECK(store.solution(3, 1, signature) == displacements);
    CHECK_FALSE(store.has_solution(3, 0));
    CHECK(store.geometry_failure(4) == "folded");
    store.clear_failures();
    CHECK_FALSE(store.geometry_failure(4));
    CHECK_THROWS_WITH(static_cast<void>(store.geometry(3, "other")),
                      Contains("signature other") || Contains("and other"));
}

TEST_CASE("snapshot store: equal contents make equal files", "[io]") {
    const io::TemporaryFolder first;
    const io::TemporaryFolder second;
    io::SnapshotStore a(first / "store", job);
    io::SnapshotStore b(second / "store", job);
    a.write_geometry(0, some_numbers(4, 3), signature);
    b.write_geometry(0, some_numbers(4, 3), signature);
    CHECK(io::read_text((first / "store") / "geometry_0000.h5") ==
          io::read_text((second / "store") / "geometry_0000.h5"));
}

TEST_CASE("snapshot store: that of another job and damaged files are refused", "[io]") {
    const io::TemporaryFolder folder;
    // A plan of which nothing was made is replaced.
    static_cast<void>(io::SnapshotStore(folder / "store", "{\"model\": \"z\"}\n"));
    io::SnapshotStore store(folder / "store", job);
    store.write_geometry(0, some_numbers(4, 3), signature);
    CHECK_THROWS_WITH(io::SnapshotStore(folder / "store", "{\"model\": \"b\", \"points\": 3}\n"),
                      Contains("of another job: 'model' differs"));
    const auto file = (folder / "store") / "geometry_0000.h5";
    std::string bytes = io::read_text(file);
    bytes[bytes.size() / 2] ^= 1;
    io::write_text(file, bytes);
    CHECK_THROWS_WITH(static_cast<void>(store.geometry(0, signature)),
                      Contains("the file was cut or changed"));
    CHECK_THROWS_AS(static_cast<void>(store.geometry(1, signature)), FileError);
}

TEST_CASE("snapshot store: parts made apart are merged", "[io]") {
    const io::TemporaryFolder first;
    const io::TemporaryFolder second;
    io::SnapshotStore a(first / "store", job);
    io::SnapshotStore b(second / "store", job);
    a.write_geometry(0, some_numbers(4, 3), signature);
    a.write_geometry_failure(1, "no memory");
    b.write_geometry(0, some_numbers(4, 3), signature);
    b.write_geometry(1, some_numbers(5, 3), signature);
    b.write_geometry_failure(0, "no memory");
    CHECK(a.merge(b) == 1);
    CHECK(a.geometry(1, signature) == some_numbers(5, 3));
    CHECK_FALSE(a.geometry_failure(1));
    CHECK_FALSE(a.geometry_failure(0));
    const io::TemporaryFolder third;
    const io::SnapshotStore c(third / "store", "{\"model\": \"c\"}\n");
    CHECK_THROWS_WITH(a.merge(c), Contains("another job"));
}

TEST_CASE("snapshot store: the reference keeps its signature", "[io]") {
    const io::TemporaryFolder folder;
    io::SnapshotStore store(folder / "store", job);
    CHECK_FALSE(store.reference());
    const auto part = std::get<iga::MultiPatch<3>>(meshing::make_part("plate_with_hole_3d"));
    store.write_reference(part);
    const auto found = store.reference();
    REQUIRE(found);
    CHECK(iga::signature(*found) == iga::signature(part));
    CHECK(found->patches[0].control_points() == part.patches[0].control_points());
}

TEST_CASE("snapshot store: added points are kept to the last bit", "[io]") {
    const io::TemporaryFolder folder;
    io::SnapshotStore store(folder / "store", job);
    CHECK(store.added_points(2).rows() == 0);
    const MatrixX points = some_numbers(3, 2);
    store.write_added_points(points);
    CHECK(store.added_points(2) == points);
    CHECK_THROWS_WITH(store.added_points(3), Contains("row 0 does not hold 3 numbers"));
    const auto file = folder / "store/added_points.json";
    io::write_text(file, io::read_text(file).substr(0, 20));
    CHECK_THROWS_WITH(store.added_points(2), Contains("is no list of points, or was cut"));
}
