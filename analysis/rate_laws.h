// Lines of errors whose rate is known: what fits of rates are tried on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/rates.h"
#include "analysis/run_random.h"

namespace halfslope {

/// Errors of R replicates at N = 16, 32, …, with a reference of which the data says what there is to know.
struct RateLaw {
  std::string name;
  double rate;
  std::function<RateData(std::int64_t replicates, RunRandom& random)> draw;
};

/// Running means of independent normal numbers, in images of so many pixels that each walk alone; to N = 1024. The
/// reference has the variance of a walk of `reference_times` 1024 numbers; 0: it is exact.
RateLaw walks(std::int64_t pixels = 1, double reference_times = 0);

/// What nested scrambling of a net does to a smooth integrand: RMSE = N^−1.5, to N = 1024; normal numbers, correlated
/// 0.6 between neighbouring N, times a scale that is `large` in a fifth of the cases, else what makes its mean square 1
/// (1 ≤ large < √5; kurtosis 5 at 1.65, 10 at 2), and is kept from one N to the next in half of them.
RateLaw owen_like(double large);

/// Normal errors of RMSE 1/N to N = 4096, correlated 0.6 between neighbouring N, beside what does not fall: a bias, the
/// same in all replicates, or noise drawn anew at each N like rounding. Its square is the MSE of N = 512.
RateLaw biased();
RateLaw rounded();

/// Walks of one integral as a fit to the sample variance sees them: v_r = (e_r − ē)² R / (R − 1), of replicates whose
/// errors e_r are known with their signs, up to a constant. No reference reaches these.
RateLaw walk_spread();

/// Those v_r: their mean is the sample variance.
std::vector<double> spread_of(const std::vector<double>& errors);

}  // namespace halfslope
