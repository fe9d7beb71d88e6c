#include "tests/meshing/surface/stl_samples.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

namespace couture::meshing {

namespace {

std::vector<Vector3> read_corners(const std::string& content) {
    std::vector<Vector3> corners;
    std::uint32_t n = 0;
    if (content.size() >= 84) std::memcpy(&n, content.data() + 80, 4);
    if (content.size() == 84 + 50 * static_cast<std::size_t>(n)) {
        for (std::size_t i = 0; i < n; ++i) {
            float values[9];
            std::memcpy(values, content.data() + 84 + 50 * i + 12, sizeof(values));
            for (int k = 0; k < 3; ++k) {
                corners.emplace_back(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
            }
        }
        return corners;
    }
    std::istringstream text(content);
    std::string word;
    while (text >> word) {
        if (word != "vertex") continue;
        Vector3& corner = corners.emplace_back();
        text >> corner.x() >> corner.y() >> corner.z();
    }
    return corners;
}

}  // namespace

TriangleSoup read_stl(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(file), {}};
    const std::vector<Vector3> corners = read_corners(content);
    TriangleSoup soup;
    std::map<std::array<double, 3>, int> number;
    std::vector<int> vertices;
    for (const Vector3& corner : corners) {
        const auto [entry, is_new] = number.try_emplace({corner.x(), corner.y(), corner.z()},
                                                        static_cast<int>(number.size()));
        if (is_new) soup.points.push_back(corner);
        vertices.push_back(entry->second);
    }
    for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) {
        soup.triangles.push_back({vertices[i], vertices[i + 1], vertices[i + 2]});
    }
    return soup;
}

}  // namespace couture::meshing
