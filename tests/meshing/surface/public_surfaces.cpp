#include "tests/meshing/surface/public_surfaces.h"

#include <fstream>
#include <sstream>

#include "tests/meshing/surface/stl_samples.h"

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

namespace {

TriangleSoup read_obj(const std::filesystem::path& path) {
    std::ifstream file(path);
    TriangleSoup soup;
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            Vector3& point = soup.points.emplace_back();
            words >> point.x() >> point.y() >> point.z();
        } else if (word == "f") {
            // Numbers of points count from 1; those of texture and normal follow a slash.
            std::vector<int> corners;
            while (words >> word) corners.push_back(std::stoi(word) - 1);
            for (std::size_t k = 2; k < corners.size(); ++k) {
                soup.triangles.push_back({corners[0], corners[k - 1], corners[k]});
            }
        }
    }
    return soup;
}

}  // namespace

const std::vector<std::string>& public_surface_files() {
    static const std::vector<std::string> files = [] {
        std::vector<std::string> names{
            "fandisk.obj",         "mambo_B0.obj",          "oded_torus.obj",
            "openfoam_flange.stl", "openfoam_pipeWall.obj", "vampy_artery.stl",
            "vampy_vein.stl",      "vampy_ventricle.stl",   "wingnut.obj"};
        for (const PublicSurface& surface : public_surfaces()) names.push_back(surface.file);
        return names;
    }();
    return files;
}

TriangleSoup read_surface(const std::filesystem::path& path) {
    if (path.extension() == ".obj") return read_obj(path);
    return path.extension() == ".stl" ? read_stl(path) : read_off(path);
}

}  // namespace couture::meshing
