#include "analysis/cumulants.h"

#include <cmath>

namespace halfslope {

double Cumulants::skewness() const { return orders[3] / std::pow(orders[2], 1.5); }
double Cumulants::kurtosis() const { return 3 + orders[4] / (orders[2] * orders[2]); }

void Cumulants::add(const Cumulants& other, double times, double factor) {
  double power = 1;
  for (std::size_t j = 1; j <= kHighest; ++j) {
    power *= factor;
    orders[j] += times * power * other.orders[j];
  }
}

Cumulants Cumulants::of_mean(double count) const {
  Cumulants mean;
  mean.add(*this, count, 1 / count);
  return mean;
}

Cumulants cumulants_from_central_moments(double mean, std::span<const double, Cumulants::kHighest + 1> moments) {
  Cumulants cumulants;
  cumulants.orders[1] = mean;
  for (std::size_t n = 2; n <= Cumulants::kHighest; ++n) {
    double cumulant = moments[n], choices = static_cast<double>(n - 1);  // C(n − 1, j − 1)
    for (std::size_t j = 2; j + 2 <= n; ++j) {
      cumulant -= choices * cumulants.orders[j] * moments[n - j];
      choices *= static_cast<double>(n - j) / static_cast<double>(j);
    }
    cumulants.orders[n] = cumulant;
  }
  return cumulants;
}

}  // namespace halfslope
