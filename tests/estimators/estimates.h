// Estimates by name, and what chance allows of them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/estimator.h"
#include "estimators/pass_evaluator.h"
#include "samplers/catalogue.h"

namespace halfslope {

/// What an estimator is asked for.
struct Request {
  std::string estimator, sampler = "independent";
  std::uint64_t rounds = 1;  ///< points: N divided by the samples of a round
  int replicates = 64;       ///< a multiple of kLanes
  std::uint64_t seed = 1;
};

/// Estimates of one pixel by channel and replicate, without the pixel's constant part.
template <class T>
std::vector<std::vector<double>> estimate(const IntegralSource& source, int pixel, const Request& request) {
  const Estimator estimator = parse_estimator(request.estimator, source.techniques());
  PassEvaluator<T> evaluator(SamplerCatalogue::built_in().make(request.sampler), source.techniques(),
                             estimator.allocation, {estimator.heuristic}, {request.rounds}, source.channels());
  const PixelIntegral integral = source.pixel(pixel);
  std::vector<std::vector<double>> estimates(static_cast<std::size_t>(source.channels()));
  if (!integral.integral) {  // nothing but the constant part
    return {estimates.size(), std::vector<double>(static_cast<std::size_t>(request.replicates), 0.0)};
  }
  const StreamKey key = stream_key(request.seed, request.sampler, "test");
  for (int replicate = 0; replicate < request.replicates; replicate += kLanes) {
    evaluator.run(*integral.integral, key, static_cast<std::uint32_t>(pixel), static_cast<std::uint32_t>(replicate));
    for (std::size_t c = 0; c < estimates.size(); ++c) {
      const double* lanes = evaluator.estimates(0, 0, static_cast<int>(c));
      estimates[c].insert(estimates[c].end(), lanes, lanes + kLanes);
    }
  }
  return estimates;
}

struct MeanAndError {
  double mean, standard_error;
};

inline MeanAndError mean_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / count;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / (count - 1) / count)};
}

/// t⁻¹(1 − 5e-7) of Student's distribution with 63 degrees of freedom: a mean of 64 normal estimates is farther off by
/// chance with probability 1e-6.
inline constexpr double kStudent64 = 5.42003;

/// `slack` is for what is not chance: rounding, relative to `exact`.
inline void expect_mean(const std::vector<double>& values, double exact, double slack, const std::string& what) {
  ASSERT_EQ(values.size(), 64u);
  const MeanAndError found = mean_of(values);
  EXPECT_LE(std::fabs(found.mean - exact), kStudent64 * found.standard_error + slack * std::fabs(exact))
      << what << ": " << found.mean << " ± " << found.standard_error << " is not " << exact;
}

}  // namespace halfslope
