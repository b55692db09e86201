// A cell's sums by their definitions, from every estimate of every replicate.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/cell_statistics.h"

namespace halfslope {

/// estimates[i][p] is replicate i's estimate of integral p; reference and reference_variance have one entry for each p.
inline CellData build_cell(const std::vector<std::vector<double>>& estimates, const std::vector<double>& reference,
                           const std::vector<double>& reference_variance) {
  const std::size_t replicates = estimates.size(), integrals = reference.size();
  const auto r = static_cast<double>(replicates), p = static_cast<double>(integrals);
  CellData data;
  data.replicates = static_cast<std::int64_t>(replicates);
  data.integrals = static_cast<std::int64_t>(integrals);
  for (const std::vector<double>& image : estimates) {
    ReplicateErrors errors;
    for (std::size_t k = 0; k < integrals; ++k) {
      const double e = image[k] - reference[k];
      errors.mean += image[k] / p;
      errors.mean_error += e / p;
      errors.mse += e * e / p;
      errors.relmse += e * e / (reference[k] * reference[k] + 0.01) / p;
      errors.mae += std::abs(e) / p;
      errors.max_abs_error = std::max(errors.max_abs_error, std::abs(e));
      data.abs_error.add(e);
      data.nonfinite += !std::isfinite(e);
    }
    data.per_replicate.push_back(errors);
    data.mean.add(errors.mean);
    data.mean_error.add(errors.mean_error);
    data.mse.add(errors.mse);
    data.relmse.add(errors.relmse);
    data.mae += errors.mae / r;
  }
  for (std::size_t k = 0; k < integrals; ++k) {
    double mean = 0, m2 = 0, m4 = 0;
    for (const std::vector<double>& image : estimates) mean += image[k] / r;
    for (const std::vector<double>& image : estimates) {
      const double d = image[k] - mean;
      m2 += d * d / r;
      m4 += d * d * d * d / r;
    }
    data.sum_m2 += m2;
    data.sum_m2_squared += m2 * m2;
    data.sum_m4 += m4;
    data.reference_mean += reference[k] / p;
    data.reference_mse += reference_variance[k] / p;
    data.reference_relmse += reference_variance[k] / (reference[k] * reference[k] + 0.01) / p;
    data.reference_se += reference_variance[k] / (p * p);  // independent integrals
  }
  data.reference_se = std::sqrt(data.reference_se);
  return data;
}

}  // namespace halfslope
