#include "analysis/reference_noise.h"

#include <cmath>

#include "analysis/compensated_sum.h"
#include "analysis/normal.h"
#include "core/assertion.h"

namespace halfslope {

double mean_square_noise(std::span<const double> variances, std::size_t channels, std::span<const double> weights) {
  if (!weights.empty()) assert_equal(weights.size(), variances.size(), "weights of integrals");
  assert_equal(variances.size() % channels, 0u, "integrals left over of whole pixels");
  if (variances.empty()) return 0;
  CompensatedSum sum;
  for (std::size_t first = 0; first < variances.size(); first += channels) {
    double pixel = 0;
    for (std::size_t i = first; i < first + channels; ++i) pixel += (weights.empty() ? 1.0 : weights[i]) * variances[i];
    sum.add(pixel * pixel);
  }
  const auto integrals = static_cast<double>(variances.size());
  return 2 * sum.value() / (integrals * integrals);
}

Interval widened_for_reference(Interval log_interval, double mean, double noise) {
  if (!(noise > 0)) return log_interval;
  const double centre = std::log(mean), reach = kNormal975 * std::sqrt(noise) / mean;
  return {centre - std::hypot(centre - log_interval.lo, reach), centre + std::hypot(log_interval.hi - centre, reach)};
}

CorrectedMean corrected_mean(double mean, const std::optional<Interval>& log_interval, const ReferencePart& part) {
  const auto corrected = [&](double measured) {
    const double rest = measured - part.mean;
    return std::isfinite(rest) && rest > 0 ? std::optional(rest) : std::nullopt;
  };
  CorrectedMean result{corrected(mean), {}, {}};
  if (!result.value || !log_interval) return result;
  const auto end_at = [&](double log_end) {
    const std::optional<double> end = corrected(std::exp(log_end));
    const bool known = end && std::fabs(std::log(*end / *result.value)) <= 2 * std::log(kFarthestEnd);
    return known ? end : std::nullopt;
  };
  const Interval wide = widened_for_reference(*log_interval, mean, part.noise);
  result.lo = end_at(wide.lo);
  result.hi = end_at(wide.hi);
  return result;
}

CorrectedMean rooted(const CorrectedMean& square) {
  const auto root = [](const std::optional<double>& x) { return x ? std::optional(std::sqrt(*x)) : std::nullopt; };
  return {root(square.value), root(square.lo), root(square.hi)};
}

}  // namespace halfslope
