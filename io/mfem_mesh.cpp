#include "io/mfem_mesh.h"

#include <algorithm>
#include <map>
#include <optional>

#include "io/mfem_topology.h"
#include "io/text_cursor.h"

namespace couture::io {

namespace {

constexpr int segment_type = 1;
constexpr int square_type = 3;
constexpr int cube_type = 5;

/// An edge of the file: its number among the edges, and its knot vector, which runs from a vertex.
struct FileEdge {
    int number;
    int knot_vector;
    int from;
};

/// The first part of the file, common to both layouts.
template <int d>
struct Skeleton {
    std::vector<CornerVertices<d>> elements;
    std::map<VertexPair, FileEdge> edges;
    int n_vertices = 0;
    /// Attribute and sorted vertices of each boundary element, with its line.
    struct Boundary {
        int attribute;
        std::vector<int> vertices;
        std::string where;
    };
    std::vector<Boundary> boundary;
};

template <int d>
Skeleton<d> read_skeleton(TextCursor& words, std::vector<std::string>& notes) {
    Skeleton<d> skeleton;
    words.expect("elements");
    const int n_elements = words.integer("the number of elements", 1, max_count);
    int first_attribute = 0;
    bool has_attributes = false;
    for (int i = 0; i < n_elements; ++i) {
        const int attribute = words.integer("an attribute", 1, max_count);
        first_attribute = i == 0 ? attribute : first_attribute;
        has_attributes |= attribute != first_attribute;
        const int type = d == 2 ? square_type : cube_type;
        words.integer("the element type", type, type);
        CornerVertices<d> vertices;
        for (const int corner : mfem_corner_bits<d>) {
            vertices[corner] = words.integer("a vertex", 0, max_count);
        }
        CornerVertices<d> sorted = vertices;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
            words.fail("element {} has a vertex twice; expected {} different ones", i, 1 << d);
        }
        skeleton.elements.push_back(vertices);
    }
    if (has_attributes) {
        notes.emplace_back("attributes of the elements were left out: patches carry no numbers");
    }
    words.expect("boundary");
    const int n_boundary = words.integer("the number of boundary elements", 0, max_count);
    for (int i = 0; i < n_boundary; ++i) {
        typename Skeleton<d>::Boundary element;
        element.attribute = words.integer("an attribute", 1, max_count);
        const int type = d == 2 ? segment_type : square_type;
        words.integer("the boundary element type", type, type);
        for (int k = 0; k < (1 << (d - 1)); ++k) {
            element.vertices.push_back(words.integer("a vertex", 0, max_count));
        }
        std::sort(element.vertices.begin(), element.vertices.end());
        element.where = words.where();
        skeleton.boundary.push_back(std::move(element));
    }
    words.expect("edges");
    const int n_edges = words.integer("the number of edges", 0, max_count);
    for (int i = 0; i < n_edges; ++i) {
        const int knot_vector = words.integer("a knot vector", 0, max_count);
        const int from = words.integer("a vertex", 0, max_count);
        const int to = words.integer("a vertex", 0, max_count);
        if (!skeleton.edges.emplace(sorted_pair(from, to), FileEdge{i, knot_vector, from}).second) {
            words.fail("the edge of vertices {} and {} occurs twice; expected it once", from, to);
        }
    }
    words.expect("vertices");
    skeleton.n_vertices = words.integer("the number of vertices", 1, max_count);
    for (const CornerVertices<d>& element : skeleton.elements) {
        for (const int vertex : element) {
            if (vertex >= skeleton.n_vertices) {
                words.fail("an element has vertex {}; expected numbers below {}", vertex,
                           skeleton.n_vertices);
            }
        }
    }
    return skeleton;
}

template <int d>
void add_boundary_sets(const Skeleton<d>& skeleton, iga::MultiPatch<d>& multipatch) {
    std::map<std::vector<int>, iga::PatchEntity<d>> side_of_vertices;
    for (std::size_t i = 0; i < skeleton.elements.size(); ++i) {
        for (int side = 0; side < iga::n_sides<d>; ++side) {
            std::vector<int> vertices;
            for (const int corner : side_corners<d>(side)) {
                vertices.push_back(skeleton.elements[i][corner]);
            }
            std::sort(vertices.begin(), vertices.end());
            side_of_vertices.emplace(vertices, iga::make_side<d>(static_cast<int>(i), side));
        }
    }
    for (const auto& element : skeleton.boundary) {
        const auto side = side_of_vertices.find(element.vertices);
        if (side == side_of_vertices.end()) {
            throw FileError("{}: boundary element of vertices {}; expected those of a side",
                            element.where, fmt::join(element.vertices, " "));
        }
        iga::BoundarySet<d>& set =
            multipatch.boundary_sets[fmt::format("boundary_{}", element.attribute)];
        if (std::find(set.begin(), set.end(), side->second) == set.end()) {
            set.push_back(side->second);
        }
    }
}

/// Knot vectors as listed: `degree n_control_points knots...`.
std::vector<iga::KnotVector> read_knot_vectors(TextCursor& words, int low, int high) {
    words.expect("knotvectors");
    const int n = words.integer("the number of knot vectors", low, high);
    std::vector<iga::KnotVector> result;
    for (int i = 0; i < n; ++i) {
        const int degree = words.integer("a degree", 1, iga::max_degree);
        const int n_basis = words.integer("a number of control points", degree + 1, max_count);
        std::vector<double> knots = words.numbers(long{n_basis} + degree + 1, "knots");
        result.push_back(make_knots(words.where(), degree, std::move(knots)));
    }
    return result;
}

template <int d>
iga::TensorSpace<d> make_space(const std::vector<iga::KnotVector>& knots) {
    if constexpr (d == 2) {
        return {{knots[0], knots[1]}};
    } else {
        return {{knots[0], knots[1], knots[2]}};
    }
}

template <int d>
std::vector<iga::Patch<d>> read_patches(TextCursor& words, int n_patches) {
    words.expect("patches");
    std::vector<iga::Patch<d>> result;
    for (int i = 0; i < n_patches; ++i) {
        iga::TensorSpace<d> space = make_space<d>(read_knot_vectors(words, d, d));
        words.expect("dimension");
        const int dimension = words.integer("the dimension of the space", d, 3);
        const std::string_view kind = words.word("controlpoints");
        const bool is_cartesian = kind == "controlpoints_cartesian";
        if (!is_cartesian && kind != "controlpoints" && kind != "controlpoints_homogeneous") {
            words.fail("found {}; expected 'controlpoints' or 'controlpoints_cartesian'",
                       in_quotes(kind));
        }
        const long count = count_control_points<d>(words.where(), space.sizes());
        const std::vector<double> numbers =
            words.numbers(count * (dimension + 1), "coordinates and weight");
        MatrixX points(count, dimension);
        VectorX weights(count);
        for (long j = 0; j < count; ++j) {
            const double* row = &numbers[static_cast<std::size_t>(j * (dimension + 1))];
            weights[j] = row[dimension];
            if (!(weights[j] > 0.0)) {
                words.fail("patch {}: weight {} = {}; expected a positive number", i, j,
                           weights[j]);
            }
            for (int k = 0; k < dimension; ++k) {
                points(j, k) = is_cartesian ? row[k] : row[k] / weights[j];
            }
        }
        result.push_back(
            make_patch<d>(words.where(), std::move(space), std::move(points), std::move(weights)));
        if (result.back().dimension() != result.front().dimension()) {
            words.fail("patch {}: control points have {} coordinates, those of the first patch {}",
                       i, result.back().dimension(), result.front().dimension());
        }
    }
    return result;
}

/// Numbers MFEM's degrees of freedom of a mesh with global nodes.
template <int d>
class NodeNumbering {
  public:
    NodeNumbering(const TextCursor& words, const Skeleton<d>& skeleton,
                  const std::vector<iga::KnotVector>& knot_vectors)
        : skeleton_(skeleton) {
        for (const CornerVertices<d>& element : skeleton.elements) {
            spaces_.push_back(space_of(words, element, knot_vectors));
        }
        n_ = skeleton.n_vertices;
        std::vector<long> sizes(skeleton.edges.size());
        for (const auto& [vertices, edge] : skeleton.edges) {
            if (edge.knot_vector >= static_cast<int>(knot_vectors.size())) {
                words.fail("edge {} has knot vector {}; expected numbers below {}", edge.number,
                           edge.knot_vector, knot_vectors.size());
            }
            sizes[edge.number] = knot_vectors[edge.knot_vector].n_basis() - 2;
        }
        for (const long size : sizes) {
            edge_offsets_.push_back(n_);
            n_ += size;
        }
        if constexpr (d == 3) {
            number_faces(words);
        }
        for (const iga::TensorSpace<d>& space : spaces_) {
            interior_offsets_.push_back(n_);
            long n_inside = count_control_points<d>(words.where(), space.sizes()) > 0 ? 1 : 0;
            for (const int size : space.sizes()) {
                n_inside *= size - 2;
            }
            n_ += n_inside;
        }
    }

    [[nodiscard]] long n() const { return n_; }
    [[nodiscard]] const iga::TensorSpace<d>& space(int patch) const { return spaces_[patch]; }
    /// Number of the node of control point `i` of the patch.
    [[nodiscard]] long node(int patch, const std::array<int, d>& i) const {
        const std::array<int, d> sizes = spaces_[patch].sizes();
        std::vector<int> free;
        int corner = 0;
        for (int k = 0; k < d; ++k) {
            if (i[k] == sizes[k] - 1) {
                corner |= 1 << k;
            } else if (i[k] > 0) {
                free.push_back(k);
            }
        }
        const CornerVertices<d>& vertices = skeleton_.elements[patch];
        if (free.empty()) {
            return vertices[corner];
        }
        if (free.size() == 1) {
            const int low = vertices[corner];
            const int high = vertices[corner | (1 << free[0])];
            const int n = sizes[free[0]] - 2;
            const int here = i[free[0]] - 1;
            return edge_offsets_[skeleton_.edges.at(sorted_pair(low, high)).number] +
                   (low < high ? here : n - 1 - here);
        }
        if (free.size() == 2 && d == 3) {
            return node_on_face(vertices, corner, free, sizes, i);
        }
        long inside = 0;
        for (int k = d - 1; k >= 0; --k) {
            inside = inside * (sizes[k] - 2) + i[k] - 1;
        }
        return interior_offsets_[patch] + inside;
    }

  private:
    struct Face {
        /// Vertices around the face, as its first element has them.
        std::vector<int> vertices;
        /// Interior functions along the first side of it and the second.
        int n_first = 0;
        int n_second = 0;
        long offset = 0;
    };

    iga::TensorSpace<d> space_of(const TextCursor& words, const CornerVertices<d>& element,
                                 const std::vector<iga::KnotVector>& knot_vectors) const {
        // Per direction: knot vector and whether it runs from the low end.
        std::array<std::optional<std::pair<int, bool>>, d> found;
        for (const PatchEdge& edge : patch_edges<d>()) {
            const int low = element[edge.low];
            const int high = element[edge.high];
            const auto place = skeleton_.edges.find(sorted_pair(low, high));
            if (place == skeleton_.edges.end()) {
                words.fail("the edge of vertices {} and {} is not listed; expected all edges", low,
                           high);
            }
            const std::pair<int, bool> here{place->second.knot_vector, place->second.from == low};
            if (found[edge.direction] && *found[edge.direction] != here) {
                words.fail(
                    "edge {} of vertices {} and {}: knot vector {} from vertex {} does not agree "
                    "with the parallel edges of its element; expected knot vector {}, same sense",
                    place->second.number, low, high, here.first, place->second.from,
                    found[edge.direction]->first);
            }
            if (here.first >= static_cast<int>(knot_vectors.size())) {
                words.fail("edge {} has knot vector {}; expected numbers below {}",
                           place->second.number, here.first, knot_vectors.size());
            }
            found[edge.direction] = here;
        }
        std::vector<iga::KnotVector> knots;
        for (const auto& [number, is_forward] : {*found[0], *found[1], *found[d - 1]}) {
            knots.push_back(is_forward ? knot_vectors[number] : knot_vectors[number].reversed());
        }
        return make_space<d>(knots);
    }

    void number_faces(const TextCursor& words) {
        for (std::size_t i = 0; i < skeleton_.elements.size(); ++i) {
            for (const int side : mfem_face_sides) {
                const std::vector<int> corners = mfem_side_corners<d>(side);
                Face face;
                for (const int corner : corners) {
                    face.vertices.push_back(skeleton_.elements[i][corner]);
                }
                const auto size_along = [&](int a, int b) {
                    const int bit = corners[a] ^ corners[b];
                    return spaces_[i].knots[bit == 1 ? 0 : bit == 2 ? 1 : 2].n_basis() - 2;
                };
                face.n_first = size_along(0, 1);
                face.n_second = size_along(1, 2);
                face.offset = n_;
                std::vector<int> key = face.vertices;
                std::sort(key.begin(), key.end());
                if (faces_.emplace(std::move(key), face).second) {
                    n_ += count_control_points<2>(words.where(), {face.n_first, face.n_second});
                }
            }
        }
    }

    [[nodiscard]] long node_on_face(const CornerVertices<d>& vertices, int corner,
                                    const std::vector<int>& free, const std::array<int, d>& sizes,
                                    const std::array<int, d>& i) const {
        const int a = 1 << free[0];
        const int b = 1 << free[1];
        std::vector<int> key = {vertices[corner], vertices[corner | a], vertices[corner | b],
                                vertices[corner | a | b]};
        std::sort(key.begin(), key.end());
        const Face& face = faces_.at(key);
        // Places of the vertices around the face: 0 (0, 0), 1 (1, 0), 2 (1, 1), 3 (0, 1).
        const auto place = [&](int vertex) {
            const int around =
                static_cast<int>(std::find(face.vertices.begin(), face.vertices.end(), vertex) -
                                 face.vertices.begin());
            return std::array<int, 2>{around == 1 || around == 2 ? 1 : 0, around >= 2 ? 1 : 0};
        };
        const std::array<int, 2> origin = place(vertices[corner]);
        std::array<int, 2> where{};
        for (const int k : free) {
            const std::array<int, 2> end = place(vertices[corner | (1 << k)]);
            const int axis = end[0] != origin[0] ? 0 : 1;
            where[axis] = origin[axis] == 0 ? i[k] - 1 : sizes[k] - 2 - i[k];
        }
        return face.offset + where[0] + long{where[1]} * face.n_first;
    }

    const Skeleton<d>& skeleton_;
    std::vector<iga::TensorSpace<d>> spaces_;
    std::vector<long> edge_offsets_;
    std::map<std::vector<int>, Face> faces_;
    std::vector<long> interior_offsets_;
    long n_ = 0;
};

template <int d>
std::vector<iga::Patch<d>> read_global_nodes(TextCursor& words, const Skeleton<d>& skeleton) {
    const std::vector<iga::KnotVector> knot_vectors = read_knot_vectors(words, 1, max_count);
    const NodeNumbering<d> numbering(words, skeleton, knot_vectors);
    words.expect("weights");
    const std::vector<double> weights = words.numbers(numbering.n(), "weights");
    words.expect("FiniteElementSpace");
    words.expect("FiniteElementCollection:");
    const std::string_view collection = words.word("a NURBS collection");
    if (!collection.starts_with("NURBS")) {
        words.fail("found {}; expected a NURBS collection", in_quotes(collection));
    }
    words.expect("VDim:");
    const int dimension = words.integer("the number of coordinates", d, 3);
    words.expect("Ordering:");
    const bool is_by_point = words.integer("the ordering", 0, 1) == 1;
    const std::vector<double> nodes = words.numbers(numbering.n() * dimension, "coordinates");

    std::vector<iga::Patch<d>> result;
    for (std::size_t i_patch = 0; i_patch < skeleton.elements.size(); ++i_patch) {
        const auto patch = static_cast<int>(i_patch);
        const iga::TensorSpace<d>& space = numbering.space(patch);
        const int n = space.n_basis();
        MatrixX points(n, dimension);
        VectorX patch_weights(n);
        for (int j = 0; j < n; ++j) {
            const long node = numbering.node(patch, space.indices(j));
            patch_weights[j] = weights[static_cast<std::size_t>(node)];
            for (int k = 0; k < dimension; ++k) {
                points(j, k) = nodes[static_cast<std::size_t>(
                    is_by_point ? node * dimension + k : k * numbering.n() + node)];
            }
        }
        result.push_back(
            make_patch<d>(words.where(), space, std::move(points), std::move(patch_weights)));
    }
    return result;
}

/// All after the dimension.
template <int d>
RawSplines read_body(TextCursor& words) {
    RawSplines result;
    const Skeleton<d> skeleton = read_skeleton<d>(words, result.notes);
    iga::MultiPatch<d> multipatch;
    try {
        multipatch.interfaces = interfaces_of_vertices<d>(skeleton.elements);
    } catch (const TopologyError& error) {
        throw FileError("{}: {}", words.file(), error.what());
    }
    const std::string_view layout = words.peek();
    if (layout == "patches") {
        multipatch.patches = read_patches<d>(words, static_cast<int>(skeleton.elements.size()));
    } else if (layout == "knotvectors") {
        multipatch.patches = read_global_nodes<d>(words, skeleton);
    } else {
        const std::string_view found = words.word("'patches' or 'knotvectors'");
        words.fail(
            "found {}; expected 'patches' or 'knotvectors' (refined, periodic and "
            "non-conforming meshes are not read)",
            in_quotes(found));
    }
    words.expect_end("the mesh");
    add_boundary_sets<d>(skeleton, multipatch);
    result.lists_interfaces = !multipatch.interfaces.empty();
    result.multipatch = std::move(multipatch);
    return result;
}

}  // namespace

RawSplines read_mfem_mesh(const std::string& file, std::string_view text) {
    TextCursor words(file, text, '#');
    for (const char* keyword : {"MFEM", "NURBS", "mesh"}) {
        words.expect(keyword);
    }
    const std::string_view version = words.word("v1.0");
    if (version != "v1.0" && version != "v1.1") {
        words.fail("found version {}; expected v1.0 or v1.1", in_quotes(version));
    }
    words.expect("dimension");
    return words.integer("the dimension", 2, 3) == 2 ? read_body<2>(words) : read_body<3>(words);
}

}  // namespace couture::io
