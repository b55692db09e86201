#include "analysis/bootstrap.h"

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace halfslope {

void draw_resample(std::uint64_t seed, std::uint32_t resample, std::uint32_t count, std::span<std::uint32_t> indices) {
  using Philox = r123::Philox2x64_R<6>;
  const Philox::key_type key = {{seed}};
  const auto index = [count](std::uint64_t word) {
    return static_cast<std::uint32_t>(((word & 0xffffffff) * count) >> 32);
  };
  const auto four_at = [&](std::size_t i) {
    const auto words = Philox()({{i / 4, resample}}, key);
    return std::array{index(words[0]), index(words[0] >> 32), index(words[1]), index(words[1] >> 32)};
  };
  std::size_t i = 0;
  for (; i + 4 <= indices.size(); i += 4) {
    const auto four = four_at(i);
    for (std::size_t k = 0; k < 4; ++k) indices[i + k] = four[k];
  }
  if (i < indices.size())
    std::ranges::copy_n(four_at(i).begin(), std::ssize(indices.subspan(i)),
                        indices.begin() + static_cast<std::ptrdiff_t>(i));
}

namespace {

/// Its sums are about the resample's first value, so that equal values give exact zeros.
MeanBootstrap::Resample resample_of(std::span<const double> values, std::span<const std::uint32_t> indices) {
  const double shift = values[indices[0]], n = static_cast<double>(indices.size());
  std::array<double, 4> sums{}, squares{};  // four chains: one would wait for each addition to finish
  const auto add = [&](std::size_t lane, std::size_t i) {
    const double d = values[indices[i]] - shift;
    sums[lane] += d;
    squares[lane] += d * d;
  };
  std::size_t i = 0;
  for (; i + 4 <= indices.size(); i += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) add(lane, i + lane);
  }
  for (; i < indices.size(); ++i) add(0, i);
  const double sum = (sums[0] + sums[1]) + (sums[2] + sums[3]),
               square = (squares[0] + squares[1]) + (squares[2] + squares[3]);
  return {shift + sum / n, square > 0 ? std::sqrt((square - sum * sum / n) / (n * (n - 1))) : 0.0};
}

}  // namespace

std::optional<MeanBootstrap> bootstrap_mean(std::span<const double> values, std::uint64_t seed) {
  const auto usable = [](double value) { return std::isfinite(value) && value >= 0; };
  if (values.size() < 2 || !std::ranges::all_of(values, usable)) return std::nullopt;
  MeanBootstrap result;
  result.moments.add(values);
  result.se = result.moments.standard_error() / result.moments.mean;
  if (!(result.moments.mean > 0) || !std::isfinite(result.se) || result.se <= 0) return std::nullopt;
  std::vector<double> relative(values.begin(), values.end());  // the errors of one cell may be 1e-12, of another 1e9
  for (double& value : relative) value /= result.moments.mean;
  std::vector<std::uint32_t> indices(values.size());
  for (std::uint32_t resample = 0; resample < kBootstrapResamples; ++resample) {
    draw_resample(seed, resample, static_cast<std::uint32_t>(values.size()), indices);
    result.resamples.push_back(resample_of(relative, indices));
  }
  return result;
}

std::optional<Interval> bootstrap_t_interval(double estimate, double se, double widening, std::span<double> studentised,
                                             double level) {
  const auto missing = kBootstrapResamples - static_cast<std::ptrdiff_t>(studentised.size());
  const auto tail = static_cast<std::ptrdiff_t>(std::lround((kBootstrapResamples + 1) * (1 - level) / 2));
  const std::ptrdiff_t rank = tail - missing;  // from 1
  if (rank < 1) return std::nullopt;
  const auto at_rank = [&](std::ptrdiff_t k) {
    std::nth_element(studentised.begin(), studentised.begin() + (k - 1), studentised.end());
    return studentised[static_cast<std::size_t>(k - 1)];
  };
  const double lower = at_rank(rank), upper = at_rank(std::ssize(studentised) + 1 - rank);
  return Interval{estimate - widening * se * upper, estimate - widening * se * lower};
}

}  // namespace halfslope
