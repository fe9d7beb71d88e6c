#include "tests/meshing/topology/part_members.h"

#include "meshing/parts/part_landmarks.h"
#include "meshing/surface/caps.h"
#include "meshing/topology/invariants.h"

namespace couture::testing {

using namespace meshing;

Member make_member(const std::string& part, const std::map<std::string, double>& parameters,
                   double edge_length, bool is_open) {
    const PartSurface surface = make_part_surface(part, parameters, edge_length);
    Member member;
    member.landmarks = part_landmarks(surface);
    member.mesh = make_surface_mesh(surface.soup);
    if (!is_open) return member;
    const Features features = detect_features(member.mesh);
    std::vector<Cap> caps;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        if (!surface.faces[f].is_cap) continue;
        for (std::size_t t = 0; t < surface.face_of_triangle.size(); ++t) {
            if (surface.face_of_triangle[t] != static_cast<int>(f)) continue;
            const FaceHandle face(static_cast<int>(t));
            caps.push_back({surface.faces[f].name, member.mesh.data(face).region});
            break;
        }
    }
    const OpenedSurface opened = open_caps(member.mesh, features, caps);
    member.mesh = make_surface_mesh(opened.soup);
    for (const BoundaryLoop& loop : boundary_loops(member.mesh)) {
        const int cap = opened.cap_of_vertex[loop.vertices.front().idx()];
        member.boundary_names.push_back(cap >= 0 ? caps[cap].name : std::string());
    }
    return member;
}

}  // namespace couture::testing
