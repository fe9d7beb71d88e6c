#include "io/hdf5_file.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>

#include "io/text_cursor.h"

namespace couture::io {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t block_size = 512;
/// Memory of an HDF5 file in the making grows by this.
constexpr std::size_t increment = 1 << 16;

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

/// Several may be open at once, each under a name of its own.
std::string image_name() {
    static std::atomic<int> n_images = 0;
    return fmt::format("image {}", n_images++);
}

/// Without the time of writing: equal contents make equal files.
Handle data_properties() {
    Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties");
    H5Pset_obj_track_times(properties, 0);
    return properties;
}

}  // namespace

void expect(bool holds, const std::string& file, std::string_view what) {
    if (!holds) {
        throw FileError("{}: {}", file, what);
    }
}

Handle make_image() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle access = in_memory_access();
    return {H5Fcreate(image_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
            "HDF5 in memory"};
}

std::string image_of(hid_t store) {
    H5Fflush(store, H5F_SCOPE_LOCAL);
    std::string content(
        static_cast<std::size_t>(std::max<ssize_t>(H5Fget_file_image(store, nullptr, 0), 0)), '\0');
    expect(H5Fget_file_image(store, content.data(), content.size()) > 0, "HDF5 in memory",
           "can't be copied");
    return content;
}

Handle open_image(const std::string& file, std::string& content) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle access = in_memory_access();
    H5Pset_file_image(access, content.data(), content.size());
    return {H5Fopen(image_name().c_str(), H5F_ACC_RDONLY, access), H5Fclose, file};
}

std::string pack_hdf5(const std::string& kind, int version, const std::string& content) {
    std::string block =
        fmt::format("Couture {} {}\n{} {:016x}\n", kind, version, content.size(), hash(content));
    block.resize(block_size, '\0');
    return block + content;
}

std::string_view unpack_hdf5(const std::string& file, std::string_view bytes,
                             const std::string& kind, int version) {
    expect(bytes.size() > block_size && bytes.starts_with(fmt::format("Couture {} ", kind)), file,
           fmt::format(
               "the first 512 bytes are not those of a Couture HDF5 file; expected 'Couture {}'",
               kind));
    TextCursor words(file, bytes.substr(0, block_size), '\0', std::string_view("\0", 1));
    words.expect("Couture");
    words.expect(kind);
    words.integer("the version", version, version);
    const std::string_view content = bytes.substr(block_size);
    const std::string expected = fmt::format("{} {:016x}", content.size(), hash(content));
    const std::string size(words.word("the size"));
    const std::string found = fmt::format("{} {}", size, words.word("the hash"));
    expect(found == expected, file,
           fmt::format("size and hash are {}, its first bytes say {}; the file was cut or changed",
                       expected, in_quotes(found)));
    return content;
}

void write_ints(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                const std::vector<int>& values) {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose, name);
    const Handle properties = data_properties();
    const Handle data(
        H5Dcreate2(group, name.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT, properties, H5P_DEFAULT),
        H5Dclose, name);
    H5Dwrite(data, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void write_doubles(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                   const double* values) {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose, name);
    const Handle properties = data_properties();
    const Handle data(H5Dcreate2(group, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                 properties, H5P_DEFAULT),
                      H5Dclose, name);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

void write_matrix(hid_t group, const std::string& name, const MatrixX& matrix) {
    const RowMajor rows = matrix;
    write_doubles(group, name,
                  {static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())},
                  rows.data());
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

void write_bytes(hid_t group, const std::string& name, std::string_view bytes) {
    const hsize_t size = bytes.size();
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, name);
    const Handle properties = data_properties();
    const Handle data(
        H5Dcreate2(group, name.c_str(), H5T_STD_U8LE, space, H5P_DEFAULT, properties, H5P_DEFAULT),
        H5Dclose, name);
    H5Dwrite(data, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
}

Handle Source::group(hid_t parent, const std::string& name) const {
    expect(H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0, file,
           fmt::format("there is no group '{}'; expected one", name));
    return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, file + ": " + name};
}

Handle Source::data(hid_t parent, const std::string& name) const {
    expect(H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0, file,
           fmt::format("there is no data set '{}'; expected one", name));
    return {H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, file + ": " + name};
}

std::vector<hsize_t> Source::shape(hid_t data, int rank, const std::string& name) const {
    const Handle space(H5Dget_space(data), H5Sclose, file + ": " + name);
    const int found = H5Sget_simple_extent_ndims(space);
    expect(found == rank, file,
           fmt::format("'{}' has {} dimensions; expected {}", name, found, rank));
    std::vector<hsize_t> result(rank);
    H5Sget_simple_extent_dims(space, result.data(), nullptr);
    hsize_t n = 1;
    for (const hsize_t size : result) {
        expect(size <= n_bytes && n <= n_bytes, file,
               fmt::format("'{}' has {} numbers; the file has only {} bytes", name, size, n_bytes));
        n *= size;
    }
    expect(n <= n_bytes, file,
           fmt::format("'{}' has {} numbers; the file has only {} bytes", name, n, n_bytes));
    return result;
}

std::vector<double> Source::doubles(hid_t parent, const std::string& name, int rank,
                                    std::vector<hsize_t>& found_shape) const {
    const Handle set = data(parent, name);
    found_shape = shape(set, rank, name);
    std::size_t n = 1;
    for (const hsize_t size : found_shape) {
        n *= size;
    }
    std::vector<double> values(n);
    expect(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, file,
           fmt::format("'{}' can't be read as numbers", name));
    return values;
}

MatrixX Source::matrix(hid_t parent, const std::string& name) const {
    std::vector<hsize_t> found;
    const std::vector<double> values = doubles(parent, name, 2, found);
    return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(found[0]),
                                      static_cast<Eigen::Index>(found[1]));
}

std::vector<int> Source::rows(hid_t set, const std::string& name, std::size_t width) const {
    const std::vector<hsize_t> found = shape(set, 2, name);
    expect(found[1] == width, file,
           fmt::format("'{}' has {} columns; expected {}", name, found[1], width));
    std::vector<int> values(found[0] * found[1]);
    expect(H5Dread(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, file,
           fmt::format("'{}' can't be read as whole numbers", name));
    return values;
}

Handle Source::attribute(hid_t object, const std::string& name) const {
    expect(H5Aexists(object, name.c_str()) > 0, file,
           fmt::format("there is no attribute '{}'; expected one", name));
    return {H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, file + ": " + name};
}

std::vector<int> Source::ints(hid_t object, const std::string& name, std::size_t size) const {
    const Handle found = attribute(object, name);
    const Handle space(H5Aget_space(found), H5Sclose, file + ": " + name);
    expect(H5Sget_simple_extent_npoints(space) == static_cast<hssize_t>(size), file,
           fmt::format("attribute '{}' does not have {} numbers", name, size));
    std::vector<int> values(size);
    expect(H5Aread(found, H5T_NATIVE_INT, values.data()) >= 0, file,
           fmt::format("attribute '{}' can't be read as whole numbers", name));
    return values;
}

std::string Source::text(hid_t object, const std::string& name) const {
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

std::string Source::bytes(hid_t parent, const std::string& name) const {
    const Handle set = data(parent, name);
    std::string result(shape(set, 1, name)[0], '\0');
    expect(H5Dread(set, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.data()) >= 0, file,
           fmt::format("'{}' can't be read as bytes", name));
    return result;
}

}  // namespace couture::io
