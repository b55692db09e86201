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

/// By channel and replicate.
using Estimates = std::vector<std::vector<double>>;

/// Estimates of one pixel, without its constant part, by each of the estimators, which draw the same samples;
/// request.estimator is not read.
template <class T>
std::vector<Estimates> estimate_together(const IntegralSource& source, int pixel,
                                         const std::vector<std::string>& estimators, const Request& request,
                                         const EstimatorCatalogue& catalogue = EstimatorCatalogue::built_in()) {
  std::vector<Heuristic> heuristics;
  Allocation allocation;
  for (const std::string& name : estimators) {
    const Estimator estimator = catalogue.parse(name, source);
    EXPECT_TRUE(heuristics.empty() || estimator.allocation == allocation) << name;
    heuristics.push_back(estimator.heuristic);
    allocation = estimator.allocation;
  }
  PassEvaluator<T> evaluator(SamplerCatalogue::built_in().make(request.sampler), source.techniques(), allocation,
                             heuristics, {request.rounds}, source.channels());
  const PixelIntegral integral = source.pixel(pixel);
  std::vector<Estimates> estimates(heuristics.size(), Estimates(static_cast<std::size_t>(source.channels())));
  if (!integral.integral) {  // nothing but the constant part
    for (Estimates& of_one : estimates) {
      for (auto& channel : of_one) channel.assign(static_cast<std::size_t>(request.replicates), 0.0);
    }
    return estimates;
  }
  const StreamKey key = stream_key(request.seed, request.sampler, "test");
  for (int replicate = 0; replicate < request.replicates; replicate += kLanes) {
    evaluator.run(*integral.integral, key, static_cast<std::uint32_t>(pixel), static_cast<std::uint32_t>(replicate));
    for (std::size_t h = 0; h < estimates.size(); ++h) {
      for (std::size_t c = 0; c < estimates[h].size(); ++c) {
        const double* lanes = evaluator.estimates(h, 0, static_cast<int>(c));
        estimates[h][c].insert(estimates[h][c].end(), lanes, lanes + kLanes);
      }
    }
  }
  return estimates;
}

/// Estimates of one pixel, without its constant part.
template <class T>
Estimates estimate(const IntegralSource& source, int pixel, const Request& request) {
  return estimate_together<T>(source, pixel, {request.estimator}, request)[0];
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
