// The measures of a point set there are, by name.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/discrepancy.h"

namespace halfslope {

/// What a measure says of points: its value, and what it lies between where it cannot be known exactly; all three are
/// the same where `method` is "exact".
struct MeasuredValue {
  double value = 0, lower = 0, upper = 0;
  std::string_view method;
};

struct MeasureInfo {
  std::string name, description, reference;
  std::size_t max_dims;  ///< of the points it takes
  MeasuredValue (*measure)(const PointSet& points);
};

/// Every measure, in the order of the tables.
std::span<const MeasureInfo> measure_catalogue();

/// Their names, in that order.
std::vector<std::string> measure_names();

}  // namespace halfslope
