#include "io/ply_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "iga/core/error.h"
#include "io/atomic_file.h"

namespace couture::io {

namespace {

enum class Number { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Number type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

Number read_type(TextCursor& cursor) {
    const std::string_view name = cursor.word("a type");
    constexpr std::array<std::pair<std::string_view, Number>, 16> names{{
        {"char", Number::int8},
        {"int8", Number::int8},
        {"uchar", Number::uint8},
        {"uint8", Number::uint8},
        {"short", Number::int16},
        {"int16", Number::int16},
        {"ushort", Number::uint16},
        {"uint16", Number::uint16},
        {"int", Number::int32},
        {"int32", Number::int32},
        {"uint", Number::uint32},
        {"uint32", Number::uint32},
        {"float", Number::float32},
        {"float32", Number::float32},
        {"double", Number::float64},
        {"float64", Number::float64},
    }};
    for (const auto& [word, type] : names) {
        if (name == word) return type;
    }
    cursor.fail("found {}; expected a type: char, uchar, short, ushort, int, uint, float or double",
                in_quotes(name));
}

struct Property {
    std::string name;
    Number type = Number::float32;
    /// Of a list: the type of its length.
    std::optional<Number> length;
};

struct Element {
    std::string name;
    long count = 0;
    std::vector<Property> properties;

    [[nodiscard]] std::optional<std::size_t> find(std::string_view property, bool is_list) const {
        for (std::size_t i = 0; i < properties.size(); ++i) {
            if (properties[i].name == property && properties[i].length.has_value() == is_list) {
                return i;
            }
        }
        return {};
    }
};

struct Header {
    std::string format;
    std::vector<Element> elements;
    /// First byte and line behind it.
    std::size_t end = 0;
    int line = 1;
};

Header read_header(const std::string& file, std::string_view bytes) {
    Header header;
    int line = 0;
    while (true) {
        const std::size_t length = bytes.substr(header.end).find('\n');
        const std::string_view text = bytes.substr(header.end, length);
        TextCursor cursor(file, text, 0, {}, ++line);
        if (line > 1 && text.empty() && length == std::string_view::npos) {
            cursor.fail("the file ends here; expected 'end_header'");
        }
        header.end += std::min(text.size() + 1, bytes.size() - header.end);
        const std::string_view keyword = line == 1 ? cursor.word("'ply'") : cursor.peek();
        if (line == 1) {
            if (keyword != "ply") cursor.fail("found {}; expected 'ply'", in_quotes(keyword));
            continue;
        }
        if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
        cursor.word("a keyword");
        if (keyword == "end_header") break;
        if (keyword == "format") {
            header.format = cursor.word("a format");
            if (header.format != "ascii" && header.format != "binary_little_endian" &&
                header.format != "binary_big_endian") {
                cursor.fail(
                    "found {}; expected 'ascii', 'binary_little_endian' or "
                    "'binary_big_endian'",
                    in_quotes(header.format));
            }
        } else if (keyword == "element") {
            Element& element = header.elements.emplace_back();
            element.name = cursor.word("the name of an element");
            // Each takes a byte at least.
            element.count = read_count(cursor, "elements '" + element.name + "'", 1, bytes.size());
        } else if (keyword == "property") {
            if (header.elements.empty()) {
                cursor.fail("found a property; expected an element before it");
            }
            Property& property = header.elements.back().properties.emplace_back();
            if (cursor.peek() == "list") {
                cursor.word("'list'");
                property.length = read_type(cursor);
                if (*property.length >= Number::float32) {
                    cursor.fail("the length of a list is a whole number; expected such a type");
                }
            }
            property.type = read_type(cursor);
            property.name = cursor.word("the name of a property");
        } else {
            cursor.fail(
                "found {}; expected 'format', 'comment', 'element', 'property' or "
                "'end_header'",
                in_quotes(keyword));
        }
    }
    header.line = line + 1;
    if (header.format.empty()) {
        throw FileError("{}:{}: the header ends without 'format'; expected it on line 2", file,
                        line);
    }
    return header;
}

/// The numbers of a file in text.
class TextNumbers {
  public:
    TextNumbers(const std::string& file, std::string_view bytes, const Header& header)
        : cursor_(file, bytes.substr(header.end), 0, {}, header.line) {}

    double next(Number /*type*/, std::string_view what) {
        const std::string_view word = cursor_.word(what);
        const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
        double value = 0.0;
        const auto [end, code] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (code != std::errc() || end != digits.data() + digits.size()) {
            fail("found {}; expected a number: {}", in_quotes(word), what);
        }
        return value;
    }
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        cursor_.fail("{}", fmt::format(format, std::forward<Args>(args)...));
    }
    void expect_end() { cursor_.expect_end("the elements"); }

  private:
    TextCursor cursor_;
};

/// The numbers of a binary file.
class BinaryNumbers {
  public:
    BinaryNumbers(const std::string& file, std::string_view bytes, const Header& header)
        : file_(file),
          bytes_(bytes),
          at_(header.end),
          is_big_(header.format == "binary_big_endian") {}

    double next(Number type, std::string_view what) {
        const std::size_t size = size_of(type);
        place_ = at_;
        if (bytes_.size() - at_ < size) fail("the file ends here; expected {}", what);
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t k = is_big_ ? i : size - 1 - i;
            bits = bits << 8U | static_cast<unsigned char>(bytes_[at_ + k]);
        }
        at_ += size;
        switch (type) {
            case Number::int8:
                return static_cast<std::int8_t>(bits);
            case Number::int16:
                return static_cast<std::int16_t>(bits);
            case Number::int32:
                return static_cast<std::int32_t>(bits);
            case Number::float32:
                return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
            case Number::float64:
                return std::bit_cast<double>(bits);
            default:
                return static_cast<double>(bits);
        }
    }
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        throw FileError("{}: byte {}: {}", file_, place_,
                        fmt::format(format, std::forward<Args>(args)...));
    }
    void expect_end() {
        place_ = at_;
        if (at_ != bytes_.size()) {
            fail("{} bytes follow the last of the elements; expected nothing more",
                 bytes_.size() - at_);
        }
    }

  private:
    const std::string& file_;
    std::string_view bytes_;
    std::size_t at_;
    std::size_t place_ = 0;
    bool is_big_;
};

template <typename Numbers>
long read_length(Numbers& numbers, const Property& property, std::size_t file_size) {
    const double length = numbers.next(*property.length, "the length of a list");
    if (!(length >= 0.0 && length <= static_cast<double>(file_size)) ||
        length != std::floor(length)) {
        numbers.fail("found {}; expected the length of the list '{}', at most {} in this file",
                     length, property.name, file_size);
    }
    return static_cast<long>(length);
}

template <typename Numbers>
RawSurface read_elements(const std::string& file, const Header& header, Numbers& numbers,
                         std::size_t file_size) {
    RawSurface surface;
    double n_points = 0.0;
    bool has_points = false;
    bool has_faces = false;
    for (const Element& element : header.elements) {
        if (element.name == "vertex") n_points = static_cast<double>(element.count);
    }
    std::vector<int> corners;
    for (const Element& element : header.elements) {
        const bool is_vertex = element.name == "vertex";
        const std::array<std::optional<std::size_t>, 3> axes{
            element.find("x", false), element.find("y", false), element.find("z", false)};
        auto indices = element.find("vertex_indices", true);
        if (!indices) indices = element.find("vertex_index", true);
        if (is_vertex && !(axes[0] && axes[1] && axes[2])) {
            throw FileError("{}: the header lists no x, y and z of element 'vertex'", file);
        }
        const bool is_face = element.name == "face";
        if (is_face && !indices) {
            throw FileError("{}: the header lists no list 'vertex_indices' of element 'face'",
                            file);
        }
        has_points |= is_vertex;
        has_faces |= is_face;
        for (long i = 0; i < element.count && !element.properties.empty(); ++i) {
            Vector3 point = Vector3::Zero();
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const Property& property = element.properties[k];
                if (!property.length) {
                    const double value = numbers.next(property.type, property.name);
                    for (int axis = 0; is_vertex && axis < 3; ++axis) {
                        if (axes[axis] != k) continue;
                        if (!std::isfinite(value)) {
                            numbers.fail("found '{}' as {} of point {}; expected a finite number",
                                         value, property.name, i);
                        }
                        point[axis] = value;
                    }
                    continue;
                }
                const long length = read_length(numbers, property, file_size);
                corners.clear();
                for (long c = 0; c < length; ++c) {
                    const double value = numbers.next(property.type, property.name);
                    if (!is_face || indices != k) continue;
                    if (!(value >= 0.0 && value < n_points) || value != std::floor(value)) {
                        numbers.fail(
                            "found '{}' in face {}; expected the number of a point, from 0 to {}",
                            value, i, n_points - 1.0);
                    }
                    corners.push_back(static_cast<int>(value));
                }
                if (is_face && indices == k) surface.add_polygon(corners);
            }
            if (is_vertex) surface.points.push_back(point);
        }
    }
    if (!has_points || !has_faces) {
        throw FileError("{}: the header lists no element '{}'; a surface has 'vertex' and 'face'",
                        file, has_points ? "face" : "vertex");
    }
    numbers.expect_end();
    return surface;
}

}  // namespace

RawSurface read_ply(const std::string& file, std::string_view bytes) {
    const Header header = read_header(file, bytes);
    if (header.format == "ascii") {
        TextNumbers numbers(file, bytes, header);
        return read_elements(file, header, numbers, bytes.size());
    }
    BinaryNumbers numbers(file, bytes, header);
    return read_elements(file, header, numbers, bytes.size());
}

void write_ply(const std::filesystem::path& path, const meshing::TriangleSoup& soup,
               const std::string& provenance) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\n";
    if (!provenance.empty()) bytes += "comment " + provenance + "\n";
    bytes += fmt::format(
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        soup.points.size(), soup.triangles.size());
    const auto append = [&](std::uint64_t value, int size) {
        for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
    };
    for (const Vector3& point : soup.points) {
        for (const double x : point) append(std::bit_cast<std::uint64_t>(x), 8);
    }
    for (const auto& triangle : soup.triangles) {
        append(3, 1);
        for (const int v : triangle) append(static_cast<std::uint32_t>(v), 4);
    }
    write_text(path, bytes);
}

}  // namespace couture::io
