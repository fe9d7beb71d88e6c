#include "meshing/layout/polycube_templates.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

enum Side { x_low, x_high, y_low, y_high };

constexpr std::array<const char*, 6> side_names{"x_low",  "x_high", "y_low",
                                                "y_high", "z_low",  "z_high"};

GridCell corner_of(const GridCell& cell, int corner) {
    return {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
}

bool holds(const std::vector<SectionCell>& section, const SectionCell& cell) {
    return std::ranges::find(section, cell) != section.end();
}

void check_chain(const std::string& name, const std::vector<SectionCell>& section,
                 const std::vector<SectionCell>& chain) {
    if (chain.empty()) throw InputError("template '{}': a branch stands on no cell", name);
    for (std::size_t i = 0; i < chain.size(); ++i) {
        const auto& [y, z] = chain[i];
        if (!holds(section, chain[i])) {
            throw InputError(
                "template '{}': a branch stands on cell [{}, {}], which the section "
                "has not",
                name, y, z);
        }
        if (i > 0 && chain[i] != SectionCell{chain[i - 1][0], chain[i - 1][1] + 1}) {
            throw InputError(
                "template '{}': cells [{}, {}] and [{}, {}] of a branch don't follow "
                "each other; a chain goes straight towards +z",
                name, chain[i - 1][0], chain[i - 1][1], y, z);
        }
        for (int dz = -1; dz <= 1; ++dz) {
            for (int dy = 1; dy <= 2; ++dy) {
                if (holds(section, {y + dy, z + dz})) {
                    throw InputError(
                        "template '{}': the branch on cell [{}, {}] touches cell "
                        "[{}, {}] of the section; beside a branch there must be room",
                        name, y, z, y + dy, z + dz);
                }
            }
        }
    }
}

}  // namespace

CuboidTemplate make_polycube_template(std::string name, const std::vector<GridCell>& cells,
                                      const std::vector<PolycubeCap>& caps) {
    CuboidTemplate shape;
    shape.name = std::move(name);
    std::map<GridCell, int> node_at;
    std::set<GridCell> different;
    for (const GridCell& cell : cells) {
        if (!different.insert(cell).second) {
            throw InputError("template '{}': cell [{}] is there twice", shape.name,
                             fmt::join(cell, ", "));
        }
        for (int i = 0; i < 8; ++i) node_at[corner_of(cell, i)] = 0;
    }
    for (auto& [place, number] : node_at) {
        number = shape.layout.n_nodes++;
        shape.positions.emplace_back(place[0], place[1], place[2]);
    }
    for (const GridCell& cell : cells) {
        auto& nodes = shape.layout.cuboids.emplace_back();
        for (int i = 0; i < 8; ++i) nodes[i] = node_at.at(corner_of(cell, i));
    }
    for (const PolycubeCap& cap : caps) {
        shape.caps.push_back(cap.name);
        shape.layout.sets[cap.name] = cap.sides;
    }
    check_template(shape);
    return shape;
}

CuboidTemplate make_disc_template(std::string name, const std::vector<SectionCell>& section) {
    std::vector<GridCell> cells;
    PolycubeCap cap{side_names[x_low], {}};
    for (const auto& [y, z] : section) {
        cap.sides.push_back({static_cast<int>(cells.size()), x_low});
        cells.push_back({0, y, z});
    }
    return make_polycube_template(std::move(name), cells, {cap});
}

CuboidTemplate make_bar_template(std::string name, const std::vector<SectionCell>& section,
                                 const std::vector<std::vector<SectionCell>>& branches) {
    std::vector<GridCell> cells;
    std::vector<PolycubeCap> caps{{side_names[x_low], {}}, {side_names[x_high], {}}};
    const int n_branches = static_cast<int>(branches.size());
    for (int x = 0; x <= 2 * n_branches; ++x) {
        for (const auto& [y, z] : section) {
            const int number = static_cast<int>(cells.size());
            if (x == 0) caps[0].sides.push_back({number, x_low});
            if (x == 2 * n_branches) caps[1].sides.push_back({number, x_high});
            cells.push_back({x, y, z});
        }
    }
    for (int i = 0; i < n_branches; ++i) {
        check_chain(name, section, branches[i]);
        auto& cap = caps.emplace_back();
        cap.name = n_branches == 1 ? "branch" : fmt::format("branch_{}", i + 1);
        for (const auto& [y, z] : branches[i]) {
            cap.sides.push_back({static_cast<int>(cells.size()), y_high});
            cells.push_back({2 * i + 1, y + 1, z});
        }
    }
    return make_polycube_template(std::move(name), cells, caps);
}

CuboidTemplate make_ring_template(std::string name, const std::vector<SectionCell>& section,
                                  int n_corners) {
    if (n_corners < 3) {
        throw InputError("template '{}': a ring has 3 corners or more, not {}", name, n_corners);
    }
    std::vector<GridCell> cells;
    std::vector<PolycubeCap> caps{{side_names[x_low], {}}, {side_names[x_high], {}}};
    for (int x = 0; x <= n_corners; ++x) {
        for (const auto& [y, z] : section) {
            const int number = static_cast<int>(cells.size());
            if (x == 0) caps[0].sides.push_back({number, x_low});
            if (x == n_corners) caps[1].sides.push_back({number, x_high});
            cells.push_back({x, y, z});
        }
    }
    CuboidTemplate shape = make_polycube_template(std::move(name), cells, caps);
    const auto [least, most] =
        std::ranges::minmax(shape.positions, {}, [](const Vector3& place) { return place.y(); });
    const double hole = most.y() - least.y();
    const double step = 2.0 * std::numbers::pi / n_corners;
    for (Vector3& place : shape.positions) {
        const double radius = hole + most.y() - place.y();
        const bool is_cut = place.x() < 0.5 || place.x() > n_corners + 0.5;
        const double angle = is_cut ? 0.0 : (place.x() - 0.5) * step;
        const double distance = is_cut ? radius : radius / std::cos(0.5 * step);
        place = {distance * std::cos(angle), distance * std::sin(angle), place.z()};
    }
    check_template(shape);
    return shape;
}

CuboidTemplate make_star_template(std::string name, int n_legs) {
    if (n_legs < 3 || n_legs > 6) {
        throw InputError("template '{}': a star has 3 to 6 legs, not {}", name, n_legs);
    }
    std::vector<GridCell> cells{{0, 0, 0}};
    std::vector<PolycubeCap> caps;
    for (int side = 0; side < n_legs; ++side) {
        GridCell leg{0, 0, 0};
        leg[side / 2] = side % 2 == 0 ? -1 : 1;
        cells.push_back(leg);
        caps.push_back({side_names[side], {{side + 1, side}}});
    }
    return make_polycube_template(std::move(name), cells, caps);
}

}  // namespace couture::meshing
