#include "io/yeti_files.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>

#include "io/text_cursor.h"
#include "io/yeti_sets.h"

namespace couture::io {

namespace {

std::string lower(std::string_view text) {
    std::string result;
    for (const char c : text) {
        result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return result;
}

/// A keyword line, its options (lower-case names), and the lines up to the next one.
struct Block {
    std::string keyword;
    std::map<std::string, std::string> options;
    std::string data;
    int line = 0;
};

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

Block parse_keyword(std::string_view line, int number) {
    Block block;
    block.line = number;
    bool is_first = true;
    while (!line.empty()) {
        const std::size_t comma = std::min(line.find(','), line.size());
        const std::string_view part = trimmed(line.substr(0, comma));
        line.remove_prefix(std::min(comma + 1, line.size()));
        if (is_first) {
            block.keyword = lower(part.substr(1));
            is_first = false;
            continue;
        }
        const std::size_t equals = std::min(part.find('='), part.size());
        block.options[lower(trimmed(part.substr(0, equals)))] =
            trimmed(part.substr(std::min(equals + 1, part.size())));
    }
    return block;
}

/// Comments become empty lines, so that lines keep their numbers.
std::vector<Block> split_blocks(const std::string& file, std::string_view text) {
    std::vector<Block> blocks;
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (line.starts_with("*") && !line.starts_with("**")) {
            blocks.push_back(parse_keyword(line, number));
        } else if (line.empty() || line.starts_with("**")) {
            if (!blocks.empty()) {
                blocks.back().data += "\n";
            }
        } else if (blocks.empty()) {
            throw FileError("{}:{}: found {}; expected a keyword '*...'", file, number,
                            in_quotes(line));
        } else {
            blocks.back().data += line;
            blocks.back().data += "\n";
        }
    }
    return blocks;
}

class Model {
  public:
    Model(std::string file, std::string_view text)
        : file_(std::move(file)), blocks_(split_blocks(file_, text)) {}

    [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
    [[nodiscard]] const Block& block(const std::string& keyword) const {
        for (const Block& candidate : blocks_) {
            if (candidate.keyword == keyword) {
                return candidate;
            }
        }
        throw FileError("{}: there is no '*{}'; expected one", file_, keyword);
    }
    [[nodiscard]] TextCursor cursor(const Block& block) const {
        return {file_, block.data, 0, ",", block.line + 1};
    }

  private:
    std::string file_;
    std::vector<Block> blocks_;
};

/// What the .NB says of one patch.
template <int d>
struct PatchData {
    std::vector<iga::KnotVector> knots;
    int n_elements = 0;
    std::vector<int> nodes;
    std::vector<double> weights;

    [[nodiscard]] iga::TensorSpace<d> space() const {
        if constexpr (d == 2) {
            return {{knots[0], knots[1]}};
        } else {
            return {{knots[0], knots[1], knots[2]}};
        }
    }
};

template <int d>
std::vector<PatchData<d>> read_patches(const Model& nb) {
    TextCursor count = nb.cursor(nb.block("number of patch"));
    const int n_patches = count.integer("the number of patches", 1, max_count);
    TextCursor element_counts = nb.cursor(nb.block("number of element by patch"));
    TextCursor degrees = nb.cursor(nb.block("jpqr"));
    std::vector<PatchData<d>> patches;
    for (int i = 0; i < n_patches; ++i) {
        PatchData<d> patch;
        patch.n_elements = element_counts.integer("the number of elements", 1, max_count);
        TextCursor words = nb.cursor(nb.block(fmt::format("patch({})", i + 1)));
        std::array<int, d> sizes{};
        for (int k = 0; k < d; ++k) {
            const int degree = degrees.integer("a degree", 1, iga::max_degree);
            const int n_knots = words.integer("a number of knots", 2 * (degree + 1), max_count);
            std::vector<double> knots = words.numbers(n_knots, "knots");
            patch.knots.push_back(make_knots(words.where(), degree, std::move(knots)));
            sizes[k] = patch.knots.back().n_basis();
        }
        words.expect_end("the knots");
        const long n_basis = count_control_points<d>(words.where(), sizes);
        // Every function lies in an element, and every element is listed.
        long n_functions = 1;
        for (int k = 0; k < d; ++k) {
            n_functions *= patch.knots[k].degree() + 1;
        }
        if (n_basis > patch.n_elements * n_functions) {
            words.fail("{} control points in {} elements; expected at most {} in each", n_basis,
                       patch.n_elements, n_functions);
        }
        patches.push_back(std::move(patch));
    }
    return patches;
}

std::map<int, std::vector<double>> read_nodes(const Model& inp, int dimension) {
    std::map<int, std::vector<double>> nodes;
    for (const Block& block : inp.blocks()) {
        if (block.keyword != "node") {
            continue;
        }
        TextCursor words = inp.cursor(block);
        while (!words.at_end()) {
            const int node = words.integer("a node", 1, max_count);
            if (!nodes.emplace(node, words.numbers(dimension, "coordinates")).second) {
                words.fail("node {} occurs twice; expected it once", node);
            }
        }
    }
    return nodes;
}

/// Assigns nodes and weights of elements to the functions of the patches. Elements are numbered
/// over all patches, in order.
template <int d>
void read_elements(const Model& inp, const Model& nb, std::vector<PatchData<d>>& patches) {
    // One cursor after the other over all *Element blocks.
    std::vector<TextCursor> element_blocks;
    for (const Block& block : inp.blocks()) {
        if (block.keyword == "element") {
            element_blocks.push_back(inp.cursor(block));
        }
    }
    if (element_blocks.empty()) {
        static_cast<void>(inp.block("element"));
    }
    TextCursor spans = nb.cursor(nb.block("nijk"));
    TextCursor weight_words = nb.cursor(nb.block("weight"));
    std::size_t i_block = 0;
    int element = 0;
    for (PatchData<d>& patch : patches) {
        const iga::TensorSpace<d> space = patch.space();
        patch.nodes.assign(space.n_basis(), 0);
        patch.weights.assign(space.n_basis(), 0.0);
        for (int i = 0; i < patch.n_elements; ++i) {
            ++element;
            while (i_block + 1 < element_blocks.size() && element_blocks[i_block].at_end()) {
                ++i_block;
            }
            TextCursor& words = element_blocks[i_block];
            words.integer("an element in order", element, element);
            spans.integer("an element in order", element, element);
            weight_words.integer("an element in order", element, element);
            std::array<int, d> last{};
            int n_functions = 1;
            for (int k = 0; k < d; ++k) {
                last[k] = spans.integer("a knot span", space.knots[k].degree() + 1,
                                        space.knots[k].n_basis()) -
                          1;
                n_functions *= space.knots[k].degree() + 1;
            }
            for (int j = 0; j < n_functions; ++j) {
                std::array<int, d> index = last;
                for (int k = 0, rest = j; k < d; ++k) {
                    index[k] -= rest % (space.knots[k].degree() + 1);
                    rest /= space.knots[k].degree() + 1;
                }
                const int function = space.index(index);
                const int node = words.integer("a node", 1, max_count);
                const double weight = weight_words.number("a weight");
                if (patch.nodes[function] != 0 && patch.nodes[function] != node) {
                    words.fail("element {} puts node {} where another has node {}; expected one",
                               element, node, patch.nodes[function]);
                }
                if (patch.nodes[function] != 0 && patch.weights[function] != weight) {
                    weight_words.fail("element {} gives node {} weight {}, another {}", element,
                                      node, weight, patch.weights[function]);
                }
                patch.nodes[function] = node;
                patch.weights[function] = weight;
            }
        }
        for (std::size_t j = 0; j < patch.nodes.size(); ++j) {
            if (patch.nodes[j] == 0) {
                element_blocks[i_block].fail(
                    "no element holds control point {}; expected all knot spans", j);
            }
        }
    }
    element_blocks[i_block].expect_end("the elements");
    weight_words.expect_end("the weights");
}

using NumberSets = std::map<std::string, std::set<int>>;

NumberSets read_number_sets(const Model& inp, const std::string& keyword) {
    NumberSets sets;
    for (const Block& block : inp.blocks()) {
        const auto name = block.options.find(keyword);
        if (block.keyword != keyword || name == block.options.end()) {
            continue;
        }
        std::set<int>& set = sets[name->second];
        TextCursor words = inp.cursor(block);
        const bool is_range = block.options.count("generate") > 0;
        while (!words.at_end()) {
            const int first = words.integer("a number", 1, max_count);
            if (!is_range) {
                set.insert(first);
                continue;
            }
            const int last = words.integer("the last number", first, max_count);
            const int step = words.integer("the step", 1, max_count);
            constexpr int longest_range = 1'000'000;
            if ((last - first) / step > longest_range) {
                words.fail("the range has more than {} numbers; expected fewer", longest_range);
            }
            for (int i = first; i <= last; i += step) {
                set.insert(i);
            }
        }
    }
    return sets;
}

template <int d>
void add_node_sets(const Model& inp, const NodeNumbers& nodes, iga::MultiPatch<d>& multipatch,
                   std::vector<std::string>& notes) {
    for (const auto& [name, set] : read_number_sets(inp, "nset")) {
        if (std::optional<iga::BoundarySet<d>> entities = entities_of<d>(multipatch, nodes, set);
            entities && !entities->empty()) {
            multipatch.boundary_sets[name] = std::move(*entities);
        } else {
            notes.push_back(fmt::format(
                "node set '{}' was left out: its nodes are not sides, edges and corners", name));
        }
    }
}

/// Element sets with a pressure on one of their faces.
template <int d>
void add_loaded_faces(const Model& inp, const std::vector<PatchData<d>>& patches,
                      iga::MultiPatch<d>& multipatch) {
    const NumberSets element_sets = read_number_sets(inp, "elset");
    for (const Block& block : inp.blocks()) {
        if (block.keyword != "dload") {
            continue;
        }
        TextCursor words = inp.cursor(block);
        while (!words.at_end()) {
            std::string name(words.word("an element set"));
            const std::string_view label = words.word("a load, U and two digits");
            words.rest_of_line();
            name = name.substr(name.rfind('.') + 1);
            const auto set = element_sets.find(name);
            const int face = label.size() == 3 ? label[1] - '0' : 0;
            if (set == element_sets.end() || face < 1 || face > iga::n_sides<d>) {
                continue;
            }
            iga::BoundarySet<d>& sides =
                multipatch.boundary_sets[fmt::format("{}_face{}", name, face)];
            int first_element = 1;
            for (std::size_t i = 0; i < patches.size(); ++i) {
                const int n = patches[i].n_elements;
                const auto begin = set->second.lower_bound(first_element);
                const auto end = set->second.lower_bound(first_element + n);
                if (std::distance(begin, end) == n) {
                    sides.push_back(iga::make_side<d>(static_cast<int>(i), face - 1));
                }
                first_element += n;
            }
            if (sides.empty()) {
                multipatch.boundary_sets.erase(fmt::format("{}_face{}", name, face));
            }
        }
    }
}

template <int d>
RawSplines read_model(const Model& inp, const Model& nb) {
    std::vector<PatchData<d>> patches = read_patches<d>(nb);
    read_elements<d>(inp, nb, patches);
    const std::map<int, std::vector<double>> nodes = read_nodes(inp, d);
    iga::MultiPatch<d> multipatch;
    NodeNumbers numbers;
    for (const PatchData<d>& patch : patches) {
        MatrixX points(static_cast<Eigen::Index>(patch.nodes.size()), d);
        for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
            const auto node = nodes.find(patch.nodes[i]);
            if (node == nodes.end()) {
                inp.cursor(inp.block("element"))
                    .fail("an element has node {}; expected one of the {} nodes", patch.nodes[i],
                          nodes.size());
            }
            for (int k = 0; k < d; ++k) {
                points(static_cast<Eigen::Index>(i), k) = node->second[k];
            }
        }
        multipatch.patches.push_back(make_patch<d>(
            nb.cursor(nb.block("weight")).where(), patch.space(), std::move(points),
            Eigen::Map<const VectorX>(patch.weights.data(),
                                      static_cast<Eigen::Index>(patch.weights.size()))));
        numbers.push_back(patch.nodes);
    }
    RawSplines result;
    add_node_sets<d>(inp, numbers, multipatch, result.notes);
    add_loaded_faces<d>(inp, patches, multipatch);
    result.multipatch = std::move(multipatch);
    return result;
}

}  // namespace

RawSplines read_yeti(const std::string& file, std::string_view text, const std::string& nb_file,
                     std::string_view nb_text) {
    const Model inp(file, text);
    const Model nb(nb_file, nb_text);
    TextCursor words = nb.cursor(nb.block("dimension"));
    return words.integer("the dimension", 2, 3) == 2 ? read_model<2>(inp, nb)
                                                     : read_model<3>(inp, nb);
}

namespace {

template <int d>
NodeNumbers number_nodes(const iga::MultiPatch<d>& multipatch, int& n_nodes) {
    NodeNumbers nodes;
    n_nodes = 0;
    // Partners of each function across interfaces, when they are the same point.
    std::vector<std::map<int, std::vector<std::pair<int, int>>>> partners(
        multipatch.patches.size());
    for (const iga::Interface<d>& interface : multipatch.interfaces) {
        const iga::Patch<d>& first = multipatch.patches[interface.first_patch];
        const iga::Patch<d>& second = multipatch.patches[interface.second_patch];
        const std::vector<int> here = iga::functions_on<d>(
            first.space(), iga::make_side<d>(interface.first_patch, interface.first_side).position);
        const std::vector<int> there = iga::matching_functions<d>(second.space(), interface);
        for (std::size_t i = 0; i < here.size(); ++i) {
            if (first.control_points().row(here[i]) == second.control_points().row(there[i])) {
                partners[interface.first_patch][here[i]].push_back(
                    {interface.second_patch, there[i]});
                partners[interface.second_patch][there[i]].push_back(
                    {interface.first_patch, here[i]});
            }
        }
    }
    for (const iga::Patch<d>& patch : multipatch.patches) {
        nodes.emplace_back(patch.space().n_basis(), 0);
    }
    for (int patch = 0; patch < multipatch.n_patches(); ++patch) {
        for (std::size_t i = 0; i < nodes[patch].size(); ++i) {
            if (nodes[patch][i] != 0) {
                continue;
            }
            ++n_nodes;
            std::vector<std::pair<int, int>> open = {{patch, static_cast<int>(i)}};
            while (!open.empty()) {
                const auto [p, function] = open.back();
                open.pop_back();
                if (nodes[p][function] != 0) {
                    continue;
                }
                nodes[p][function] = n_nodes;
                if (const auto found = partners[p].find(function); found != partners[p].end()) {
                    open.insert(open.end(), found->second.begin(), found->second.end());
                }
            }
        }
    }
    return nodes;
}

/// Abaqus takes at most 16 entries in a line; a comma at its end says that the list goes on.
template <typename Range>
std::string wrapped(const Range& numbers, bool goes_on) {
    std::string text;
    int n = 0;
    const auto size = static_cast<int>(numbers.size());
    for (const auto& number : numbers) {
        ++n;
        text += fmt::format("{}", number);
        text += n == size ? "\n" : n % 15 != 0 ? ", " : goes_on ? ",\n" : "\n";
    }
    return text;
}

/// Elements of one patch: nodes into the .inp, spans and weights into the .NB.
template <int d>
void append_elements(const iga::Patch<d>& patch, const std::vector<int>& nodes, int& element,
                     std::string& lines, std::string& spans, std::string& weights) {
    const iga::TensorSpace<d>& space = patch.space();
    iga::TensorSpace<d> local = space;
    int n_elements = 1;
    int n_functions = 1;
    for (const iga::KnotVector& knots : local.knots) {
        n_elements *= knots.n_elements();
        n_functions *= knots.degree() + 1;
    }
    for (int i = 0; i < n_elements; ++i) {
        ++element;
        std::array<int, d> last{};
        spans += fmt::format("{}", element);
        for (int k = 0, rest = i; k < d; ++k) {
            const int n = space.knots[k].n_elements();
            last[k] = space.knots[k].span_of_element(rest % n);
            rest /= n;
            spans += fmt::format(", {}", last[k] + 1);
        }
        spans += "\n";
        std::vector<int> of_element = {element};
        weights += fmt::format("{}", element);
        for (int j = 0; j < n_functions; ++j) {
            std::array<int, d> index = last;
            for (int k = 0, rest = j; k < d; ++k) {
                index[k] -= rest % (space.knots[k].degree() + 1);
                rest /= space.knots[k].degree() + 1;
            }
            const int function = space.index(index);
            of_element.push_back(nodes[function]);
            weights += fmt::format(", {}", patch.is_rational() ? patch.weights()[function] : 1.0);
        }
        weights += "\n";
        lines += wrapped(of_element, true);
    }
}

template <int d>
std::string node_lines(const iga::MultiPatch<d>& multipatch, const NodeNumbers& nodes) {
    std::string text;
    int n_written = 0;
    for (int patch = 0; patch < multipatch.n_patches(); ++patch) {
        for (std::size_t i = 0; i < nodes[patch].size(); ++i) {
            if (nodes[patch][i] == n_written + 1) {
                text += fmt::format("{}", ++n_written);
                for (int k = 0; k < d; ++k) {
                    text += fmt::format(", {}", multipatch.patches[patch].control_points()(
                                                    static_cast<Eigen::Index>(i), k));
                }
                text += "\n";
            }
        }
    }
    return text;
}

template <int d>
std::string set_lines(const iga::MultiPatch<d>& multipatch, const NodeNumbers& nodes) {
    std::string text;
    for (const auto& [name, set] : multipatch.boundary_sets) {
        const std::set<int> of_set = nodes_of<d>(multipatch, nodes, set);
        std::optional<iga::BoundarySet<d>> found = entities_of<d>(multipatch, nodes, of_set);
        iga::BoundarySet<d> expected = set;
        std::sort(expected.begin(), expected.end());
        if (found) {
            std::sort(found->begin(), found->end());
        }
        const bool is_name =
            !name.empty() && name.find_first_of(",=*. \t\r\n") == std::string::npos;
        if (set.empty() || found != expected || !is_name) {
            throw InputError(
                "write_splines: boundary set '{}' of {} can't be told by its nodes and name in "
                "yeti files; refine the patches, rename the set (no blanks, no ',=*.') or write "
                ".h5",
                name, set.empty() ? "nothing" : set.front().name());
        }
        text += fmt::format("*NSET,NSET={}\n{}", name, wrapped(of_set, false));
    }
    return text;
}

}  // namespace

template <int d>
YetiTexts to_yeti(const iga::MultiPatch<d>& multipatch) {
    if (multipatch.dimension() != d) {
        throw InputError(
            "write_splines: surfaces in space; yeti files take them as shells only; write .xml, "
            ".txt or .h5");
    }
    int n_nodes = 0;
    const NodeNumbers nodes = number_nodes<d>(multipatch, n_nodes);
    std::string elements;
    std::string spans;
    std::string weights;
    std::string element_sets;
    std::string properties;
    std::string knots;
    std::string degrees;
    std::vector<int> n_functions;
    std::vector<int> n_elements;
    int element = 0;
    for (int i = 0; i < multipatch.n_patches(); ++i) {
        const iga::Patch<d>& patch = multipatch.patches[i];
        const int first = element + 1;
        append_elements<d>(patch, nodes[i], element, elements, spans, weights);
        n_elements.push_back(element - first + 1);
        element_sets +=
            fmt::format("*ELSET,ELSET=EltPatch{},generate\n{}, {}, 1\n", i + 1, first, element);
        properties += fmt::format("*UEL PROPERTY, ELSET=EltPatch{0}, MATERIAL=Mat\n{0}\n", i + 1);
        knots += fmt::format("*Patch({})\n", i + 1);
        int n = 1;
        for (int k = 0; k < d; ++k) {
            knots += fmt::format("{}\n{}\n", patch.knots(k).knots().size(),
                                 fmt::join(patch.knots(k).knots(), ", "));
            n *= patch.knots(k).degree() + 1;
        }
        n_functions.push_back(n);
        degrees += fmt::format("{}\n", fmt::join(patch.space().degrees(), ", "));
    }
    YetiTexts texts;
    texts.inp = fmt::format(
        "*HEADING\n*Part, name=Piece\n*USER ELEMENT, NODES={}, TYPE=U1, COORDINATES={}, "
        "INTEGRATION={}, TENSOR={}\n{}\n*Node,nset=AllNode\n{}*Element, type=U1,elset=AllEls\n{}"
        "{}{}{}*End Part\n*Assembly, name=Assembly\n*Instance, name=I1, part=Piece\n*End "
        "Instance\n*End Assembly\n*MATERIAL,NAME=Mat\n*Elastic\n1.0, 0.3\n",
        n_functions[0], d, n_functions[0], d == 2 ? "PSTRAIN" : "THREED", d == 2 ? "1,2" : "1,2,3",
        node_lines<d>(multipatch, nodes), elements, element_sets, set_lines<d>(multipatch, nodes),
        properties);
    texts.nb = fmt::format(
        "*Dimension\n{}\n*Number of CP by element\n{}\n*Number of patch\n{}\n*Total number of "
        "element\n{}\n*Number of element by patch\n{}\n{}*Jpqr\n{}*Nijk\n{}*Weight\n{}",
        d, fmt::join(n_functions, ", "), multipatch.n_patches(), element,
        fmt::join(n_elements, ", "), knots, degrees, spans, weights);
    return texts;
}

template YetiTexts to_yeti(const iga::MultiPatch<2>&);
template YetiTexts to_yeti(const iga::MultiPatch<3>&);

}  // namespace couture::io
