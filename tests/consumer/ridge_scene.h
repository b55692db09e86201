// A scene: |x − y| over the unit square, whose integral is 1/3. Without the exact value a reference would be rendered.
#pragma once

#include <cmath>
#include <memory>

#include "scenes/function_source.h"

inline std::unique_ptr<halfslope::IntegralSource> make_ridge(const std::string& name) {
  const auto ridge = [](std::span<const double> x, int /*pixel*/) { return std::fabs(x[0] - x[1]); };
  return std::make_unique<halfslope::FunctionSource>(name, 2, ridge, 1.0 / 3);
}
