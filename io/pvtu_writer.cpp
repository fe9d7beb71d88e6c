#include "io/pvtu_writer.h"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>

#include "io/atomic_file.h"

namespace couture::io {

namespace {

void add_array(pugi::xml_node parent, const char* type, const std::string& name,
               Eigen::Index n_components, const std::vector<std::string>& components = {}) {
    pugi::xml_node array = parent.append_child("PDataArray");
    array.append_attribute("type") = type;
    array.append_attribute("Name") = name.c_str();
    array.append_attribute("NumberOfComponents") = static_cast<int>(n_components);
    for (std::size_t i = 0; i < components.size(); ++i) {
        array.append_attribute(fmt::format("ComponentName{}", i).c_str()) = components[i].c_str();
    }
}

}  // namespace

void write_pvtu(const std::filesystem::path& path, std::span<const std::string> pieces,
                std::span<const PointArray> points, const VtuOptions& options) {
    pugi::xml_document document;
    pugi::xml_node file = document.append_child("VTKFile");
    file.append_attribute("type") = "PUnstructuredGrid";
    file.append_attribute("version") = "1.0";
    file.append_attribute("byte_order") = "LittleEndian";
    file.append_attribute("header_type") = "UInt64";
    pugi::xml_node grid = file.append_child("PUnstructuredGrid");
    grid.append_attribute("GhostLevel") = 0;

    pugi::xml_node point_data = grid.append_child("PPointData");
    for (const PointArray& array : points) {
        const Eigen::Index n = array.coefficients.cols();
        add_array(point_data, "Float64", array.name, n == 2 ? 3 : n, array.components);
    }
    pugi::xml_node cell_data = grid.append_child("PCellData");
    add_array(cell_data, "Int32", vtu_patch_array, 1);
    if (!options.linear) {
        if (options.always_weights) {
            point_data.append_attribute("RationalWeights") = vtu_weights_array;
            add_array(point_data, "Float64", vtu_weights_array, 1);
        }
        cell_data.append_attribute("HigherOrderDegrees") = vtu_degrees_array;
        add_array(cell_data, "Float64", vtu_degrees_array, 3);
    }
    add_array(grid.append_child("PPoints"), "Float64", "Points", 3);
    for (const std::string& piece : pieces) {
        grid.append_child("Piece").append_attribute("Source") = piece.c_str();
    }
    std::ostringstream text;
    document.save(text, "  ");
    write_text(path, text.str());
}

}  // namespace couture::io
