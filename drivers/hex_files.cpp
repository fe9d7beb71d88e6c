#include "drivers/hex_files.h"

#include "io/atomic_file.h"
#include "io/calculix.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

HexFiles write_hexahedra(const std::filesystem::path& stem,
                         const meshing::SampledHexahedra& sampled, const std::string& provenance) {
    const io::HexMesh mesh = io::make_hexahedra(iga::Space<3>(sampled.hexahedra));
    HexFiles result{mesh.nodes.rows(), mesh.elements.rows(), {}};
    std::vector<std::vector<int>> cells;
    for (long e = 0; e < mesh.elements.rows(); ++e) {
        auto& cell = cells.emplace_back();
        for (const int node : mesh.elements.row(e)) cell.push_back(node);
    }
    result.files.emplace_back(stem.string() + ".vtu");
    io::write_points_vtu(result.files.back(), mesh.nodes, {}, provenance, cells);
    result.files.emplace_back(stem.string() + ".inp");
    io::write_text(result.files.back(), io::to_calculix(mesh, provenance));
    return result;
}

}  // namespace couture::drivers
