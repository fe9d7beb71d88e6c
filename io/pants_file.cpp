#include "io/pants_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "iga/core/error.h"
#include "io/atomic_file.h"

namespace couture::io {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using namespace meshing;

constexpr const char* format_name = "couture pants 2";
constexpr const char* layout_format_name = "couture layout 3";
constexpr const char* way_out =
    "take the NAME_pants.json or NAME_layout.json that 'couture mesh' wrote, or write it again by "
    "meshing that member";
constexpr int largest_number = 1'000'000;

ordered_json to_json(const Vector3& x) { return {x.x(), x.y(), x.z()}; }

ordered_json to_json(const std::vector<Vector3>& points) {
    auto list = ordered_json::array();
    for (const Vector3& x : points) list.push_back(to_json(x));
    return list;
}

// A value of the file with the keys that lead to it, for messages.
class Node {
  public:
    Node(const json& value, std::string path) : value_(value), path_(std::move(path)) {}

    [[nodiscard]] Node operator[](const char* key) const {
        require(value_.is_object(), "an object");
        const auto entry = value_.find(key);
        if (entry == value_.end()) throw InputError("{} is missing", within(key));
        return {*entry, within(key)};
    }
    [[nodiscard]] std::vector<Node> items() const {
        require(value_.is_array(), "a list");
        std::vector<Node> nodes;
        for (std::size_t i = 0; i < value_.size(); ++i) {
            nodes.emplace_back(value_[i], fmt::format("{}[{}]", path_, i));
        }
        return nodes;
    }
    [[nodiscard]] std::vector<std::pair<std::string, Node>> entries() const {
        require(value_.is_object(), "an object");
        std::vector<std::pair<std::string, Node>> nodes;
        for (const auto& [name, value] : value_.items()) {
            nodes.emplace_back(name, Node(value, within(name)));
        }
        return nodes;
    }
    [[nodiscard]] std::string text() const {
        require(value_.is_string(), "a text");
        return value_.get<std::string>();
    }
    [[nodiscard]] bool flag() const {
        require(value_.is_boolean(), "true or false");
        return value_.get<bool>();
    }
    // @param n  the number lies below it
    [[nodiscard]] int count_below(int n) const {
        constexpr const char* what = "an integer, 0 or more";
        require(value_.is_number_unsigned(), what);
        const auto number = value_.get<std::uint64_t>();
        if (number >= static_cast<std::uint64_t>(n)) {
            throw InputError("{} = {}; it must be below {}", path_, number, n);
        }
        return static_cast<int>(number);
    }
    // -1, or below n.
    [[nodiscard]] int count_or_none(int n) const {
        const bool is_none = value_.is_number_integer() && value_.get<std::int64_t>() == -1;
        return is_none ? -1 : count_below(n);
    }
    [[nodiscard]] std::vector<int> counts_below(int n) const {
        std::vector<int> numbers;
        for (const Node& item : items()) numbers.push_back(item.count_below(n));
        return numbers;
    }
    [[nodiscard]] double part() const {
        require(value_.is_number(), "a number");
        const auto number = value_.get<double>();
        if (!(number >= 0.0 && number <= 1.0)) {
            throw InputError("{} = {}; it must lie in [0, 1]", path_, number);
        }
        return number;
    }
    [[nodiscard]] Vector3 vector() const {
        const auto numbers = items();
        if (numbers.size() != 3)
            throw InputError("{} has {} numbers, not 3", path_, numbers.size());
        Vector3 x;
        for (int i = 0; i < 3; ++i) {
            numbers[i].require(numbers[i].value_.is_number(), "a number");
            x[i] = numbers[i].value_.get<double>();
        }
        if (!x.allFinite()) throw InputError("{} is not finite", path_);
        return x;
    }
    [[nodiscard]] std::vector<Vector3> vectors() const {
        std::vector<Vector3> points;
        for (const Node& item : items()) points.push_back(item.vector());
        return points;
    }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    [[nodiscard]] std::string within(const std::string& key) const {
        return path_.empty() ? key : path_ + "." + key;
    }
    void require(bool is_right, const char* what) const {
        if (is_right) return;
        throw InputError("{} is {}, expected {}", path_.empty() ? "the file" : path_,
                         value_.type_name(), what);
    }

    const json& value_;
    std::string path_;
};

PantsCurveKind read_kind(const Node& node) {
    for (const auto kind :
         {PantsCurveKind::boundary, PantsCurveKind::handle, PantsCurveKind::cycle}) {
        if (node.text() == to_string(kind)) return kind;
    }
    throw InputError("{}: '{}' is no kind of curve; there are boundary, handle, cycle", node.path(),
                     node.text());
}

void read_box(const Node& node, PantsRecord& record) {
    const auto corners = node.vectors();
    if (corners.size() != 2) throw InputError("box has {} corners, not 2", corners.size());
    record.box_min = corners[0];
    record.box_max = corners[1];
    const Vector3 size = record.box_max - record.box_min;
    if (!(size.minCoeff() >= 0.0) || !(size.maxCoeff() > 0.0)) {
        throw InputError(
            "box has size {:.6g} x {:.6g} x {:.6g}; none may be negative, nor all be 0", size.x(),
            size.y(), size.z());
    }
}

GuideLoop read_shape(const Node& node) {
    GuideLoop shape{node["points"].vectors(), node["normals"].vectors()};
    if (shape.points.size() < 3 || shape.normals.size() != shape.points.size()) {
        throw InputError("{} has {} points and {} normals; it needs 3 points and as many normals",
                         node.path(), shape.points.size(), shape.normals.size());
    }
    return shape;
}

PantsRecord read_pants(const Node& top) {
    PantsRecord record;
    read_box(top["box"], record);
    for (const Node& shell : top["shells"].items()) {
        record.shells.push_back({.genus = shell["genus"].count_below(largest_number),
                                 .center = shell["center"].vector()});
    }
    for (const auto& [name, x] : top["corners"].entries()) {
        record.landmarks.corners[name] = x.vector();
    }
    for (const auto& [name, curve] : top["feature_curves"].entries()) {
        record.landmarks.curves[name] = curve["points"].vectors();
        if (curve["closed"].flag()) record.landmarks.closed_curves.insert(name);
    }
    for (const Node& curve : top["curves"].items()) {
        record.curves.push_back({.kind = read_kind(curve["kind"]),
                                 .name = curve["name"].text(),
                                 .shape = read_shape(curve)});
    }
    const int n_curves = static_cast<int>(record.curves.size());
    for (const Node& patch : top["patches"].items()) {
        record.shell_of_patch.push_back(
            patch["shell"].count_below(static_cast<int>(record.shells.size())));
        auto& sides = record.patches.emplace_back();
        for (const Node& side : patch["boundary"].items()) {
            sides.push_back({side["curve"].count_below(n_curves), side["left"].flag()});
        }
    }
    return record;
}

const char* kind_name(ArcKind kind) {
    switch (kind) {
        case ArcKind::convex:
            return "convex";
        case ArcKind::flat:
            return "flat";
        default:
            return "reflex";
    }
}

ArcKind read_arc_kind(const Node& node) {
    for (const auto kind : {ArcKind::convex, ArcKind::flat, ArcKind::reflex}) {
        if (node.text() == kind_name(kind)) return kind;
    }
    throw InputError("{}: '{}' is no kind of sharp edge; there are convex, flat, reflex",
                     node.path(), node.text());
}

// The nodes of the template are checked against it when the record is repeated.
PatchSketch read_sketch(const Node& node) {
    PatchSketch sketch;
    const auto nodes = node["nodes"].items();
    const auto curves = node["curves"].items();
    const auto loops = node["loops"].items();
    const auto n_nodes = static_cast<int>(nodes.size());
    for (const Node& loop : loops) sketch.loops.push_back(loop.counts_below(n_nodes));
    for (const Node& entry : nodes) {
        sketch.nodes.push_back(
            {.name = entry["name"].text(),
             .loop = entry["loop"].count_or_none(static_cast<int>(loops.size())),
             .curve_ends = entry["ends"].counts_below(2 * static_cast<int>(curves.size())),
             .place = entry["place"].vector()});
    }
    for (const Node& entry : curves) {
        sketch.curves.push_back({.name = entry["name"].text(),
                                 .from = entry["from"].count_below(n_nodes),
                                 .to = entry["to"].count_below(n_nodes),
                                 .kind = read_arc_kind(entry["kind"]),
                                 .middle = entry["middle"].vector()});
    }
    return sketch;
}

TemplateMatch read_match(const Node& node, const PatchSketch& features) {
    TemplateMatch match;
    match.caps = node["caps"].counts_below(largest_number);
    for (const Node& loop : node["loop_nodes"].items()) {
        match.loop_nodes.push_back(loop.counts_below(largest_number));
    }
    match.nodes = node["node_of_node"].counts_below(largest_number);
    for (const Node& curve : node["nodes_of_curve"].items()) {
        match.curves.push_back(curve.counts_below(largest_number));
    }
    if (match.caps.size() != features.loops.size() ||
        match.loop_nodes.size() != features.loops.size() ||
        match.nodes.size() != features.nodes.size() ||
        match.curves.size() != features.curves.size()) {
        throw InputError(
            "{}: nodes of {} loops, {} corners and {} curves, but features has {}, {} and {}",
            node.path(), match.loop_nodes.size(), match.nodes.size(), match.curves.size(),
            features.loops.size(), features.nodes.size(), features.curves.size());
    }
    return match;
}

LayoutRecord read_layout(const Node& node) {
    LayoutRecord record;
    for (const Node& patch : node["patches"].items()) {
        PatchSketch features = read_sketch(patch["features"]);
        TemplateMatch match = read_match(patch, features);
        record.patches.push_back({patch["template"].text(), std::move(match), std::move(features)});
    }
    for (const Node& cut : node["rotations"].items()) {
        record.rotations[cut["cut"].count_below(largest_number)] =
            cut["rotation"].count_below(largest_number);
    }
    for (const Node& start : node["starts"].items()) {
        record.starts[start["curve"].count_below(largest_number)] = start["place"].vector();
    }
    record.elements = node["elements"].counts_below(largest_number);
    record.base_elements = node["base_elements"].counts_below(largest_number);
    record.area_part = node["area_part"].part();
    for (const auto& [name, sides] : node["sets"].entries()) {
        auto& set = record.sets[name];
        for (const Node& side : sides.items()) {
            set.push_back(
                {side["cuboid"].count_below(largest_number), side["side"].count_below(6)});
        }
    }
    return record;
}

MemberRecord from_json(const json& object) {
    const Node top(object, "");
    const std::string format = top["format"].text();
    if (format != format_name && format != layout_format_name) {
        throw InputError("format is '{}', expected '{}' or '{}'", format, format_name,
                         layout_format_name);
    }
    MemberRecord record{read_pants(top), {}};
    if (format == layout_format_name) record.layout = read_layout(top["layout"]);
    return record;
}

ordered_json to_json(const PatchSketch& sketch) {
    auto nodes = ordered_json::array();
    for (const auto& node : sketch.nodes) {
        nodes.push_back({{"name", node.name},
                         {"loop", node.loop},
                         {"ends", node.curve_ends},
                         {"place", to_json(node.place)}});
    }
    auto curves = ordered_json::array();
    for (const auto& curve : sketch.curves) {
        curves.push_back({{"name", curve.name},
                          {"from", curve.from},
                          {"to", curve.to},
                          {"kind", kind_name(curve.kind)},
                          {"middle", to_json(curve.middle)}});
    }
    return {{"nodes", std::move(nodes)}, {"curves", std::move(curves)}, {"loops", sketch.loops}};
}

ordered_json to_json(const LayoutRecord& record) {
    auto patches = ordered_json::array();
    for (const auto& patch : record.patches) {
        patches.push_back({{"template", patch.shape},
                           {"caps", patch.match.caps},
                           {"loop_nodes", patch.match.loop_nodes},
                           {"node_of_node", patch.match.nodes},
                           {"nodes_of_curve", patch.match.curves},
                           {"features", to_json(patch.features)}});
    }
    auto rotations = ordered_json::array();
    for (const auto& [cut, rotation] : record.rotations) {
        rotations.push_back({{"cut", cut}, {"rotation", rotation}});
    }
    auto starts = ordered_json::array();
    for (const auto& [curve, place] : record.starts) {
        starts.push_back({{"curve", curve}, {"place", to_json(place)}});
    }
    auto sets = ordered_json::object();
    for (const auto& [name, sides] : record.sets) {
        auto& set = sets[name] = ordered_json::array();
        for (const CuboidSide& side : sides) {
            set.push_back({{"cuboid", side.cuboid}, {"side", side.side}});
        }
    }
    return {{"patches", std::move(patches)},
            {"rotations", std::move(rotations)},
            {"starts", std::move(starts)},
            {"elements", record.elements},
            {"base_elements", record.base_elements},
            {"area_part", record.area_part},
            {"sets", std::move(sets)}};
}

ordered_json to_json(const PantsRecord& record, const char* format, const std::string& provenance) {
    ordered_json object = {{"format", format},
                           {"provenance", provenance},
                           {"box", {to_json(record.box_min), to_json(record.box_max)}}};
    auto& shells = object["shells"] = ordered_json::array();
    for (const auto& shell : record.shells) {
        shells.push_back({{"genus", shell.genus}, {"center", to_json(shell.center)}});
    }
    auto& corners = object["corners"] = ordered_json::object();
    for (const auto& [name, x] : record.landmarks.corners) corners[name] = to_json(x);
    auto& features = object["feature_curves"] = ordered_json::object();
    for (const auto& [name, points] : record.landmarks.curves) {
        const bool is_closed = record.landmarks.closed_curves.contains(name);
        features[name] = {{"closed", is_closed}, {"points", to_json(points)}};
    }
    auto& curves = object["curves"] = ordered_json::array();
    for (const auto& curve : record.curves) {
        curves.push_back({{"kind", std::string(to_string(curve.kind))},
                          {"name", curve.name},
                          {"points", to_json(curve.shape.points)},
                          {"normals", to_json(curve.shape.normals)}});
    }
    auto& patches = object["patches"] = ordered_json::array();
    for (std::size_t p = 0; p < record.patches.size(); ++p) {
        auto sides = ordered_json::array();
        for (const CurveSide& side : record.patches[p]) {
            sides.push_back({{"curve", side.curve}, {"left", side.is_left}});
        }
        patches.push_back({{"shell", record.shell_of_patch[p]}, {"boundary", std::move(sides)}});
    }
    return object;
}

}  // namespace

void write_pants_record(const std::filesystem::path& path, const PantsRecord& record,
                        const std::string& provenance) {
    write_text(path, to_json(record, format_name, provenance).dump(1) + "\n");
}

void write_layout_record(const std::filesystem::path& path, const PantsRecord& pants,
                         const LayoutRecord& layout, const std::string& provenance) {
    ordered_json object = to_json(pants, layout_format_name, provenance);
    object["layout"] = to_json(layout);
    write_text(path, object.dump(1) + "\n");
}

MemberRecord read_member_record(const std::filesystem::path& path) {
    try {
        return from_json(json::parse(read_text(path)));
    } catch (const json::parse_error& error) {
        throw FileError("{}: no JSON from byte {} on; {}", path.string(), error.byte, way_out);
    } catch (const InputError& error) {
        throw FileError("{}: {}; {}", path.string(), error.what(), way_out);
    }
}

}  // namespace couture::io
