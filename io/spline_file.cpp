#include "io/spline_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/topology/interface_match.h"
#include "io/atomic_file.h"
#include "io/geopdes_text.h"
#include "io/gismo_xml.h"
#include "io/hdf5_store.h"
#include "io/mfem_mesh.h"
#include "io/raw_splines.h"
#include "io/yeti_files.h"

namespace couture::io {

namespace {

enum class Format { gismo, mfem, geopdes, yeti, hdf5 };

constexpr const char* known_formats =
    "G+Smo XML (.xml), MFEM NURBS mesh (.mesh), GeoPDEs text (.txt), yeti (.inp with .NB), Couture "
    "HDF5 (.h5)";

std::string name_of(Format format) {
    switch (format) {
        case Format::gismo:
            return "G+Smo XML";
        case Format::mfem:
            return "MFEM NURBS mesh";
        case Format::geopdes:
            return "GeoPDEs text";
        case Format::yeti:
            return "yeti inp/NB";
        case Format::hdf5:
            return "Couture HDF5";
    }
    return "";
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// From the extension, for writing and where the content says nothing.
Format format_of_extension(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".xml") {
        return Format::gismo;
    }
    if (extension == ".mesh") {
        return Format::mfem;
    }
    if (extension == ".txt") {
        return Format::geopdes;
    }
    if (extension == ".inp") {
        return Format::yeti;
    }
    if (extension == ".h5") {
        return Format::hdf5;
    }
    throw FileError(
        "{}: unknown extension '{}'; expected one of {}; of surfaces .stl, .obj, .off, .ply, .vtp",
        path.string(), extension, known_formats);
}

/// From the first bytes, else from the extension.
Format format_of(const std::filesystem::path& path, std::string_view text) {
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos) {
        throw FileError("{}: the file is empty; expected one of {}", path.string(), known_formats);
    }
    const std::string_view content = text.substr(start);
    if (content.starts_with("<") || content.starts_with("\xEF\xBB\xBF<")) {
        return Format::gismo;
    }
    if (content.starts_with("MFEM")) {
        return Format::mfem;
    }
    if (content.starts_with("# nurbs")) {
        return Format::geopdes;
    }
    if (content.starts_with("Couture splines")) {
        return Format::hdf5;
    }
    if (content.starts_with("MeshVersionFormatted")) {
        throw FileError(
            "{}: a Medit mesh of triangles, tetrahedra or hexahedra; expected splines: {}",
            path.string(), known_formats);
    }
    return format_of_extension(path);
}

/// The other file of a yeti model.
std::filesystem::path nb_path(std::filesystem::path path) { return path.replace_extension(".NB"); }

/// Pairs of patches that meet, sorted.
template <int d>
std::vector<std::pair<int, int>> patch_pairs(const std::vector<iga::Interface<d>>& interfaces) {
    std::vector<std::pair<int, int>> result;
    for (const iga::Interface<d>& interface : interfaces) {
        result.emplace_back(std::minmax(interface.first_patch, interface.second_patch));
    }
    std::sort(result.begin(), result.end());
    return result;
}

/// Makes the listed interfaces conform. Old files of shells in space number the sides of another
/// parametrization: where the listed pairs of patches are those that touch, the sides are found.
template <int d>
void conform(iga::MultiPatch<d>& multipatch, std::vector<std::string>& notes) {
    try {
        iga::make_conforming(multipatch);
    } catch (const TopologyError& error) {
        iga::MultiPatch<d> found = multipatch;
        found.interfaces.clear();
        if (multipatch.dimension() == d) {
            throw;
        }
        static_cast<void>(iga::find_interfaces(found));
        if (patch_pairs(found.interfaces) != patch_pairs(multipatch.interfaces)) {
            throw;
        }
        multipatch = std::move(found);
        notes.push_back(fmt::format(
            "sides of the listed interfaces were replaced by those that touch: {}", error.what()));
    }
}

/// Checks the interfaces of the file or finds those it does not list.
template <int d>
void complete(const std::string& file, iga::MultiPatch<d>& multipatch, bool lists_interfaces,
              std::vector<std::string>& notes) {
    std::vector<iga::TensorSpace<d>> before;
    for (const iga::Patch<d>& patch : multipatch.patches) {
        before.push_back(patch.space());
    }
    try {
        if (lists_interfaces) {
            conform(multipatch, notes);
        } else {
            const std::vector<std::string> warnings = iga::find_interfaces(multipatch);
            notes.push_back(fmt::format("the file lists no interfaces; {} found",
                                        multipatch.interfaces.size()));
            notes.insert(notes.end(), warnings.begin(), warnings.end());
        }
        iga::check(multipatch);
    } catch (const Error& error) {
        throw FileError("{}: {}", file, error.what());
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i] != multipatch.patches[i].space()) {
            notes.push_back(fmt::format(
                "patch {} was refined from {} to {} control points to conform to its neighbours", i,
                fmt::join(before[i].sizes(), " x "),
                fmt::join(multipatch.patches[i].space().sizes(), " x ")));
        }
    }
}

/// The splines as the file says them.
std::pair<RawSplines, Format> read_raw(const std::filesystem::path& path) {
    const std::string text = read_text(path);
    const std::string file = path.string();
    const Format format = format_of(path, text);
    RawSplines raw;
    switch (format) {
        case Format::gismo:
            raw = read_gismo_xml(file, text);
            break;
        case Format::mfem:
            raw = read_mfem_mesh(file, text);
            break;
        case Format::geopdes:
            raw = read_geopdes_text(file, text);
            break;
        case Format::yeti:
            raw = read_yeti(file, text, nb_path(path).string(), read_text(nb_path(path)));
            break;
        case Format::hdf5:
            raw = read_hdf5(file, text);
            break;
    }
    return {std::move(raw), format};
}

}  // namespace

SplineFile read_splines(const std::filesystem::path& path) {
    auto [raw, format] = read_raw(path);
    const std::string file = path.string();
    std::visit(
        [&](auto& multipatch) { complete(file, multipatch, raw.lists_interfaces, raw.notes); },
        raw.multipatch);
    return {std::move(raw.multipatch), name_of(format), std::move(raw.notes)};
}

std::optional<std::vector<iga::Surface>> read_spline_surfaces(const std::filesystem::path& path) {
    RawSplines raw = read_raw(path).first;
    const auto* surfaces = std::get_if<iga::MultiPatch<2>>(&raw.multipatch);
    if (surfaces == nullptr) return std::nullopt;
    if (surfaces->dimension() != 3) {
        throw FileError("{}: holds surfaces in the plane; expected surfaces in space",
                        path.string());
    }
    return surfaces->patches;
}

bool is_spline_file(const std::filesystem::path& path) {
    constexpr std::array<const char*, 5> extensions{".xml", ".mesh", ".txt", ".inp", ".h5"};
    return std::ranges::find(extensions, lower_extension(path)) != extensions.end();
}

void write_splines(const std::filesystem::path& path, const AnyMultiPatch& multipatch) {
    const Format format = format_of_extension(path);
    std::vector<std::string> notes;
    std::visit(
        [&](const auto& splines) {
            if (splines.n_patches() == 0) {
                throw InputError("write_splines: {}: no patches; expected at least one",
                                 path.string());
            }
            switch (format) {
                case Format::gismo:
                    write_text(path, to_gismo_xml(splines));
                    break;
                case Format::mfem:
                    write_text(path, to_mfem_mesh(splines, notes));
                    break;
                case Format::geopdes:
                    write_text(path, to_geopdes_text(splines));
                    break;
                case Format::yeti: {
                    const YetiTexts texts = to_yeti(splines);
                    write_text(nb_path(path), texts.nb);
                    write_text(path, texts.inp);
                    break;
                }
                case Format::hdf5:
                    write_text(path, to_hdf5(splines));
                    break;
            }
        },
        multipatch);
    for (const std::string& note : notes) {
        log::warn(fmt::format("{}: {}", path.string(), note));
    }
}

}  // namespace couture::io
