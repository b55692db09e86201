#include "analysis/sample_variance.h"

#include <algorithm>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>

#include "analysis/normal.h"

namespace halfslope {
namespace {

enum class Tail { kLower, kUpper };

/// The value that a Pearson type III variable of mean 0, variance 1 and that skewness is beyond with probability p.
double standard_quantile(double skewness, double p, Tail tail) {
  if (skewness < 0) return -standard_quantile(-skewness, p, tail == Tail::kLower ? Tail::kUpper : Tail::kLower);
  constexpr double kNone = 1e-4;  // moves a quantile by some 1e-4 deviations, and shapes by 1e9
  if (skewness < kNone) return tail == Tail::kLower ? normal_quantile(p) : -normal_quantile(p);
  const double shape = 4 / (skewness * skewness);
  const boost::math::gamma_distribution<double> gamma(shape);
  const double x = tail == Tail::kLower ? quantile(gamma, p) : quantile(complement(gamma, p));
  return (x - shape) / std::sqrt(shape);
}

}  // namespace

SampleVarianceLaw sample_variance_law(const Cumulants& cumulants, std::int64_t replicates) {
  const auto n = static_cast<double>(replicates);
  const double m = n - 1, sigma = std::sqrt(cumulants[2]);
  const auto standardised = [&](int j) { return cumulants[static_cast<std::size_t>(j)] / std::pow(sigma, j); };
  const double l3 = standardised(3), l4 = standardised(4), l5 = standardised(5), l6 = standardised(6),
               l8 = standardised(8);
  const double c2 = l4 / n + 2 / m;
  const double c3 = l6 / (n * n) + 12 * l4 / (n * m) + 4 * (n - 2) * l3 * l3 / (n * m * m) + 8 / (m * m);
  const double c4 = l8 / (n * n * n) + 24 * l6 / (n * n * m) + 32 * (n - 2) * l5 * l3 / (n * n * m * m) +
                    8 * (4 * n * n - 9 * n + 6) * l4 * l4 / (n * n * m * m * m) + 144 * l4 / (n * m * m) +
                    96 * (n - 2) * l3 * l3 / (n * m * m * m) + 48 / (m * m * m);
  return {std::sqrt(c2), c3 / std::pow(c2, 1.5), c4 / (c2 * c2)};
}

bool has_sample_variance_range(const Cumulants& cumulants, std::int64_t replicates) {
  const double limit = static_cast<double>(replicates) / 40, skewness = cumulants.skewness();
  return cumulants[2] > 0 && cumulants.kurtosis() - 3 <= limit && skewness * skewness <= limit;
}

Interval sample_variance_range(const Cumulants& cumulants, std::int64_t replicates, double level) {
  const auto [deviation, skewness, excess] = sample_variance_law(cumulants, replicates);
  const double by_excess = std::sqrt(std::max(excess, 0.0) / 1.5), of_normal = 2 * deviation;
  const double upper = std::max({of_normal, skewness, by_excess});
  const double lower = skewness < 0 ? -std::max(-skewness, by_excess) : std::min(of_normal, skewness);
  const double p = (1 - level) / 4;
  return {1 + deviation * standard_quantile(lower, p, Tail::kLower),
          1 + deviation * standard_quantile(upper, p, Tail::kUpper)};
}

}  // namespace halfslope
