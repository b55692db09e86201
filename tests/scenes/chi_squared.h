// Pearson's test of counts against the probabilities that a sampler states.
#pragma once

#include <gtest/gtest.h>

#include <boost/math/special_functions/gamma.hpp>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace halfslope {

/// Expects that `counts` are drawn with these probabilities, which sum to 1 (unless a bin of probability 0 was hit).
/// Bins expecting less than 8 are counted together. `false_alarm` is that of this one call.
inline void expect_distribution(std::span<const double> counts, std::span<const double> probabilities,
                                double false_alarm, const std::string& what) {
  double total = 0, sum = 0;
  for (const double c : counts) total += c;
  for (const double p : probabilities) sum += p;
  EXPECT_NEAR(sum, 1, 1e-6) << what;
  double statistic = 0, rare_count = 0, rare_expected = 0;
  int bins = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = total * probabilities[i];
    if (expected == 0) {
      EXPECT_EQ(counts[i], 0) << what << ", impossible bin " << i;
    }
    if (expected < 8) {
      rare_count += counts[i], rare_expected += expected;
      continue;
    }
    statistic += (counts[i] - expected) * (counts[i] - expected) / expected;
    ++bins;
  }
  if (rare_expected >= 8) {
    statistic += (rare_count - rare_expected) * (rare_count - rare_expected) / rare_expected;
    ++bins;
  }
  ASSERT_GT(bins, 1) << what;
  const double p_value = boost::math::gamma_q(0.5 * (bins - 1), 0.5 * statistic);
  EXPECT_GT(p_value, false_alarm) << what << ": chi-squared " << statistic << " of " << bins << " bins";
}

/// Independent coordinates as samplers give them: multiples of 2⁻²⁴ (float) or 2⁻⁵³ (double) in [0, 1).
template <class T>
class Coordinates {
 public:
  explicit Coordinates(std::uint64_t seed) : random_(seed) {}
  T operator()() {
    return sizeof(T) == 4 ? static_cast<T>(static_cast<double>(random_() >> 40) * 0x1p-24)
                          : static_cast<T>(static_cast<double>(random_() >> 11) * 0x1p-53);
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace halfslope
