// Runs measured against a reference that errs, simulated.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "analysis/cell_statistics.h"
#include "analysis/half_buffers.h"
#include "analysis/reference_noise.h"

namespace halfslope {

/// The share of runs whose interval held the true mean squared error.
struct NoisyCoverage {
  double rmse = 0;         ///< as summarise gives it
  double not_widened = 0;  ///< as summarise gives it where the reference has no noise; of replicates not kept
  double halves = 0;       ///< half_buffer_interval
};

/// Errors of every pixel and replicate are normal with variance 1 about the truth 0, and so are the 16 replicates of
/// each pixel of the reference, whose mean has the variance `share`; what is known of it is estimated from them. Where
/// replicates are not `kept`, the intervals of summarise are Student's t on log M, without bootstrap; `halves` is then
/// 0.
inline NoisyCoverage noisy_coverage(std::size_t pixels, std::int64_t replicates, double share, bool kept, int runs,
                                    std::uint64_t seed) {
  constexpr std::size_t kReplicates = 16;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  NoisyCoverage covered;
  for (int run = 0; run < runs; ++run) {
    std::vector<double> value(pixels), variance(pixels), a(pixels), b(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
      Moments all, half;
      for (std::size_t i = 0; i < kReplicates; ++i) {
        all.add(normal(random) * std::sqrt(share * kReplicates));
        if (i + 1 == kReplicates / 2) half = all;
      }
      value[p] = all.mean, variance[p] = all.variance() / kReplicates;
      a[p] = half.mean, b[p] = 2 * all.mean - half.mean;
    }
    CellData data;
    data.replicates = replicates;
    data.integrals = static_cast<std::int64_t>(pixels);
    data.bootstrap_seed = seed + static_cast<std::uint64_t>(run);
    data.mae = 1;  // of no account here, but of an exact cell it would be 0
    for (const double v : variance) data.reference_mse += v / static_cast<double>(pixels);
    data.reference_mse_noise = mean_square_noise(variance, 1);
    std::vector<double> products, estimate(pixels);
    for (std::int64_t i = 0; i < replicates; ++i) {
      ReplicateErrors errors;
      for (std::size_t p = 0; p < pixels; ++p) {
        estimate[p] = normal(random);
        errors.mse += (estimate[p] - value[p]) * (estimate[p] - value[p]) / static_cast<double>(pixels);
      }
      data.mse.add(errors.mse);
      if (!kept) continue;
      data.per_replicate.push_back(errors);
      products.push_back(half_buffer_mse(estimate, a, b));
    }
    const auto holds = [](std::optional<double> lo, std::optional<double> hi) {
      return hi && *hi >= 1 && (!lo || *lo <= 1) ? 1.0 : 0.0;
    };
    const CellStatistics row = summarise(data);
    covered.rmse += holds(row.rmse_lo, row.rmse_hi) / runs;
    if (kept) {
      const HalfBufferMse halves = half_buffer_interval(products, compare_halves(a, b, 1), data.bootstrap_seed);
      covered.halves += holds(halves.lo, halves.hi) / runs;
    } else {
      data.reference_mse_noise = 0;
      const CellStatistics narrow = summarise(data);
      covered.not_widened += holds(narrow.rmse_lo, narrow.rmse_hi) / runs;
    }
  }
  return covered;
}

}  // namespace halfslope
