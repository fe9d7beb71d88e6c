#include "io/hdf5_store.h"

#include <algorithm>
#include <cstring>

#include "io/hdf5_file.h"
#include "io/text_cursor.h"

namespace couture::io {

namespace {

constexpr int store_version = 1;
constexpr const char* kind = "splines";
template <int d>
void write_patch(hid_t group, const iga::Patch<d>& patch) {
    const std::array<int, d> degrees = patch.space().degrees();
    write_attribute(group, "degrees", std::vector<int>(degrees.begin(), degrees.end()));
    for (int k = 0; k < d; ++k) {
        const std::vector<double>& knots = patch.knots(k).knots();
        write_doubles(group, fmt::format("knots_{}", k), {knots.size()}, knots.data());
    }
    const auto n = static_cast<hsize_t>(patch.control_points().rows());
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows =
        patch.control_points();
    write_doubles(group, "control_points", {n, static_cast<hsize_t>(patch.dimension())},
                  rows.data());
    if (patch.is_rational()) {
        write_doubles(group, "weights", {n}, patch.weights().data());
    }
}

template <int d>
void write_topology(hid_t file, const iga::MultiPatch<d>& multipatch) {
    std::vector<int> rows;
    for (const iga::Interface<d>& interface : multipatch.interfaces) {
        rows.insert(rows.end(), {interface.first_patch, interface.first_side,
                                 interface.second_patch, interface.second_side});
        rows.insert(rows.end(), interface.map.axis.begin(), interface.map.axis.end());
        rows.insert(rows.end(), interface.map.reversed.begin(), interface.map.reversed.end());
    }
    write_ints(file, "interfaces", {multipatch.interfaces.size(), 4 + 2 * (d - 1)}, rows);
    const Handle sets = make_group(file, "boundary_sets");
    int number = 0;
    for (const auto& [name, entities] : multipatch.boundary_sets) {
        const std::string path = std::to_string(number++);
        rows.clear();
        for (const iga::PatchEntity<d>& entity : entities) {
            rows.push_back(entity.patch);
            for (const iga::End end : entity.position) {
                rows.push_back(static_cast<int>(end));
            }
        }
        write_ints(sets, path, {entities.size(), 1 + d}, rows);
        const Handle data(H5Dopen2(sets, path.c_str(), H5P_DEFAULT), H5Dclose, path);
        write_attribute(data, "name", name);
    }
}

// ---- reading

template <int d>
iga::Patch<d> read_patch(const Source& source, hid_t group, const std::string& name) {
    const std::string where = fmt::format("{}: {}", source.file, name);
    const std::vector<int> degrees = source.ints(group, "degrees", d);
    std::vector<hsize_t> shape;
    std::vector<iga::KnotVector> knots;
    std::array<int, d> sizes{};
    for (int k = 0; k < d; ++k) {
        knots.push_back(make_knots(where, degrees[k],
                                   source.doubles(group, fmt::format("knots_{}", k), 1, shape)));
        sizes[k] = knots.back().n_basis();
    }
    const long count = count_control_points<d>(where, sizes);
    const std::vector<double> points = source.doubles(group, "control_points", 2, shape);
    expect(static_cast<long>(shape[0]) == count && shape[1] >= d && shape[1] <= 3, where,
           fmt::format("control_points is {} x {}; expected {} x {} to 3", shape[0], shape[1],
                       count, d));
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    MatrixX control_points =
        Eigen::Map<const Rows>(points.data(), count, static_cast<Eigen::Index>(shape[1]));
    VectorX weights;
    if (H5Lexists(group, "weights", H5P_DEFAULT) > 0) {
        const std::vector<double> values = source.doubles(group, "weights", 1, shape);
        expect(static_cast<long>(shape[0]) == count, where,
               fmt::format("{} weights; expected {}", shape[0], count));
        weights = Eigen::Map<const VectorX>(values.data(), count);
    }
    if constexpr (d == 2) {
        return make_patch<d>(where, {{knots[0], knots[1]}}, std::move(control_points),
                             std::move(weights));
    } else {
        return make_patch<d>(where, {{knots[0], knots[1], knots[2]}}, std::move(control_points),
                             std::move(weights));
    }
}

template <int d>
std::vector<iga::Interface<d>> read_interfaces(const Source& source, hid_t root, int n_patches) {
    constexpr int width = 4 + 2 * (d - 1);
    const std::vector<int> rows = source.rows(source.data(root, "interfaces"), "interfaces", width);
    std::vector<iga::Interface<d>> result;
    for (std::size_t i = 0; i + width <= rows.size(); i += width) {
        const int* row = &rows[i];
        iga::Interface<d> interface { row[0], row[1], row[2], row[3] };
        int axes = 0;
        bool is_good = true;
        for (int k = 0; k < d - 1; ++k) {
            interface.map.axis[k] = row[4 + k];
            interface.map.reversed[k] = row[4 + d - 1 + k] != 0;
            is_good = is_good && row[4 + k] >= 0 && row[4 + k] < d - 1;
            axes |= is_good ? 1 << row[4 + k] : 0;
        }
        for (const int k : {0, 2}) {
            is_good = is_good && row[k] >= 0 && row[k] < n_patches && row[k + 1] >= 0 &&
                      row[k + 1] < iga::n_sides<d>;
        }
        expect(
            is_good && axes == (1 << (d - 1)) - 1, source.file,
            fmt::format("interface {} names patches, sides or axes that do not exist", i / width));
        result.push_back(interface);
    }
    return result;
}

template <int d>
void read_boundary_sets(const Source& source, hid_t root, iga::MultiPatch<d>& multipatch) {
    const Handle sets = source.group(root, "boundary_sets");
    for (int i = 0; H5Lexists(sets, std::to_string(i).c_str(), H5P_DEFAULT) > 0; ++i) {
        const std::string path = fmt::format("boundary_sets/{}", i);
        const Handle data = source.data(sets, std::to_string(i));
        iga::BoundarySet<d>& set = multipatch.boundary_sets[source.text(data, "name")];
        const std::vector<int> rows = source.rows(data, path, 1 + d);
        for (std::size_t j = 0; j + d < rows.size(); j += 1 + d) {
            iga::PatchEntity<d> entity;
            entity.patch = rows[j];
            bool is_good = entity.patch >= 0 && entity.patch < multipatch.n_patches();
            for (int k = 0; k < d; ++k) {
                const int end = rows[j + 1 + static_cast<std::size_t>(k)];
                is_good = is_good && end >= -1 && end <= 1;
                entity.position[k] = static_cast<iga::End>(is_good ? end : 0);
            }
            expect(is_good && entity.dimension() < d, source.file,
                   fmt::format("{}: row {} is not a side, edge or corner of a patch", path,
                               j / (1 + d)));
            set.push_back(entity);
        }
    }
}

template <int d>
RawSplines read_root(const Source& source, hid_t root) {
    const int n_patches = source.ints(root, "n_patches", 1)[0];
    iga::MultiPatch<d> multipatch;
    const Handle patches = source.group(root, "patches");
    for (int i = 0; i < n_patches; ++i) {
        const Handle group = source.group(patches, std::to_string(i));
        multipatch.patches.push_back(read_patch<d>(source, group, fmt::format("patches/{}", i)));
    }
    multipatch.interfaces = read_interfaces<d>(source, root, n_patches);
    read_boundary_sets(source, root, multipatch);
    const std::string signature = source.text(root, "signature");
    expect(signature == iga::signature(multipatch), source.file,
           fmt::format("signature {} in the file, {} of what was read; expected the same",
                       in_quotes(signature), iga::signature(multipatch)));
    return {std::move(multipatch), true, {}};
}

}  // namespace

RawSplines read_hdf5(const std::string& file, std::string_view bytes) {
    std::string content(unpack_hdf5(file, bytes, kind, store_version));
    const Handle store = open_image(file, content);
    const Source source{file, bytes.size()};
    const Handle root(H5Gopen2(store, "/", H5P_DEFAULT), H5Gclose, file);
    const int n_parameters = source.ints(root, "n_parameters", 1)[0];
    expect(n_parameters == 2 || n_parameters == 3, file,
           fmt::format("n_parameters = {}; expected 2 or 3", n_parameters));
    return n_parameters == 2 ? read_root<2>(source, root) : read_root<3>(source, root);
}

template <int d>
std::string to_hdf5(const iga::MultiPatch<d>& multipatch) {
    std::string content;
    {
        const Handle store = make_image();
        write_attribute(store, "version", std::vector<int>{store_version});
        write_attribute(store, "n_parameters", std::vector<int>{d});
        write_attribute(store, "n_patches", std::vector<int>{multipatch.n_patches()});
        write_attribute(store, "signature", iga::signature(multipatch));
        write_attribute(store, "provenance", std::string("Couture ") + COUTURE_VERSION);
        {
            const Handle patches = make_group(store, "patches");
            for (int i = 0; i < multipatch.n_patches(); ++i) {
                const Handle group = make_group(patches, std::to_string(i));
                write_patch(group, multipatch.patches[i]);
            }
        }
        write_topology(store, multipatch);
        content = image_of(store);
    }
    return pack_hdf5(kind, store_version, content);
}

template std::string to_hdf5(const iga::MultiPatch<2>&);
template std::string to_hdf5(const iga::MultiPatch<3>&);

}  // namespace couture::io
