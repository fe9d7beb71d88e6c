#include <fmt/core.h>

#include "drivers/commands/commands.h"
#include "iga/core/error.h"
#include "io/hex_mesh_info.h"
#include "io/spline_info.h"
#include "io/surface_info.h"
#include "io/volumetric_layout_file.h"

namespace couture::drivers {

int run_info(const SurfaceInputOptions& options, const CommonOptions& common) {
    if (is_surface_input(options.surface)) {
        const io::DescribedSurface surface = load_surface("info", options);
        fmt::print("{}\n",
                   common.json ? io::surface_info_json(surface) : io::surface_info_text(surface));
        return ExitCode::done;
    }
    require_file_or_part("info", options.surface);
    if (io::is_hex_mesh_file(options.surface)) {
        const meshing::PlacedLayout mesh = io::read_volumetric_layout(options.surface);
        fmt::print("{}\n", common.json ? io::hex_mesh_info_json(mesh)
                                       : io::hex_mesh_info_text(options.surface, mesh));
        return ExitCode::done;
    }
    if (!io::is_spline_file(options.surface)) {
        throw InputError(
            "info: '{}' is no surface (.stl, .obj, .off, .ply, .vtp), no mesh of hexahedra (.vtk, "
            "Medit's .mesh), no spline file (.xml, .mesh, .txt, .inp, .h5) and no part; ParaView "
            "shows what .vtu files hold",
            options.surface);
    }
    const io::SplineFile file = io::read_splines(options.surface);
    fmt::print("{}\n", common.json ? io::spline_info_json(file) : io::spline_info_text(file));
    return ExitCode::done;
}

}  // namespace couture::drivers
