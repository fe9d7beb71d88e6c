#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/polycube_templates.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/caps.h"
#include "meshing/surface/features.h"
#include "meshing/topology/invariants.h"
#include "meshing/topology/pants.h"

namespace couture::meshing {

inline TemplateLibrary some_templates() {
    TemplateLibrary library;
    const std::vector<SectionCell> quad{{0, 0}};
    const std::vector<SectionCell> column{{0, 0}, {0, 1}, {0, 2}};
    // A rim with a flange half way up.
    const std::vector<SectionCell> rim{{0, 0}, {0, 1}, {0, 2}, {1, 1}};
    // A hub of three cells with a boss that is higher by one on both sides.
    const std::vector<SectionCell> hub{{0, -1}, {0, 0}, {0, 1}, {0, 2},
                                       {0, 3},  {1, 0}, {1, 1}, {1, 2}};
    const std::vector<SectionCell> angle{{0, 0}, {0, 1}, {1, 0}};
    library.add(make_bar_template("tube", quad, {}));
    library.add(make_bar_template("tee", quad, {quad}));
    library.add(make_bar_template("tee_in_column", column, {{{0, 1}}}));
    library.add(make_bar_template("rim", rim, {{{1, 1}}}));
    library.add(make_bar_template("hub", hub, {{{1, 1}}}));
    library.add(make_bar_template("angle", angle, {{{1, 0}}}));
    return library;
}

struct Job {
    SurfaceMesh opened;
    Features features;
    PantsDecomposition pants;
    ClosingCaps caps;
};

// Around both spokes of the wheel.
inline std::vector<GuideLoop> wheel_loops() {
    std::vector<GuideLoop> loops;
    for (const double side : {1.0, -1.0}) {
        GuideLoop& loop = loops.emplace_back();
        const std::vector<std::array<double, 3>> points{
            {40.0, 20.71875, 0.0},  {31.8, 31.8, 4.46875},  {0.0, 45.0, 4.46875},
            {-31.8, 31.8, 4.46875}, {-40.0, 20.71875, 0.0}, {-31.8, 31.8, -4.46875},
            {0.0, 45.0, -4.46875},  {31.8, 31.8, -4.46875}};
        for (const auto& [x, y, z] : points) loop.points.emplace_back(x, side * y, z);
    }
    return loops;
}

// Around the walls of the casting between its bore and its bolt holes.
inline std::vector<GuideLoop> casting_loops() {
    const std::vector<std::array<double, 2>> section{
        {30.0, 0.0},  {60.0, 0.0},   {68.5, 10.0},  {60.0, 20.0},  {45.0, 20.0},
        {37.5, 50.0}, {37.5, 100.0}, {30.0, 150.0}, {22.5, 100.0}, {22.5, 50.0}};
    std::vector<GuideLoop> loops;
    for (const auto& [x, y] :
         std::vector<std::array<double, 2>>{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
        GuideLoop& loop = loops.emplace_back();
        for (const auto& [r, z] : section) loop.points.emplace_back(r * x, r * y, z);
    }
    return loops;
}

// A part, opened at its caps and cut into pants.
// @param sharp    above 0: cuts run along sharp edges, below: across them
// @param through  points of cuts, see PantsOptions::cycles_through
inline Job cut_part(const std::string& name, const std::vector<GuideLoop>& loops = {},
                    double sharp = -0.75, const std::vector<std::vector<Vector3>>& through = {}) {
    const PartSurface part = make_part_surface(name);
    SurfaceMesh closed = make_surface_mesh(part.soup);
    const Features features = detect_features(closed);
    std::vector<Cap> caps;
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        if (!part.faces[f].is_cap) continue;
        const auto triangle = std::ranges::find(part.face_of_triangle, static_cast<int>(f)) -
                              part.face_of_triangle.begin();
        caps.push_back(
            {part.faces[f].name, closed.data(FaceHandle(static_cast<int>(triangle))).region});
    }
    Job job;
    const OpenedSurface opened = open_caps(closed, features, caps);
    job.opened = make_surface_mesh(opened.soup);
    job.caps = caps_of(closed, opened);
    job.features = detect_features(job.opened);
    PantsOptions named;
    named.cycle.sharp = sharp;
    named.merge.sharp = sharp > 0.0 ? sharp : 0.0;
    named.loops = loops;
    named.cycles_through = through;
    for (const BoundaryLoop& loop : boundary_loops(job.opened)) {
        named.boundary_names.push_back(caps[opened.cap_of_vertex[loop.vertices[0].idx()]].name);
    }
    job.pants = decompose_into_pants(job.opened, named);
    return job;
}

}  // namespace couture::meshing
