#include "io/surface_file.h"

#include "iga/core/error.h"
#include "io/obj_surface.h"
#include "io/off_surface.h"
#include "io/ply_surface.h"
#include "io/stl_surface.h"
#include "io/surface_writer.h"

namespace couture::io {

std::vector<std::string> write_surface(const std::filesystem::path& path,
                                       const meshing::TriangleSoup& soup,
                                       const std::string& provenance) {
    const std::string ending = lower_case(path.extension().string());
    if (ending == ".stl") return write_stl(path, soup, provenance);
    if (ending == ".obj") {
        write_obj(path, soup, provenance);
    } else if (ending == ".off") {
        write_off(path, soup, provenance);
    } else if (ending == ".ply") {
        write_ply(path, soup, provenance);
    } else if (ending == ".vtp") {
        write_vtp(path, soup, {}, {}, {}, provenance);
    } else {
        throw FileError(
            "{}: the ending '{}' is not that of a surface; expected '.stl', '.obj', '.off', '.ply' "
            "or '.vtp'",
            path.string(), path.extension().string());
    }
    return {};
}

}  // namespace couture::io
