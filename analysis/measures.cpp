#include "analysis/measures.h"

#include <limits>

namespace halfslope {
namespace {

template <double (*kMeasure)(const PointSet&)>
MeasuredValue exact(const PointSet& points) {
  const double value = kMeasure(points);
  return {value, value, value, "exact"};
}

}  // namespace

// The menu. To add a measure: a function of a PointSet in a file of its own, and a row here.
std::span<const MeasureInfo> measure_catalogue() {
  static const std::vector<MeasureInfo> catalogue = {
      {"star", "largest |share of the points - volume| over boxes anchored at the origin",
       "H. Niederreiter, \"Random Number Generation and Quasi-Monte Carlo Methods\", 1992, definition 2.1", 2,
       exact<star_discrepancy>},
      {"l2-star", "root of the mean of (share of the points - volume)^2 over boxes anchored at the origin",
       "T. T. Warnock, \"Computational investigations of low discrepancy point sets\", 1972",
       std::numeric_limits<std::size_t>::max(), exact<l2_star_discrepancy>},
  };
  return catalogue;
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measure_catalogue()) names.push_back(info.name);
  return names;
}

}  // namespace halfslope
