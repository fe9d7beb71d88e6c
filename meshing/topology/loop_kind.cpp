#include "meshing/topology/loop_kind.h"

#include <algorithm>

namespace couture::meshing {

bool is_of_kind(const std::vector<int>& homology_class, const IntegerMatrix& projector,
                LoopKind kind) {
    const std::vector<long long> row(homology_class.begin(), homology_class.end());
    const auto image = multiply(row, projector);
    return kind == LoopKind::tunnel
               ? image == row
               : std::all_of(image.begin(), image.end(), [](long long x) { return x == 0; });
}

IntegerMatrix classes_of_kind(const IntegerMatrix& projector, LoopKind kind) {
    IntegerMatrix matrix = projector;
    if (kind == LoopKind::tunnel) {
        for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i][i] -= 1;
    }
    return left_kernel(matrix);
}

}  // namespace couture::meshing
