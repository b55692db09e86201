// The standard normal distribution.
#pragma once

namespace halfslope {

/// normal_quantile(0.975): 95 % of a normal distribution lie within so many standard deviations of its mean.
inline constexpr double kNormal975 = 1.959963984540054;

/// The value that a normal number stays below with probability p, 0 < p < 1; and that probability.
double normal_quantile(double p);
double normal_probability(double x);

}  // namespace halfslope
