#pragma once

#include <string>

namespace couture::drivers {

/// A table of the times of two benchmarks, row by row, with their ratios: rows of the same section
/// that agree in all that is not measured.
///
/// @param json, earlier  texts of `bench_json`
/// @param path  of the earlier one, for messages
/// @throws InputError  if the earlier text is not of a benchmark
[[nodiscard]] std::string compare_benchmarks(const std::string& json, const std::string& earlier,
                                             const std::string& path);

}  // namespace couture::drivers
