#include "tests/meshing/surface/public_surfaces.h"

#include <fstream>

namespace couture::meshing {

const std::vector<PublicSurface>& public_surfaces() {
    static const std::vector<PublicSurface> surfaces{
        {"eight.off", 5544, 2, 0, -2, 0},         {"hexgen_hepta.off", 509, 0, 0, 2, 242},
        {"hexgen_joint.off", 3806, 1, 0, 0, 843}, {"hexgen_mount1.off", 724, 4, 0, -6, 429},
        {"hexgen_rod.off", 2238, 2, 0, -2, 290},  {"igl_3holes.off", 3596, 3, 0, -4, 34},
        {"igl_halftunnel.off", 831, 0, 3, -1, 0}, {"mambo_S3.off", 3593, 2, 0, -2, 360},
        {"vampy_atrium.off", 10516, 0, 5, -3, 0},
    };
    return surfaces;
}

TriangleSoup read_off(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string word;
    int n_points = 0;
    int n_faces = 0;
    int n_edges = 0;
    file >> word >> n_points >> n_faces >> n_edges;
    TriangleSoup soup;
    for (int i = 0; i < n_points; ++i) {
        Vector3& point = soup.points.emplace_back();
        file >> point.x() >> point.y() >> point.z();
    }
    for (int i = 0; i < n_faces; ++i) {
        int n = 0;
        file >> n;
        std::vector<int> corners(n);
        for (int& corner : corners) file >> corner;
        for (int k = 2; k < n; ++k) {
            soup.triangles.push_back({corners[0], corners[k - 1], corners[k]});
        }
    }
    return soup;
}

}  // namespace couture::meshing
