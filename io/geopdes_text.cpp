#include "io/geopdes_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/text_cursor.h"

namespace couture::io {

namespace {

struct Header {
    int dimension = 0;
    int n_patches = 0;
    int n_interfaces = 0;
    int n_subdomains = 0;
};

Header read_header(TextCursor& words, int& n_parameters, std::string_view version) {
    Header header;
    n_parameters = words.integer("the number of parameters", 2, 3);
    header.dimension = version == "v.2.1"
                           ? words.integer("the number of coordinates", n_parameters, 3)
                           : n_parameters;
    header.n_patches = words.integer("the number of patches", 1, max_count);
    header.n_interfaces = words.integer("the number of interfaces", 0, max_count);
    header.n_subdomains = words.integer("the number of subdomains", 0, max_count);
    return header;
}

template <int d>
iga::Patch<d> read_patch(TextCursor& words, int dimension) {
    words.expect("PATCH");
    words.rest_of_line();
    std::array<int, d> degrees{};
    std::array<int, d> sizes{};
    for (int& degree : degrees) {
        degree = words.integer("a degree", 1, iga::max_degree);
    }
    for (int k = 0; k < d; ++k) {
        sizes[k] = words.integer("a number of control points", degrees[k] + 1, max_count);
    }
    const long count = count_control_points<d>(words.where(), sizes);
    std::vector<iga::KnotVector> knots;
    for (int k = 0; k < d; ++k) {
        std::vector<double> values = words.numbers(long{sizes[k]} + degrees[k] + 1, "knots");
        knots.push_back(make_knots(words.where(), degrees[k], std::move(values)));
    }
    const std::vector<double> numbers =
        words.numbers(count * (dimension + 1), "coordinates and weights");
    const Eigen::Map<const MatrixX> rows(numbers.data(), count, dimension + 1);
    VectorX weights = rows.col(dimension);
    for (long i = 0; i < count; ++i) {
        if (!(weights[i] > 0.0)) {
            words.fail("weight {} of the patch = {}; expected a positive number", i, weights[i]);
        }
    }
    MatrixX points = rows.leftCols(dimension).array().colwise() / weights.array();
    if constexpr (d == 2) {
        return make_patch<d>(words.where(), {{knots[0], knots[1]}}, std::move(points),
                             std::move(weights));
    } else {
        return make_patch<d>(words.where(), {{knots[0], knots[1], knots[2]}}, std::move(points),
                             std::move(weights));
    }
}

template <int d>
iga::PatchEntity<d> read_side(TextCursor& words, int n_patches) {
    const int patch = words.integer("a patch", 1, n_patches) - 1;
    return iga::make_side<d>(patch, words.integer("a side", 1, iga::n_sides<d>) - 1);
}

template <int d>
iga::Interface<d> read_interface(TextCursor& words, int n_patches) {
    words.expect("INTERFACE");
    words.rest_of_line();
    const iga::PatchEntity<d> first = read_side<d>(words, n_patches);
    const iga::PatchEntity<d> second = read_side<d>(words, n_patches);
    iga::Interface<d> result{first.patch, first.side(), second.patch, second.side()};
    const auto sign = [&](std::string_view what) {
        const int value = words.integer(what, -1, 1);
        if (value == 0) {
            words.fail("found 0; expected {}: -1 or 1", what);
        }
        return value;
    };
    if (d == 3 && sign("the flag of swapped directions") == -1) {
        std::reverse(result.map.axis.begin(), result.map.axis.end());
    }
    for (int i = 0; i < d - 1; ++i) {
        result.map.reversed[i] = sign("the sense of a direction") == -1;
    }
    return result;
}

template <int d>
void read_boundary(TextCursor& words, iga::MultiPatch<d>& multipatch) {
    words.expect("BOUNDARY");
    const std::string_view line = words.rest_of_line();
    const std::size_t open = line.find('(');
    const std::size_t close = line.rfind(')');
    std::string name;
    if (open != std::string_view::npos && close != std::string_view::npos && close > open) {
        name = to_set_name(line.substr(open + 1, close - open - 1));
    }
    if (name.empty()) {
        TextCursor number(words.where(), line);
        name = fmt::format("boundary_{}", number.at_end() ? "" : number.word("a number"));
        name = to_set_name(name);
    }
    const std::string plain = name;
    for (int i = 2; multipatch.boundary_sets.count(name) > 0; ++i) {
        name = fmt::format("{}_{}", plain, i);
    }
    iga::BoundarySet<d>& set = multipatch.boundary_sets[name];
    const int n_sides = words.integer("the number of sides", 0, max_count);
    for (int i = 0; i < n_sides; ++i) {
        set.push_back(read_side<d>(words, multipatch.n_patches()));
    }
}

template <int d>
RawSplines read_body(TextCursor& words, const Header& header) {
    iga::MultiPatch<d> multipatch;
    for (int i = 0; i < header.n_patches; ++i) {
        multipatch.patches.push_back(read_patch<d>(words, header.dimension));
    }
    for (int i = 0; i < header.n_interfaces; ++i) {
        multipatch.interfaces.push_back(read_interface<d>(words, header.n_patches));
    }
    while (words.peek() == "SUBDOMAIN") {
        words.expect("SUBDOMAIN");
        words.rest_of_line();
        while (!words.at_end() && std::isdigit(static_cast<unsigned char>(words.peek()[0])) != 0) {
            words.integer("a patch", 1, header.n_patches);
        }
    }
    while (!words.at_end()) {
        read_boundary<d>(words, multipatch);
    }
    RawSplines result;
    result.lists_interfaces = header.n_interfaces > 0;
    if (header.n_subdomains > 1) {
        result.notes.push_back(fmt::format("{} subdomains were left out: patches carry no numbers",
                                           header.n_subdomains));
    }
    result.multipatch = std::move(multipatch);
    return result;
}

/// A number that divided by the weight gives the coordinate; where rounding leaves none, the
/// nearest.
double weighted(double coordinate, double weight) {
    const double product = coordinate * weight;
    for (const double candidate :
         {product, std::nextafter(product, HUGE_VAL), std::nextafter(product, -HUGE_VAL)}) {
        if (candidate / weight == coordinate) {
            return candidate;
        }
    }
    return product;
}

template <int d>
std::string patch_lines(const iga::Patch<d>& patch, int number) {
    std::string text =
        fmt::format("PATCH {}\n{}\n{}\n", number, fmt::join(patch.space().degrees(), " "),
                    fmt::join(patch.space().sizes(), " "));
    for (int k = 0; k < d; ++k) {
        text += fmt::format("{}\n", fmt::join(patch.knots(k).knots(), " "));
    }
    const auto n = patch.control_points().rows();
    for (int k = 0; k <= patch.dimension(); ++k) {
        for (Eigen::Index i = 0; i < n; ++i) {
            const double weight = patch.is_rational() ? patch.weights()[i] : 1.0;
            text += exact(k == patch.dimension() ? weight
                                                 : weighted(patch.control_points()(i, k), weight));
            text += i + 1 < n ? " " : "\n";
        }
    }
    return text;
}

template <int d>
std::string interface_lines(const iga::Interface<d>& interface, int number) {
    std::string text = fmt::format("INTERFACE {}\n{} {}\n{} {}\n", number,
                                   interface.first_patch + 1, interface.first_side + 1,
                                   interface.second_patch + 1, interface.second_side + 1);
    if (d == 3) {
        text += interface.map.axis[0] == 0 ? "1 " : "-1 ";
    }
    for (int i = 0; i < d - 1; ++i) {
        text += interface.map.reversed[i] ? "-1" : "1";
        text += i + 1 < d - 1 ? " " : "\n";
    }
    return text;
}

}  // namespace

std::string to_set_name(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool stays = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' ||
                           c == '_' || c == '+' || c == '-';
        if (stays) {
            result += c;
        } else if (!result.empty() && result.back() != '_') {
            result += '_';
        }
    }
    while (!result.empty() && result.back() == '_' && text.back() != '_') {
        result.pop_back();
    }
    return result;
}

RawSplines read_geopdes_text(const std::string& file, std::string_view text) {
    TextCursor title(file, text, 0);
    for (const char* keyword : {"#", "nurbs", "mesh"}) {
        title.expect(keyword);
    }
    const std::string_view version = title.word("v.2.1");
    if (version != "v.2.1" && version != "v.2.0") {
        title.fail("found version {}; expected v.2.1 or v.2.0", in_quotes(version));
    }
    TextCursor words(file, text, '#');
    int n_parameters = 0;
    const Header header = read_header(words, n_parameters, version);
    return n_parameters == 2 ? read_body<2>(words, header) : read_body<3>(words, header);
}

template <int d>
std::string to_geopdes_text(const iga::MultiPatch<d>& multipatch) {
    expect_sides_only(multipatch, "GeoPDEs text");
    std::string text =
        fmt::format("# nurbs mesh v.2.1\n#\n{} {} {} {} 1\n", d, multipatch.dimension(),
                    multipatch.n_patches(), multipatch.interfaces.size());
    for (int i = 0; i < multipatch.n_patches(); ++i) {
        text += patch_lines(multipatch.patches[i], i + 1);
    }
    int number = 0;
    for (const iga::Interface<d>& interface : multipatch.interfaces) {
        text += interface_lines(interface, ++number);
    }
    text += "SUBDOMAIN 1\n";
    for (int i = 0; i < multipatch.n_patches(); ++i) {
        text += fmt::format("{} ", i + 1);
    }
    text += "\n";
    number = 0;
    for (const auto& [name, sides] : multipatch.boundary_sets) {
        if (to_set_name(name) != name || name.empty()) {
            throw InputError(
                "write_splines: boundary set '{}': GeoPDEs text keeps names of letters, digits and "
                "'. _ + -' only; rename it, for instance to '{}', or write .xml or .h5",
                name, to_set_name(name));
        }
        text += fmt::format("BOUNDARY {} ({})\n{}\n", ++number, name, sides.size());
        for (const iga::PatchEntity<d>& side : sides) {
            text += fmt::format("{} {}\n", side.patch + 1, side.side() + 1);
        }
    }
    return text;
}

template std::string to_geopdes_text(const iga::MultiPatch<2>&);
template std::string to_geopdes_text(const iga::MultiPatch<3>&);

}  // namespace couture::io
