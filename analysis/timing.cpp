#include "analysis/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "core/assertion.h"

namespace halfslope {
namespace {

/// P(B < k), B binomial with n tries at ½, 1 ≤ k ≤ n.
double binomial_below(std::size_t k, std::size_t n) {
  return boost::math::ibeta(static_cast<double>(n - k + 1), static_cast<double>(k), 0.5);
}

/// The largest k ≥ 1 whose interval has the level, or 1.
std::size_t rank_of(std::size_t n, double level) {
  std::size_t good = 1, bad = n / 2 + 1;
  while (bad - good > 1) {
    const std::size_t middle = (good + bad) / 2;
    (1 - 2 * binomial_below(middle, n) >= level ? good : bad) = middle;
  }
  return good;
}

std::optional<double> quadrature(const std::optional<double>& a, const std::optional<double>& b, double factor) {
  return a && b ? std::optional(std::hypot(factor * *a, *b)) : std::nullopt;
}

}  // namespace

std::optional<double> PositiveEstimate::log_below() const {
  return lo && *lo > 0 ? std::optional(std::log(value / *lo)) : std::nullopt;
}

std::optional<double> PositiveEstimate::log_above() const {
  return hi && std::isfinite(*hi) ? std::optional(std::log(*hi / value)) : std::nullopt;
}

MedianEstimate median_estimate(std::span<const double> values, double level) {
  assert_equal(values.empty(), false, "there is no value");
  assert_equal(std::ranges::all_of(values, [](double x) { return std::isfinite(x); }), true, "all values are finite");
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const std::size_t n = sorted.size(), k = rank_of(n, level);
  return {(sorted[(n - 1) / 2] + sorted[n / 2]) / 2,
          {sorted[k - 1], sorted[n - k]},
          std::max(0.0, 1 - 2 * binomial_below(k, n))};
}

PositiveEstimate efficiency(const PositiveEstimate& rmse, const PositiveEstimate& seconds) {
  PositiveEstimate result = {1 / (rmse.value * rmse.value * seconds.value)};
  // What is dear is inefficient: the upper ends of error and time give the lower one here.
  if (const auto below = quadrature(rmse.log_above(), seconds.log_above(), 2))
    result.lo = result.value * std::exp(-*below);
  if (const auto above = quadrature(rmse.log_below(), seconds.log_below(), 2))
    result.hi = result.value * std::exp(*above);
  return result;
}

std::string Places::text() const {
  return first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last);
}

std::vector<std::optional<Places>> places(std::span<const PositiveEstimate> estimates, bool larger_is_better) {
  const auto ranked = [](const PositiveEstimate& e) { return e.lo && e.hi; };
  const auto better = [&](const PositiveEstimate& a, const PositiveEstimate& b) {
    return larger_is_better ? *a.lo > *b.hi : *a.hi < *b.lo;
  };
  const auto total = static_cast<std::size_t>(std::ranges::count_if(estimates, ranked));
  std::vector<std::optional<Places>> result;
  for (const PositiveEstimate& mine : estimates) {
    result.emplace_back();
    if (!ranked(mine)) continue;
    Places& place = result.back().emplace(Places{1, total});
    for (const PositiveEstimate& other : estimates) {
      if (!ranked(other)) continue;
      place.first += better(other, mine) ? 1 : 0;
      place.last -= better(mine, other) ? 1 : 0;
    }
  }
  return result;
}

}  // namespace halfslope
