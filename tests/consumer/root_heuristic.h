// A heuristic, and so an estimator for any techniques: w_i = √(c_i p_i) / Σ_k √(c_k p_k). It is given the ratios of all
// c_k p_k to the largest of them, so nothing overflows.
#pragma once

#include <cmath>

inline double root_weight(const double* ratios, int techniques, int i) {
  double sum = 0;
  for (int k = 0; k < techniques; ++k) sum += std::sqrt(ratios[k]);
  return std::sqrt(ratios[i]) / sum;
}
