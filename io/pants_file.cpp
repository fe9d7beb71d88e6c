#include "io/pants_file.h"

#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "io/atomic_file.h"

namespace couture::io {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using namespace meshing;

constexpr const char* format_name = "couture pants 1";

ordered_json to_json(const Vector3& x) { return {x.x(), x.y(), x.z()}; }

ordered_json to_json(const std::vector<Vector3>& points) {
    auto list = ordered_json::array();
    for (const Vector3& x : points) list.push_back(to_json(x));
    return list;
}

Vector3 read_vector(const json& node) {
    const auto values = node.get<std::vector<double>>();
    if (values.size() != 3) throw InputError("a point has {} numbers, not 3", values.size());
    Vector3 x(values[0], values[1], values[2]);
    if (!x.allFinite()) throw InputError("a point is not finite");
    return x;
}

std::vector<Vector3> read_vectors(const json& node) {
    std::vector<Vector3> points;
    for (const json& item : node) points.push_back(read_vector(item));
    return points;
}

PantsCurveKind read_kind(const std::string& name) {
    for (const auto kind :
         {PantsCurveKind::boundary, PantsCurveKind::handle, PantsCurveKind::cycle}) {
        if (name == to_string(kind)) return kind;
    }
    throw InputError("'{}' is no kind of curve; there are boundary, handle, cycle", name);
}

PantsRecord from_json(const json& object) {
    if (object.value("format", "") != format_name) {
        throw InputError("'format' is '{}', expected '{}'", object.value("format", ""),
                         format_name);
    }
    PantsRecord record;
    record.box_min = read_vector(object.at("box").at(0));
    record.box_max = read_vector(object.at("box").at(1));
    record.genus = object.at("genus").get<int>();
    for (const auto& [name, x] : object.at("corners").items()) {
        record.landmarks.corners[name] = read_vector(x);
    }
    for (const auto& [name, curve] : object.at("feature_curves").items()) {
        record.landmarks.curves[name] = read_vectors(curve.at("points"));
        if (curve.at("closed").get<bool>()) record.landmarks.closed_curves.insert(name);
    }
    for (const json& curve : object.at("curves")) {
        record.curves.push_back(
            {.kind = read_kind(curve.at("kind").get<std::string>()),
             .name = curve.at("name").get<std::string>(),
             .shape = {read_vectors(curve.at("points")), read_vectors(curve.at("normals"))}});
    }
    const int n_curves = static_cast<int>(record.curves.size());
    for (const json& patch : object.at("patches")) {
        auto& sides = record.patches.emplace_back();
        for (const json& side : patch) {
            sides.push_back({side.at("curve").get<int>(), side.at("left").get<bool>()});
            if (sides.back().curve < 0 || sides.back().curve >= n_curves) {
                throw InputError("a patch names curve {}; there are {}", sides.back().curve,
                                 n_curves);
            }
        }
    }
    return record;
}

}  // namespace

void write_pants_record(const std::filesystem::path& path, const PantsRecord& record,
                        const std::string& provenance) {
    ordered_json object = {{"format", format_name},
                           {"provenance", provenance},
                           {"box", {to_json(record.box_min), to_json(record.box_max)}},
                           {"genus", record.genus}};
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
    for (const auto& patch : record.patches) {
        auto sides = ordered_json::array();
        for (const CurveSide& side : patch) {
            sides.push_back({{"curve", side.curve}, {"left", side.is_left}});
        }
        patches.push_back(std::move(sides));
    }
    write_text(path, object.dump(1) + "\n");
}

PantsRecord read_pants_record(const std::filesystem::path& path) {
    try {
        return from_json(json::parse(read_text(path)));
    } catch (const json::exception& error) {
        throw FileError("{}: no record of a decomposition into pants: {}", path.string(),
                        error.what());
    } catch (const InputError& error) {
        throw FileError("{}: {}", path.string(), error.what());
    }
}

}  // namespace couture::io
