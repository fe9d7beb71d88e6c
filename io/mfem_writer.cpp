#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "iga/core/error.h"
#include "io/mfem_mesh.h"
#include "io/mfem_topology.h"
#include "io/text_cursor.h"

namespace couture::io {

namespace {

/// Classes of equal things; each member is the same way round as the first of its class, or not.
class SignedClasses {
  public:
    explicit SignedClasses(std::size_t n) : parent_(n), is_flipped_(n, false) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    struct Member {
        std::size_t root;
        bool is_flipped;
    };
    [[nodiscard]] Member find(std::size_t i) const {
        bool is_flipped = false;
        while (parent_[i] != i) {
            is_flipped = is_flipped != is_flipped_[i];
            i = parent_[i];
        }
        return {i, is_flipped};
    }
    /// False if the two are one class already, the other way round.
    bool join(std::size_t a, std::size_t b, bool is_flipped) {
        const Member first = find(a);
        const Member second = find(b);
        const bool between = (first.is_flipped != second.is_flipped) != is_flipped;
        if (first.root == second.root) {
            return !between;
        }
        const auto [low, high] = std::minmax(first.root, second.root);
        parent_[high] = low;
        is_flipped_[high] = between;
        return true;
    }

  private:
    std::vector<std::size_t> parent_;
    std::vector<bool> is_flipped_;
};

/// Corners of the second side in the order of side_corners of the first.
template <int d>
std::vector<int> matching_corners(const iga::Interface<d>& interface) {
    const std::vector<int> second = side_corners<d>(interface.second_side);
    std::vector<int> result;
    for (int corner = 0; corner < (1 << (d - 1)); ++corner) {
        int there = 0;
        for (int i = 0; i < d - 1; ++i) {
            if (((corner >> i & 1) != 0) != interface.map.reversed[i]) {
                there |= 1 << interface.map.axis[i];
            }
        }
        result.push_back(second[there]);
    }
    return result;
}

template <int d>
std::vector<CornerVertices<d>> number_vertices(const iga::MultiPatch<d>& multipatch,
                                               int& n_vertices) {
    constexpr int n_corners = 1 << d;
    SignedClasses classes(static_cast<std::size_t>(multipatch.n_patches()) * n_corners);
    for (const iga::Interface<d>& interface : multipatch.interfaces) {
        const std::vector<int> first = side_corners<d>(interface.first_side);
        const std::vector<int> second = matching_corners(interface);
        for (std::size_t i = 0; i < first.size(); ++i) {
            classes.join(static_cast<std::size_t>(interface.first_patch) * n_corners + first[i],
                         static_cast<std::size_t>(interface.second_patch) * n_corners + second[i],
                         false);
        }
    }
    std::map<std::size_t, int> number_of_root;
    std::vector<CornerVertices<d>> result(multipatch.patches.size());
    for (std::size_t i = 0; i < multipatch.patches.size(); ++i) {
        for (int corner = 0; corner < n_corners; ++corner) {
            result[i][corner] = number_of_root
                                    .emplace(classes.find(i * n_corners + corner).root,
                                             static_cast<int>(number_of_root.size()))
                                    .first->second;
        }
    }
    n_vertices = static_cast<int>(number_of_root.size());
    return result;
}

[[noreturn]] void refuse(const std::string& reason) {
    throw InputError("write_splines: {}; MFEM NURBS meshes can't say that: write .xml, .txt or .h5",
                     reason);
}

/// Every vertex once in its element, and the interfaces those that the vertices tell.
template <int d>
void check_vertices(const iga::MultiPatch<d>& multipatch,
                    const std::vector<CornerVertices<d>>& elements) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (std::set<int>(elements[i].begin(), elements[i].end()).size() != elements[i].size()) {
            refuse(fmt::format("patch {} meets itself", i));
        }
    }
    std::vector<iga::Interface<d>> told;
    try {
        told = interfaces_of_vertices<d>(elements);
    } catch (const TopologyError& error) {
        refuse(error.what());
    }
    for (const iga::Interface<d>& interface : told) {
        const iga::Interface<d> turned{interface.second_patch, interface.second_side,
                                       interface.first_patch, interface.first_side,
                                       interface.map.inverse()};
        const auto& all = multipatch.interfaces;
        if (std::find(all.begin(), all.end(), interface) == all.end() &&
            std::find(all.begin(), all.end(), turned) == all.end()) {
            refuse(fmt::format(
                "{} and {} have the same corners but do not meet",
                iga::make_side<d>(interface.first_patch, interface.first_side).name(),
                iga::make_side<d>(interface.second_patch, interface.second_side).name()));
        }
    }
}

/// Lines `knot_vector from to` of the edges.
template <int d>
std::vector<std::string> edge_lines(const iga::MultiPatch<d>& multipatch,
                                    const std::vector<CornerVertices<d>>& elements) {
    const std::vector<PatchEdge> edges = patch_edges<d>();
    // Directions of patches that share an edge have one knot vector.
    std::map<VertexPair, std::pair<std::size_t, bool>> first_use;
    SignedClasses directions(elements.size() * d);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (const PatchEdge& edge : edges) {
            const int low = elements[i][edge.low];
            const int high = elements[i][edge.high];
            const std::size_t direction = i * d + edge.direction;
            const auto [place, is_new] =
                first_use.emplace(sorted_pair(low, high), std::pair{direction, low < high});
            if (is_new) {
                continue;
            }
            const bool is_flipped = place->second.second != (low < high);
            const std::size_t other = place->second.first;
            const iga::KnotVector& here = multipatch.patches[i].knots(edge.direction);
            const iga::KnotVector& there =
                multipatch.patches[other / d].knots(static_cast<int>(other % d));
            if (!directions.join(other, direction, is_flipped) ||
                !here.conforms_to(is_flipped ? there.reversed() : there)) {
                refuse(
                    fmt::format("patch {} direction {} and patch {} direction {} share an edge "
                                "but not knots and sense",
                                other / d, other % d, i, edge.direction));
            }
        }
    }
    std::map<std::size_t, int> number_of_root;
    std::vector<std::string> lines;
    std::set<VertexPair> written;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (const PatchEdge& edge : edges) {
            int from = elements[i][edge.low];
            int to = elements[i][edge.high];
            if (!written.insert(sorted_pair(from, to)).second) {
                continue;
            }
            const auto member = directions.find(i * d + edge.direction);
            const int number =
                number_of_root.emplace(member.root, static_cast<int>(number_of_root.size()))
                    .first->second;
            if (member.is_flipped) {
                std::swap(from, to);
            }
            lines.push_back(fmt::format("{} {} {}\n", number, from, to));
        }
    }
    return lines;
}

/// Attribute of every set: the n of `boundary_n`, else the next free number.
template <int d>
std::map<std::string, int> number_sets(const iga::MultiPatch<d>& multipatch,
                                       std::vector<std::string>& notes) {
    std::map<std::string, int> result;
    std::set<int> taken;
    for (const auto& [name, set] : multipatch.boundary_sets) {
        constexpr std::string_view prefix = "boundary_";
        if (name.starts_with(prefix) && name.size() > prefix.size() && name.size() < 18 &&
            name[prefix.size()] != '0' &&
            name.find_first_not_of("0123456789", prefix.size()) == std::string::npos) {
            const int number = std::stoi(name.substr(prefix.size()));
            if (number <= max_count) {
                result[name] = number;
                taken.insert(number);
            }
        }
    }
    int next = 1;
    for (const auto& [name, set] : multipatch.boundary_sets) {
        if (result.count(name) == 0) {
            while (taken.count(next) > 0) {
                ++next;
            }
            result[name] = next;
            taken.insert(next);
            notes.push_back(
                fmt::format("MFEM knows numbers, not names: set '{}' is attribute {}", name, next));
        }
    }
    return result;
}

template <int d>
std::string boundary_lines(const iga::MultiPatch<d>& multipatch,
                           const std::vector<CornerVertices<d>>& elements,
                           std::vector<std::string>& notes) {
    const std::map<std::string, int> number_of_set = number_sets(multipatch, notes);
    std::map<iga::PatchEntity<d>, std::string> set_of_side;
    std::string lines;
    int n = 0;
    for (const auto& [name, sides] : multipatch.boundary_sets) {
        for (const iga::PatchEntity<d>& side : sides) {
            const auto [place, is_new] = set_of_side.emplace(side, name);
            if (!is_new) {
                refuse(fmt::format("{} is in the boundary sets '{}' and '{}'", side.name(),
                                   place->second, name));
            }
            lines += fmt::format("{} {}", number_of_set.at(name), d == 2 ? 1 : 3);
            for (const int corner : mfem_side_corners<d>(side.side())) {
                lines += fmt::format(" {}", elements[side.patch][corner]);
            }
            lines += "\n";
            ++n;
        }
    }
    return fmt::format("boundary\n{}\n{}\n", n, lines);
}

template <int d>
std::string patch_lines(const iga::Patch<d>& patch) {
    std::string text = fmt::format("knotvectors\n{}\n", d);
    for (int k = 0; k < d; ++k) {
        text += fmt::format("{} {}", patch.knots(k).degree(), patch.knots(k).n_basis());
        for (const double knot : patch.knots(k).knots()) {
            text += fmt::format(" {}", knot);
        }
        text += "\n";
    }
    text += fmt::format("\ndimension\n{}\n\ncontrolpoints_cartesian\n", patch.dimension());
    for (Eigen::Index i = 0; i < patch.control_points().rows(); ++i) {
        for (int k = 0; k < patch.dimension(); ++k) {
            text += exact(patch.control_points()(i, k)) + " ";
        }
        text += (patch.is_rational() ? exact(patch.weights()[i]) : "1") + "\n";
    }
    return text + "\n";
}

}  // namespace

template <int d>
std::string to_mfem_mesh(const iga::MultiPatch<d>& multipatch, std::vector<std::string>& notes) {
    if (multipatch.dimension() != d) {
        refuse("the multipatch holds surfaces in space");
    }
    expect_sides_only(multipatch, "MFEM NURBS mesh");
    int n_vertices = 0;
    const std::vector<CornerVertices<d>> elements = number_vertices(multipatch, n_vertices);
    check_vertices(multipatch, elements);
    std::string text =
        fmt::format("MFEM NURBS mesh v1.0\n\ndimension\n{}\n\nelements\n{}\n", d, elements.size());
    for (const CornerVertices<d>& element : elements) {
        text += fmt::format("1 {}", d == 2 ? 3 : 5);
        for (const int corner : mfem_corner_bits<d>) {
            text += fmt::format(" {}", element[corner]);
        }
        text += "\n";
    }
    text += fmt::format("\n{}", boundary_lines(multipatch, elements, notes));
    const std::vector<std::string> edges = edge_lines(multipatch, elements);
    text += fmt::format("edges\n{}\n{}\nvertices\n{}\n\npatches\n\n", edges.size(),
                        fmt::join(edges, ""), n_vertices);
    for (const iga::Patch<d>& patch : multipatch.patches) {
        text += patch_lines(patch);
    }
    return text;
}

template std::string to_mfem_mesh(const iga::MultiPatch<2>&, std::vector<std::string>&);
template std::string to_mfem_mesh(const iga::MultiPatch<3>&, std::vector<std::string>&);

}  // namespace couture::io
