#include "analysis/power.h"

#include <algorithm>
#include <cmath>

#include "analysis/moments.h"
#include "analysis/normal.h"

namespace halfslope {
namespace {

// `at` falls or rises with s throughout, so the range's ends are those of s.
template <class At>
Prediction over_range(const InfluenceSpread& spread, At at) {
  const double factor = std::exp(kNormal975 * spread.log_error);
  const double narrow = at(spread.deviation / factor), wide = at(spread.deviation * factor);
  return {at(spread.deviation), std::min(narrow, wide), std::max(narrow, wide)};
}

}  // namespace

InfluenceSpread influence_spread(std::span<const double> influences) {
  Moments moments;
  moments.add(influences);
  const double kurtosis = moments.m4() / (moments.m2() * moments.m2());
  return {std::sqrt(moments.variance()), 0.5 * std::sqrt((kurtosis - 1) / static_cast<double>(moments.count))};
}

Prediction predicted_power(const InfluenceSpread& spread, double difference, double critical, double replicates) {
  const auto power = [&](double deviation) {
    const double shift = std::abs(difference) * std::sqrt(replicates) / deviation;
    return normal_probability(shift - critical) + normal_probability(-shift - critical);
  };
  Prediction prediction = over_range(spread, power);
  // With v = log_error², log s is v too small on average, and a curved function of it off by half its second
  // difference.
  const double error = spread.log_error, deviation = spread.deviation * std::exp(error * error);
  const double value =
      2 * power(deviation) - (power(deviation * std::exp(error)) + power(deviation * std::exp(-error))) / 2;
  prediction.value = std::clamp(value, prediction.lo, prediction.hi);
  return prediction;
}

Prediction predicted_replicates(const InfluenceSpread& spread, double difference, double critical, double power) {
  const double shift = critical + normal_quantile(power);
  return over_range(spread, [&](double deviation) { return std::pow(shift * deviation / difference, 2); });
}

}  // namespace halfslope
