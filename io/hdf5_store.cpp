#include "io/hdf5_store.h"

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "io/text_cursor.h"

namespace couture::io {

namespace {

constexpr int store_version = 1;
constexpr std::size_t block_size = 512;
/// Memory of an HDF5 file in the making grows by this.
constexpr std::size_t increment = 1 << 16;

/// Closes what it holds.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
        if (id_ < 0) {
            throw FileError("{}: HDF5 can't open or make it", what);
        }
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle() {
        if (id_ >= 0) {
            close_(id_);
        }
    }
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

void expect(bool holds, const std::string& file, std::string_view what) {
    if (!holds) {
        throw FileError("{}: {}", file, what);
    }
}

std::uint64_t hash(std::string_view bytes) {
    std::uint64_t value = 0xcbf29ce484222325U;
    for (const char c : bytes) {
        value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    }
    return value;
}

Handle in_memory_access() {
    Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access");
    H5Pset_fapl_core(access, increment, 0);
    return access;
}

// ---- writing

void write_ints(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                const std::vector<int>& values) {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose, name);
    const Handle data(H5Dcreate2(group, name.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT),
                      H5Dclose, name);
    H5Dwrite(data, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void write_doubles(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                   const double* values) {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose, name);
    const Handle data(H5Dcreate2(group, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT),
                      H5Dclose, name);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

void write_attribute(hid_t object, const std::string& name, const std::vector<int>& values) {
    const hsize_t size = values.size();
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, name);
    const Handle attribute(
        H5Acreate2(object, name.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
        name);
    H5Awrite(attribute, H5T_NATIVE_INT, values.data());
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, name);
    H5Tset_size(type, text.size() + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
    const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, name);
    H5Awrite(attribute, type, text.c_str());
}

Handle make_group(hid_t parent, const std::string& name) {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
            name};
}

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

/// One open file with its name for messages.
struct Source {
    std::string file;
    std::size_t n_bytes;

    [[nodiscard]] Handle group(hid_t parent, const std::string& name) const {
        expect(H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0, file,
               fmt::format("there is no group '{}'; expected one", name));
        return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, file + ": " + name};
    }
    [[nodiscard]] Handle data(hid_t parent, const std::string& name) const {
        expect(H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0, file,
               fmt::format("there is no data set '{}'; expected one", name));
        return {H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, file + ": " + name};
    }
    /// Shape of a data set of `rank` dimensions, all of whose numbers are in the file.
    [[nodiscard]] std::vector<hsize_t> shape(hid_t data, int rank, const std::string& name) const {
        const Handle space(H5Dget_space(data), H5Sclose, file + ": " + name);
        const int found = H5Sget_simple_extent_ndims(space);
        expect(found == rank, file,
               fmt::format("'{}' has {} dimensions; expected {}", name, found, rank));
        std::vector<hsize_t> result(rank);
        H5Sget_simple_extent_dims(space, result.data(), nullptr);
        hsize_t n = 1;
        for (const hsize_t size : result) {
            expect(size <= n_bytes && n <= n_bytes, file,
                   fmt::format("'{}' has {} numbers; the file has only {} bytes", name, size,
                               n_bytes));
            n *= size;
        }
        expect(n <= n_bytes, file,
               fmt::format("'{}' has {} numbers; the file has only {} bytes", name, n, n_bytes));
        return result;
    }
    [[nodiscard]] std::vector<double> doubles(hid_t parent, const std::string& name, int rank,
                                              std::vector<hsize_t>& found_shape) const {
        const Handle set = data(parent, name);
        found_shape = shape(set, rank, name);
        std::size_t n = 1;
        for (const hsize_t size : found_shape) {
            n *= size;
        }
        std::vector<double> values(n);
        expect(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
               file, fmt::format("'{}' can't be read as numbers", name));
        return values;
    }
    [[nodiscard]] std::vector<int> rows(hid_t set, const std::string& name,
                                        std::size_t width) const {
        const std::vector<hsize_t> found = shape(set, 2, name);
        expect(found[1] == width, file,
               fmt::format("'{}' has {} columns; expected {}", name, found[1], width));
        std::vector<int> values(found[0] * found[1]);
        expect(H5Dread(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
               file, fmt::format("'{}' can't be read as whole numbers", name));
        return values;
    }
    [[nodiscard]] Handle attribute(hid_t object, const std::string& name) const {
        expect(H5Aexists(object, name.c_str()) > 0, file,
               fmt::format("there is no attribute '{}'; expected one", name));
        return {H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, file + ": " + name};
    }
    [[nodiscard]] std::vector<int> ints(hid_t object, const std::string& name,
                                        std::size_t size) const {
        const Handle found = attribute(object, name);
        const Handle space(H5Aget_space(found), H5Sclose, file + ": " + name);
        expect(H5Sget_simple_extent_npoints(space) == static_cast<hssize_t>(size), file,
               fmt::format("attribute '{}' does not have {} numbers", name, size));
        std::vector<int> values(size);
        expect(H5Aread(found, H5T_NATIVE_INT, values.data()) >= 0, file,
               fmt::format("attribute '{}' can't be read as whole numbers", name));
        return values;
    }
    [[nodiscard]] std::string text(hid_t object, const std::string& name) const {
        const Handle found = attribute(object, name);
        const Handle type(H5Aget_type(found), H5Tclose, file + ": " + name);
        expect(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                   H5Tget_size(type) <= n_bytes,
               file, fmt::format("attribute '{}' is not a text of fixed length", name));
        std::string value(H5Tget_size(type), '\0');
        expect(H5Aread(found, type, value.data()) >= 0, file,
               fmt::format("attribute '{}' can't be read", name));
        value.resize(std::strlen(value.c_str()));
        return value;
    }
};

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

/// The HDF5 part, if the block before it tells its size and hash.
std::string_view checked_content(const std::string& file, std::string_view bytes) {
    expect(bytes.size() > block_size && bytes.starts_with("Couture splines "), file,
           "the first 512 bytes are not those of a Couture HDF5 file; expected 'Couture splines'");
    TextCursor words(file, bytes.substr(0, block_size), '\0', std::string_view("\0", 1));
    words.expect("Couture");
    words.expect("splines");
    words.integer("the version", store_version, store_version);
    const std::string_view content = bytes.substr(block_size);
    const std::string expected = fmt::format("{} {:016x}", content.size(), hash(content));
    const std::string size(words.word("the size"));
    const std::string found = fmt::format("{} {}", size, words.word("the hash"));
    expect(found == expected, file,
           fmt::format("size and hash are {}, its first bytes say {}; the file was cut or changed",
                       expected, in_quotes(found)));
    return content;
}

}  // namespace

RawSplines read_hdf5(const std::string& file, std::string_view bytes) {
    std::string content(checked_content(file, bytes));
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle access = in_memory_access();
    H5Pset_file_image(access, content.data(), content.size());
    const Handle store(H5Fopen("splines", H5F_ACC_RDONLY, access), H5Fclose, file);
    const Source source{file, bytes.size()};
    const Handle root(H5Gopen2(store, "/", H5P_DEFAULT), H5Gclose, file);
    const int n_parameters = source.ints(root, "n_parameters", 1)[0];
    expect(n_parameters == 2 || n_parameters == 3, file,
           fmt::format("n_parameters = {}; expected 2 or 3", n_parameters));
    return n_parameters == 2 ? read_root<2>(source, root) : read_root<3>(source, root);
}

template <int d>
std::string to_hdf5(const iga::MultiPatch<d>& multipatch) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    std::string content;
    {
        const Handle access = in_memory_access();
        const Handle store(H5Fcreate("splines", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
                           "HDF5 in memory");
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
        H5Fflush(store, H5F_SCOPE_LOCAL);
        content.resize(
            static_cast<std::size_t>(std::max<ssize_t>(H5Fget_file_image(store, nullptr, 0), 0)));
        expect(H5Fget_file_image(store, content.data(), content.size()) > 0, "HDF5 in memory",
               "can't be copied");
    }
    std::string block = fmt::format("Couture splines {}\n{} {:016x}\n", store_version,
                                    content.size(), hash(content));
    block.resize(block_size, '\0');
    return block + content;
}

template std::string to_hdf5(const iga::MultiPatch<2>&);
template std::string to_hdf5(const iga::MultiPatch<3>&);

}  // namespace couture::io
