#include "verification/calculix_tools.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "iga/core/error.h"
#include "iga/post/stress.h"
#include "iga/spline/gauss.h"
#include "io/atomic_file.h"

namespace couture::verification {

using namespace iga;
namespace fs = std::filesystem;

namespace {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "couture-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw FileError("{}: no temporary folder can be made", name);
        }
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

}  // namespace

io::CalculixResult run_calculix(const io::CalculixModel& model) {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "job.inp", io::to_calculix(model, "couture verify"));
    return io::run_calculix(folder.path(), "job");
}

BrickStresses brick_stresses(const io::HexMesh& mesh, const Field<3>& u,
                             const Hyperelastic& material) {
    const std::vector<double>& gauss = gauss_rule(2).points;
    BrickStresses result{MatrixX(8 * mesh.elements.rows(), 3),
                         MatrixX(8 * mesh.elements.rows(), 6)};
    long row = 0;
    for (const io::HexMesh::Place& place : mesh.places) {
        const TensorSpace<3>& space = u.space->tensor(place.patch);
        for (int i = 0; i < 8; ++i, ++row) {
            std::array<int, 3> point = {i % 2, i / 2 % 2, i / 4};
            point[0] = place.is_mirrored ? 1 - point[0] : point[0];
            Vector3 xi;
            for (int k = 0; k < 3; ++k) {
                const std::vector<double>& ends = space.knots[k].breakpoints();
                const double low = ends[place.element[k]];
                xi[k] = low + gauss[point[k]] * (ends[place.element[k] + 1] - low);
            }
            result.points.row(row) = u.space->geometry().patches[place.patch].point(xi);
            const Matrix<3> H = u.gradient(place.patch, xi);
            const Matrix<3> s = cauchy_stress(piola_stress(material, H), H);
            result.stresses.row(row) << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1);
        }
    }
    return result;
}

Case calculix_case(const std::string& name, bool is_long, std::function<void(Recorder&)> run) {
    return {
        name, is_long, [run = std::move(run)](Recorder& recorder) {
            if (!io::find_calculix()) {
                recorder.skip("the program ccx is not installed (Debian's package calculix-ccx)");
                return;
            }
            run(recorder);
        }};
}

}  // namespace couture::verification
