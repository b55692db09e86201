#include "analysis/normal.h"

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

namespace halfslope {

double normal_quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }
double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

}  // namespace halfslope
