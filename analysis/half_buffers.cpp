#include "analysis/half_buffers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/compensated_sum.h"
#include "analysis/intervals.h"
#include "analysis/reference_noise.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr std::size_t kMostResampled = 4096;

std::optional<double> if_positive(double value) {
  return std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

}  // namespace

HalfBuffers compare_halves(std::span<const double> a, std::span<const double> b, std::size_t channels) {
  assert_equal(a.size(), b.size(), "integrals of a reference's halves");
  assert_equal(a.size() % channels, 0u, "integrals left over of whole pixels");
  if (a.empty()) return {};
  CompensatedSum squares, fourths;
  for (std::size_t first = 0; first < a.size(); first += channels) {
    double pixel = 0;
    for (std::size_t i = first; i < first + channels; ++i) pixel += 0.25 * (a[i] - b[i]) * (a[i] - b[i]);
    squares.add(pixel);
    fourths.add(pixel * pixel);
  }
  const auto integrals = static_cast<double>(a.size());
  return {squares.value() / integrals, 4.0 / 3 * fourths.value() / (integrals * integrals)};
}

double half_buffer_mse(std::span<const double> estimate, std::span<const double> a, std::span<const double> b) {
  assert_equal(a.size(), estimate.size(), "integrals of a reference's half");
  assert_equal(b.size(), estimate.size(), "integrals of a reference's half");
  CompensatedSum sum;
  for (std::size_t p = 0; p < estimate.size(); ++p) sum.add((estimate[p] - a[p]) * (estimate[p] - b[p]));
  return sum.value() / static_cast<double>(estimate.size());
}

HalfBufferMse half_buffer_interval(std::span<const double> replicates, const HalfBuffers& halves, std::uint64_t seed) {
  std::vector<double> against_whole;
  // (Î − W)² is never negative, but the sum of two roundings may be.
  for (const double value : replicates) against_whole.push_back(std::max(0.0, value + halves.mean_square));
  Moments moments, own;
  moments.add(std::span<const double>(against_whole));
  own.add(replicates);
  HalfBufferMse result = {replicates.empty() ? std::nan("") : own.mean, {}, {}};
  const std::optional<Interval> interval =
      against_whole.size() > kMostResampled ? log_mean_t(moments) : log_mean_bootstrap_t(against_whole, seed);
  if (!interval) return result;
  const Interval wide = widened_for_reference(*interval, moments.mean, halves.noise);
  result.lo = if_positive(std::exp(wide.lo) - halves.mean_square);
  result.hi = if_positive(std::exp(wide.hi) - halves.mean_square);
  return result;
}

}  // namespace halfslope
