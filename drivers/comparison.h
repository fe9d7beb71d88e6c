#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/vtk_reader.h"

namespace couture::drivers {

/// What two results differ in, a line each. Numbers a and b differ if
/// |a - b| > tolerance max(|a|, |b|), times, volumes of memory and file names never.
[[nodiscard]] std::vector<std::string> compare_json(const nlohmann::json& first,
                                                    const nlohmann::json& second, double tolerance);

struct VtuComparison {
    /// Meshes, positions (relative to the box of both) and arrays (relative to the largest
    /// magnitude in both), each with its largest difference and where that is.
    std::vector<std::string> differences;
    /// What differs in where the files come from: program, deck, inputs.
    std::vector<std::string> provenance;
};

[[nodiscard]] VtuComparison compare_vtu(const io::VtuMesh& first, const io::VtuMesh& second,
                                        double tolerance);

}  // namespace couture::drivers
