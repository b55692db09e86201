// What bootstrap-t intervals share: resamples, and quantiles of the studentised deviations.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/intervals.h"

namespace halfslope {

/// Fills `indices` with independent uniform ones of [0, count), for resample number `resample` of the bootstrap with
/// `seed`. Philox 2x64-6, the fewest rounds that its authors found to pass BigCrush; a 32-bit word w becomes ⌊w · count
/// / 2³²⌋, whose probabilities differ by count/2³² at most.
void draw_resample(std::uint64_t seed, std::uint32_t resample, std::uint32_t count, std::span<std::uint32_t> indices);

/// The resamples of a mean of n non-negative values, all in units of it: what every bootstrap of a mean begins with.
struct MeanBootstrap {
  struct Resample {
    double mean;  ///< m*/m
    double se;    ///< s*/(√n m), exactly 0 where all values of the resample are equal
  };
  Moments moments;                  ///< of the values themselves
  double se = 0;                    ///< s/(√n m), the standard error of log m
  std::vector<Resample> resamples;  ///< kBootstrapResamples
};

/// Empty below two values, and where all are equal or one is negative or not finite.
std::optional<MeanBootstrap> bootstrap_mean(std::span<const double> values, std::uint64_t seed);

/// estimate − widening · se · (upper and lower quantile of T*). `studentised` has the finite T* of kBootstrapResamples
/// resamples, in any order, and is sorted in part; the missing ones count as beyond both ends. Empty where they leave
/// no finite end.
std::optional<Interval> bootstrap_t_interval(double estimate, double se, double widening, std::span<double> studentised,
                                             double level);

}  // namespace halfslope
