#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "drivers/commands/commands.h"
#include "drivers/job_geometry.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/spline/refine.h"
#include "io/surface_file.h"

namespace couture::drivers {

namespace {

io::AnyMultiPatch read_any(const std::filesystem::path& path) {
    if (path.extension() == ".toml") {
        return load_geometry(io::read_deck(path));
    }
    io::SplineFile file = io::read_splines(path);
    for (const std::string& note : file.notes) {
        log::info(fmt::format("{}: {}", path.filename().string(), note));
    }
    return std::move(file.multipatch);
}

int convert_surface(const SurfaceInputOptions& from, const std::filesystem::path& to,
                    const CommonOptions& common) {
    if (!io::is_surface_file(to)) {
        throw InputError(
            "convert: {} is a surface of triangles; it can be written as .stl, .obj, .off, .ply or "
            ".vtp, not as {}: splines have to be fitted to it, which meshing does",
            from.surface, to.string());
    }
    const io::DescribedSurface surface = load_surface("convert", from);
    for (const std::string& line : io::describe_changes(surface)) {
        log::info(fmt::format("{}: {}", from.surface, line));
    }
    std::vector<std::string> warnings;
    for (const std::string& line : meshing::summarize(surface.check, 1)) {
        if (!line.starts_with("  ")) {
            warnings.push_back(
                fmt::format("{}: {}", from.surface, line.substr(0, line.size() - 1)));
        }
    }
    const std::string provenance =
        fmt::format("couture {} convert {}", COUTURE_VERSION, from.surface);
    for (const std::string& warning : io::write_surface(to, surface.soup, provenance)) {
        warnings.push_back(warning);
    }
    for (const std::string& warning : warnings) log::warn(warning);
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "done"},
                                               {"points", surface.soup.points.size()},
                                               {"triangles", surface.soup.triangles.size()},
                                               {"warnings", warnings},
                                               {"files", {to.string()}}};
        fmt::print("{}\n",
                   object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else if (!common.quiet) {
        fmt::print("wrote {} ({} points, {} triangles)\n", to.string(), surface.soup.points.size(),
                   surface.soup.triangles.size());
    }
    return ExitCode::done;
}

// As many as a file is written with.
constexpr double most_elements = 2e6;

// Splits every element of every patch into `n_parts` in each direction; maps are unchanged, and
// patches that conform still do.
template <int d>
void split_elements(iga::MultiPatch<d>& multipatch, int n_parts) {
    double n_elements = 0.0;
    for (const iga::Patch<d>& patch : multipatch.patches) {
        double n_of_patch = 1.0;
        for (const iga::KnotVector& knots : patch.space().knots) {
            n_of_patch *= static_cast<double>(n_parts) * knots.n_elements();
        }
        n_elements += n_of_patch;
    }
    if (n_elements > most_elements) {
        throw InputError(
            "convert: {:.0f} elements would be written, at most {:.0f} are; refine less often",
            n_elements, most_elements);
    }
    for (iga::Patch<d>& patch : multipatch.patches) {
        iga::TensorSpace<d> space = patch.space();
        for (iga::KnotVector& knots : space.knots) {
            knots = iga::refine(knots, knots.degree(), n_parts * knots.n_elements()).knots;
        }
        patch = iga::refine_to<d>(patch, space);
    }
}

}  // namespace

int run_convert(const SurfaceInputOptions& from, const std::filesystem::path& to, int n_halvings,
                const CommonOptions& common) {
    require_file_or_part("convert", from.surface);
    std::error_code none;
    if (std::filesystem::equivalent(from.surface, to, none)) {
        throw InputError("convert: {} would replace its own input; give another name", to.string());
    }
    if (is_surface_input(from.surface)) {
        if (n_halvings > 0) {
            throw InputError(
                "convert: {} is a surface of triangles, --refine is for splines; triangles of a "
                "part have --edge-length",
                from.surface);
        }
        return convert_surface(from, to, common);
    }
    if (io::is_surface_file(to)) {
        throw InputError(
            "convert: {} is a spline file or deck, {} a surface of triangles; splines can be "
            "written as .xml, .mesh, .txt, .inp or .h5",
            from.surface, to.string());
    }
    io::AnyMultiPatch multipatch = read_any(from.surface);
    if (n_halvings > 0) {
        std::visit([&](auto& patches) { split_elements(patches, 1 << n_halvings); }, multipatch);
    }
    io::write_splines(to, multipatch);
    const int n_patches =
        std::visit([](const auto& patches) { return patches.n_patches(); }, multipatch);
    if (common.json) {
        const nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                               {"status", "done"},
                                               {"patches", n_patches},
                                               {"files", {to.string()}}};
        fmt::print("{}\n", object.dump(2));
    } else if (!common.quiet) {
        fmt::print("wrote {} ({} patches)\n", to.string(), n_patches);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
