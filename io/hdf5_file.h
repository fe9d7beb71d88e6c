#pragma once

// What the readers and writers of HDF5 in io/ share; no other file includes this one.
#include <hdf5.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "iga/core/error.h"
#include "iga/core/types.h"

namespace couture::io {

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

/// @throws FileError  "file: what" unless `holds`
void expect(bool holds, const std::string& file, std::string_view what);

/// A new file in memory, and its bytes when all else of it is closed.
[[nodiscard]] Handle make_image();
[[nodiscard]] std::string image_of(hid_t store);
/// Opens such bytes, which must stay, to be read.
[[nodiscard]] Handle open_image(const std::string& file, std::string& content);

/// The bytes with a block of 512 before them: the text "Couture <kind> <version>", their number
/// and their 64-bit FNV-1a hash. HDF5's readers skip it.
[[nodiscard]] std::string pack_hdf5(const std::string& kind, int version,
                                    const std::string& content);
/// The bytes behind the block. @throws FileError  unless kind, version, number and hash fit
[[nodiscard]] std::string_view unpack_hdf5(const std::string& file, std::string_view bytes,
                                           const std::string& kind, int version);

void write_ints(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                const std::vector<int>& values);
/// @param values  last dimension fastest
void write_doubles(hid_t group, const std::string& name, const std::vector<hsize_t>& shape,
                   const double* values);
/// rows x columns.
void write_matrix(hid_t group, const std::string& name, const MatrixX& matrix);
/// A data set of bytes, of any length.
void write_bytes(hid_t group, const std::string& name, std::string_view bytes);
void write_attribute(hid_t object, const std::string& name, const std::vector<int>& values);
void write_attribute(hid_t object, const std::string& name, const std::string& text);
[[nodiscard]] Handle make_group(hid_t parent, const std::string& name);

/// One open file with its name for messages. Everything throws FileError for what is missing or of
/// another shape.
struct Source {
    std::string file;
    std::size_t n_bytes;

    [[nodiscard]] Handle group(hid_t parent, const std::string& name) const;
    [[nodiscard]] Handle data(hid_t parent, const std::string& name) const;
    /// Shape of a data set of `rank` dimensions, all of whose numbers are in the file.
    [[nodiscard]] std::vector<hsize_t> shape(hid_t data, int rank, const std::string& name) const;
    [[nodiscard]] std::vector<double> doubles(hid_t parent, const std::string& name, int rank,
                                              std::vector<hsize_t>& found_shape) const;
    /// What `write_matrix` wrote.
    [[nodiscard]] MatrixX matrix(hid_t parent, const std::string& name) const;
    /// What `write_bytes` wrote.
    [[nodiscard]] std::string bytes(hid_t parent, const std::string& name) const;
    /// Whole numbers of a data set with `width` columns.
    [[nodiscard]] std::vector<int> rows(hid_t set, const std::string& name,
                                        std::size_t width) const;
    [[nodiscard]] Handle attribute(hid_t object, const std::string& name) const;
    [[nodiscard]] std::vector<int> ints(hid_t object, const std::string& name,
                                        std::size_t size) const;
    [[nodiscard]] std::string text(hid_t object, const std::string& name) const;
};

}  // namespace couture::io
