#pragma once

#include <memory>
#include <string>
#include <vector>

#include "iga/core/function.h"

namespace couture::io {

/// An expression of x, y, z and t with the usual functions (sin, cos, tan, asin, acos, atan,
/// atan2, exp, log (natural), log10, sqrt, abs, min, max, sign, rint), the constants pi and e,
/// powers (x^2), comparisons and conditions (x > 1 ? 2 : 3). Its value may be asked for on several
/// threads at once.
class Expression {
  public:
    /// @throws InputError  for what can't be read: shows the text with a caret below the place
    explicit Expression(const std::string& text);

    [[nodiscard]] const std::string& text() const;
    /// Which of x, y, z, t it depends on.
    [[nodiscard]] const std::vector<std::string>& variables() const { return variables_; }
    /// @throws InputError  if the value is not finite there: names the expression and the place
    [[nodiscard]] double operator()(const Vector3& x, double t) const;

  private:
    struct Source;
    std::shared_ptr<const Source> source_;
    std::vector<std::string> variables_;
};

}  // namespace couture::io
