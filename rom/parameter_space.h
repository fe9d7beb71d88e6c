#pragma once

#include <string>
#include <vector>

#include "iga/core/types.h"

namespace couture::rom {

/// What a parameter changes: the shape, the loads or the materials.
enum class ParameterGroup { geometry, load, material };

struct Parameter {
    std::string name;
    ParameterGroup group = ParameterGroup::geometry;
    /// For tables, e.g. "mm"; empty without one.
    std::string unit;
    double lower = 0.0;
    double upper = 1.0;
    /// Both ends of the range are one state; of the shape only.
    bool is_periodic = false;
};

/// The box in which a reduced model learns; models see it as the unit cube.
///
/// Source: [Maquart19] Sec. 7.2.1, Eq. (7.4).
class ParameterSpace {
  public:
    /// @throws InputError  without parameters, for two of one name, for a range that is empty or
    ///                     not finite, for a periodic load or material
    explicit ParameterSpace(std::vector<Parameter> parameters);

    [[nodiscard]] int size() const { return static_cast<int>(parameters_.size()); }
    [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }
    /// @throws InputError  for a name that there is not; suggests the nearest
    [[nodiscard]] int index_of(const std::string& name) const;
    /// Positions of a group's parameters, in their order.
    [[nodiscard]] std::vector<int> group(ParameterGroup group) const;

    /// The point in the middle of all ranges (the hypercentre), in the parameters' units.
    [[nodiscard]] VectorX centre() const;
    /// Ranges to [0, 1], also outside of them. @param point  size() values
    [[nodiscard]] VectorX to_unit(const VectorX& point) const;
    [[nodiscard]] VectorX from_unit(const VectorX& unit_point) const;
    /// By how much of its range the worst parameter is outside of it; 0 inside, and for periodic
    /// ones.
    [[nodiscard]] double distance_outside(const VectorX& point) const;

  private:
    std::vector<Parameter> parameters_;
    VectorX lower_;
    VectorX extent_;
};

}  // namespace couture::rom
