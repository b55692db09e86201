#include "analysis/bootstrap.h"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>

namespace halfslope {

void draw_resample(std::uint64_t seed, std::uint32_t resample, std::uint32_t count, std::span<std::uint32_t> indices) {
  using Philox = r123::Philox2x64_R<6>;
  const Philox::key_type key = {{seed}};
  const auto index = [count](std::uint64_t word) {
    return static_cast<std::uint32_t>(((word & 0xffffffff) * count) >> 32);
  };
  for (std::size_t i = 0; i < indices.size(); i += 4) {
    const auto words = Philox()({{i / 4, resample}}, key);
    const std::uint32_t four[] = {index(words[0]), index(words[0] >> 32), index(words[1]), index(words[1] >> 32)};
    if (i + 4 <= indices.size()) {
      std::copy_n(four, 4, indices.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      std::copy_n(four, indices.size() - i, indices.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
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
