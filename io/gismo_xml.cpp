#include "io/gismo_xml.h"

#include <algorithm>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "io/text_cursor.h"

namespace couture::io {

namespace {

using pugi::xml_node;

/// The parsed document and where its nodes are in the text.
class Document {
  public:
    Document(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {
        const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
        if (!result) {
            throw FileError("{}:{}: {}; expected well-formed XML", file_,
                            line_of(static_cast<std::size_t>(result.offset)), result.description());
        }
        root_ = document_.child("xml");
        if (!root_) {
            throw FileError("{}: no <xml> element; expected a G+Smo file", file_);
        }
    }

    [[nodiscard]] xml_node root() const { return root_; }
    [[nodiscard]] int line_of(std::size_t offset) const {
        const std::size_t end = std::min(offset, text_.size());
        return 1 + static_cast<int>(std::count(
                       text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    }
    [[nodiscard]] std::string where(const xml_node& node) const {
        return fmt::format("{}:{}", file_, line_of(static_cast<std::size_t>(node.offset_debug())));
    }
    /// The numbers inside an element.
    [[nodiscard]] TextCursor cursor(const xml_node& node) const {
        const xml_node content = node.first_child();
        const std::size_t offset =
            static_cast<std::size_t>(content ? content.offset_debug() : node.offset_debug());
        return {file_, node.text().get(), 0, {}, line_of(offset)};
    }
    [[nodiscard]] xml_node child(const xml_node& node, const char* name) const {
        const xml_node result = node.child(name);
        if (!result) {
            throw FileError("{}: <{}> has no <{}>; expected one", where(node), node.name(), name);
        }
        return result;
    }
    [[nodiscard]] int attribute(const xml_node& node, const char* name, int low, int high) const {
        const std::string_view value = node.attribute(name).value();
        TextCursor words(where(node), value, 0);
        if (value.empty()) {
            throw FileError("{}: <{}> has no {}; expected a number from {} to {}", where(node),
                            node.name(), name, low, high);
        }
        return words.integer(name, low, high);
    }

  private:
    std::string file_;
    std::string_view text_;
    pugi::xml_document document_;
    xml_node root_;
};

/// Number of parameters of a geometry that can be read.
std::optional<int> parameters_of(const xml_node& geometry) {
    const std::string_view type = geometry.attribute("type").value();
    if (type == "TensorBSpline2" || type == "TensorNurbs2") {
        return 2;
    }
    if (type == "TensorBSpline3" || type == "TensorNurbs3") {
        return 3;
    }
    return std::nullopt;
}

template <int d>
iga::TensorSpace<d> read_space(const Document& document, const xml_node& basis) {
    std::vector<std::optional<iga::KnotVector>> knots(d);
    int i_child = 0;
    for (const xml_node& child : basis.children("Basis")) {
        const int direction =
            child.attribute("index") ? document.attribute(child, "index", 0, d - 1) : i_child;
        if (direction >= d || knots[direction]) {
            throw FileError("{}: direction {} is given twice or too many; expected {} directions",
                            document.where(child), direction, d);
        }
        const xml_node node = document.child(child, "KnotVector");
        const int degree = document.attribute(node, "degree", 1, iga::max_degree);
        knots[direction] =
            make_knots(document.where(node), degree, document.cursor(node).all_numbers("knots"));
        ++i_child;
    }
    if (i_child != d) {
        throw FileError("{}: {} knot vectors; expected {}", document.where(basis), i_child, d);
    }
    if constexpr (d == 2) {
        return {{*knots[0], *knots[1]}};
    } else {
        return {{*knots[0], *knots[1], *knots[2]}};
    }
}

template <int d>
iga::Patch<d> read_patch(const Document& document, const xml_node& geometry) {
    const bool is_rational =
        std::string_view(geometry.attribute("type").value()).find("Nurbs") != std::string::npos;
    const xml_node outer = document.child(geometry, "Basis");
    const xml_node basis = is_rational ? document.child(outer, "Basis") : outer;
    iga::TensorSpace<d> space = read_space<d>(document, basis);
    const long count = count_control_points<d>(document.where(geometry), space.sizes());

    const xml_node coefficients = document.child(geometry, "coefs");
    const int dimension = document.attribute(coefficients, "geoDim", d, 3);
    TextCursor words = document.cursor(coefficients);
    const std::vector<double> numbers = words.numbers(count * dimension, "control points");
    words.expect_end("control points");
    MatrixX control_points(count, dimension);
    for (long i = 0; i < count; ++i) {
        for (int k = 0; k < dimension; ++k) {
            control_points(i, k) = numbers[static_cast<std::size_t>(i * dimension + k)];
        }
    }
    VectorX weights;
    if (is_rational) {
        TextCursor weight_words = document.cursor(document.child(outer, "weights"));
        const std::vector<double> values = weight_words.numbers(count, "weights");
        weight_words.expect_end("weights");
        weights = Eigen::Map<const VectorX>(values.data(), count);
    }
    return make_patch<d>(document.where(geometry), std::move(space), std::move(control_points),
                         std::move(weights));
}

/// Geometries of a multipatch and the patch of each of their ids.
struct Patches {
    std::vector<xml_node> geometries;
    std::map<int, int> patch_of_id;
};

Patches list_patches(const Document& document, const xml_node& multipatch,
                     const std::vector<xml_node>& all) {
    const xml_node node = document.child(multipatch, "patches");
    const std::string_view type = node.attribute("type").value();
    TextCursor words = document.cursor(node);
    std::vector<int> ids;
    if (type == "id_range") {
        const int first = words.integer("first id", 0, max_count);
        const int last = words.integer("last id", first, max_count);
        if (last - first >= static_cast<int>(all.size())) {
            words.fail("patches {} to {}; the file holds only {} geometries", first, last,
                       all.size());
        }
        for (int id = first; id <= last; ++id) {
            ids.push_back(id);
        }
        words.expect_end("ids");
    } else if (type == "id_index") {
        while (!words.at_end()) {
            ids.push_back(words.integer("id", 0, max_count));
        }
    } else {
        throw FileError("{}: patches of type {}; expected 'id_range' or 'id_index'",
                        document.where(node), in_quotes(type));
    }
    std::map<int, xml_node> geometry_of_id;
    for (const xml_node& geometry : all) {
        if (geometry.attribute("id")) {
            const int id = document.attribute(geometry, "id", 0, max_count);
            if (!geometry_of_id.emplace(id, geometry).second) {
                throw FileError("{}: geometry id {} occurs twice; expected it once",
                                document.where(geometry), id);
            }
        }
    }
    Patches result;
    for (const int id : ids) {
        const auto found = geometry_of_id.find(id);
        if (found == geometry_of_id.end()) {
            throw FileError("{}: there is no <Geometry> with id {}; expected one",
                            document.where(node), id);
        }
        if (!result.patch_of_id.emplace(id, static_cast<int>(result.geometries.size())).second) {
            throw FileError("{}: patch id {} occurs twice; expected it once", document.where(node),
                            id);
        }
        result.geometries.push_back(found->second);
    }
    return result;
}

template <int d>
iga::PatchEntity<d> read_side(TextCursor& words, const std::map<int, int>& patch_of_id) {
    const int id = words.integer("a patch", 0, max_count);
    const auto patch = patch_of_id.find(id);
    if (patch == patch_of_id.end()) {
        words.fail("patch {} is not one of the multipatch; expected one of its {} ids", id,
                   patch_of_id.size());
    }
    return iga::make_side<d>(patch->second, words.integer("a side", 1, iga::n_sides<d>) - 1);
}

template <int d>
void read_interfaces(const Document& document, const xml_node& multipatch,
                     const std::map<int, int>& patch_of_id, iga::MultiPatch<d>& result) {
    for (const xml_node& node : multipatch.children("interfaces")) {
        TextCursor words = document.cursor(node);
        while (!words.at_end()) {
            const iga::PatchEntity<d> first = read_side<d>(words, patch_of_id);
            const iga::PatchEntity<d> second = read_side<d>(words, patch_of_id);
            std::array<int, d> direction_map{};
            std::array<bool, d> keeps_sense{};
            for (int k = 0; k < d; ++k) {
                direction_map[k] = words.integer("a direction", 0, d - 1);
            }
            for (int k = 0; k < d; ++k) {
                keeps_sense[k] = words.integer("an orientation", 0, 1) == 1;
            }
            result.interfaces.push_back(
                make_interface<d>(words.where(), first, second, direction_map, keeps_sense));
        }
    }
}

template <int d>
void read_sides_into(const Document& document, const xml_node& node,
                     const std::map<int, int>& patch_of_id, iga::BoundarySet<d>& set) {
    TextCursor words = document.cursor(node);
    while (!words.at_end()) {
        const iga::PatchEntity<d> side = read_side<d>(words, patch_of_id);
        if (std::find(set.begin(), set.end(), side) == set.end()) {
            set.push_back(side);
        }
    }
}

std::string name_of(const xml_node& node) {
    const std::string name = node.attribute("name").value();
    return name.empty() ? node.attribute("label").value() : name;
}

template <int d>
void read_boundary_sets(const Document& document, const xml_node& multipatch,
                        const std::map<int, int>& patch_of_id, iga::MultiPatch<d>& result) {
    for (const xml_node& node : multipatch.children("boundary")) {
        iga::BoundarySet<d> unnamed;
        const std::string name = name_of(node);
        read_sides_into<d>(document, node, patch_of_id,
                           name.empty() ? unnamed : result.boundary_sets[name]);
    }
    for (const xml_node& conditions : document.root().children("boundaryConditions")) {
        for (const xml_node& node : conditions.children("bc")) {
            std::string name = name_of(node);
            if (name.empty()) {
                name = fmt::format("{}_{}", node.attribute("type").as_string("bc"),
                                   node.attribute("function").as_string("0"));
                std::transform(name.begin(), name.end(), name.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
            }
            read_sides_into<d>(document, node, patch_of_id, result.boundary_sets[name]);
        }
    }
}

template <int d>
RawSplines read_multipatch(const Document& document, const xml_node& node, const Patches& patches) {
    RawSplines result;
    iga::MultiPatch<d> multipatch;
    for (const xml_node& geometry : patches.geometries) {
        if (parameters_of(geometry) != d) {
            throw FileError(
                "{}: geometry of type {}; expected 'TensorBSpline{}' or 'TensorNurbs{}'",
                document.where(geometry), in_quotes(geometry.attribute("type").value()), d, d);
        }
        multipatch.patches.push_back(read_patch<d>(document, geometry));
        if (multipatch.patches.back().dimension() != multipatch.dimension()) {
            throw FileError("{}: control points have {} coordinates, those of the first patch {}",
                            document.where(geometry), multipatch.patches.back().dimension(),
                            multipatch.dimension());
        }
    }
    read_interfaces<d>(document, node, patches.patch_of_id, multipatch);
    read_boundary_sets<d>(document, node, patches.patch_of_id, multipatch);
    result.lists_interfaces = !multipatch.interfaces.empty();
    result.multipatch = std::move(multipatch);
    return result;
}

/// All geometries of the larger number of parameters, for files without a <MultiPatch>.
Patches take_all(const std::vector<xml_node>& all, std::vector<std::string>& notes) {
    const bool has_volumes = std::any_of(all.begin(), all.end(), [](const xml_node& geometry) {
        return parameters_of(geometry) == 3;
    });
    Patches result;
    for (const xml_node& geometry : all) {
        if (parameters_of(geometry) == (has_volumes ? 3 : 2)) {
            result.patch_of_id.emplace(
                geometry.attribute("id").as_int(static_cast<int>(result.geometries.size())),
                static_cast<int>(result.geometries.size()));
            result.geometries.push_back(geometry);
        } else {
            notes.push_back(fmt::format("a geometry of type {} was left out",
                                        in_quotes(geometry.attribute("type").value())));
        }
    }
    return result;
}

}  // namespace

RawSplines read_gismo_xml(const std::string& file, std::string_view text) {
    const Document document(file, text);
    std::vector<xml_node> all;
    for (const xml_node& geometry : document.root().children("Geometry")) {
        all.push_back(geometry);
    }
    std::vector<std::string> notes;
    const xml_node multipatch = document.root().child("MultiPatch");
    const Patches patches =
        multipatch ? list_patches(document, multipatch, all) : take_all(all, notes);
    if (patches.geometries.empty()) {
        throw FileError(
            "{}: no spline geometry; expected <Geometry> of type TensorBSpline2, TensorBSpline3, "
            "TensorNurbs2 or TensorNurbs3",
            file);
    }
    if (multipatch.next_sibling("MultiPatch")) {
        notes.emplace_back("only the first of several <MultiPatch> was read");
    }
    RawSplines result = parameters_of(patches.geometries[0]) == 2
                            ? read_multipatch<2>(document, multipatch, patches)
                            : read_multipatch<3>(document, multipatch, patches);
    result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
    return result;
}

namespace {

template <int d>
void append_geometry(xml_node& root, const iga::Patch<d>& patch, int id) {
    const std::string kind = patch.is_rational() ? "TensorNurbs" : "TensorBSpline";
    xml_node geometry = root.append_child("Geometry");
    geometry.append_attribute("type") = fmt::format("{}{}", kind, d).c_str();
    geometry.append_attribute("id") = id;
    xml_node basis = geometry.append_child("Basis");
    basis.append_attribute("type") = fmt::format("{}Basis{}", kind, d).c_str();
    xml_node tensor = basis;
    if (patch.is_rational()) {
        std::string weights;
        for (Eigen::Index i = 0; i < patch.weights().size(); ++i) {
            weights += exact(patch.weights()[i]) + "\n";
        }
        tensor = basis.append_child("Basis");
        tensor.append_attribute("type") = fmt::format("TensorBSplineBasis{}", d).c_str();
        basis.append_child("weights").text() = weights.c_str();
    }
    for (int k = 0; k < d; ++k) {
        std::string knots;
        for (const double knot : patch.knots(k).knots()) {
            knots += exact(knot) + " ";
        }
        xml_node direction = tensor.append_child("Basis");
        direction.append_attribute("type") = "BSplineBasis";
        direction.append_attribute("index") = k;
        xml_node vector = direction.append_child("KnotVector");
        vector.append_attribute("degree") = patch.knots(k).degree();
        vector.text() = knots.c_str();
    }
    std::string points = "\n";
    for (Eigen::Index i = 0; i < patch.control_points().rows(); ++i) {
        for (int k = 0; k < patch.dimension(); ++k) {
            points += exact(patch.control_points()(i, k)) + " ";
        }
        points += "\n";
    }
    xml_node coefficients = geometry.append_child("coefs");
    coefficients.append_attribute("geoDim") = patch.dimension();
    coefficients.text() = points.c_str();
}

template <int d>
std::string interface_line(const iga::Interface<d>& interface) {
    const int first_normal = iga::side_direction(interface.first_side);
    const int second_normal = iga::side_direction(interface.second_side);
    std::string directions;
    std::string orientations;
    for (int k = 0, i = 0; k < d; ++k) {
        if (k == first_normal) {
            directions += fmt::format(" {}", second_normal);
            orientations +=
                iga::side_is_high(interface.first_side) != iga::side_is_high(interface.second_side)
                    ? " 1"
                    : " 0";
            continue;
        }
        const int axis = interface.map.axis[i];
        directions += fmt::format(" {}", axis + (axis >= second_normal ? 1 : 0));
        orientations += interface.map.reversed[i] ? " 0" : " 1";
        ++i;
    }
    return fmt::format("{} {} {} {}{}{}\n", interface.first_patch, interface.first_side + 1,
                       interface.second_patch, interface.second_side + 1, directions, orientations);
}

template <int d>
void append_boundary(xml_node& node, const iga::MultiPatch<d>& multipatch) {
    std::set<iga::PatchEntity<d>> rest;
    for (const iga::PatchEntity<d>& side : multipatch.outer_sides()) {
        rest.insert(side);
    }
    const auto append = [&](const auto& sides) {
        std::string lines;
        for (const iga::PatchEntity<d>& side : sides) {
            lines += fmt::format("{} {}\n", side.patch, side.side() + 1);
        }
        xml_node boundary = node.append_child("boundary");
        boundary.text() = lines.c_str();
        return boundary;
    };
    for (const auto& [name, sides] : multipatch.boundary_sets) {
        append(sides).append_attribute("name") = name.c_str();
        for (const iga::PatchEntity<d>& side : sides) {
            rest.erase(side);
        }
    }
    if (!rest.empty()) {
        append(rest);
    }
}

}  // namespace

template <int d>
std::string to_gismo_xml(const iga::MultiPatch<d>& multipatch) {
    expect_sides_only(multipatch, "G+Smo XML");
    pugi::xml_document document;
    xml_node root = document.append_child("xml");
    for (int i = 0; i < multipatch.n_patches(); ++i) {
        append_geometry(root, multipatch.patches[i], i);
    }
    xml_node node = root.append_child("MultiPatch");
    node.append_attribute("parDim") = d;
    node.append_attribute("id") = multipatch.n_patches();
    xml_node patches = node.append_child("patches");
    patches.append_attribute("type") = "id_range";
    patches.text() = fmt::format("0 {}", multipatch.n_patches() - 1).c_str();
    if (!multipatch.interfaces.empty()) {
        std::string lines;
        for (const iga::Interface<d>& interface : multipatch.interfaces) {
            lines += interface_line(interface);
        }
        node.append_child("interfaces").text() = lines.c_str();
    }
    append_boundary(node, multipatch);
    std::ostringstream text;
    document.save(text, " ");
    return text.str();
}

template std::string to_gismo_xml(const iga::MultiPatch<2>&);
template std::string to_gismo_xml(const iga::MultiPatch<3>&);

}  // namespace couture::io
