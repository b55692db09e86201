#include "analysis/cell_statistics.h"

#include <algorithm>
#include <cmath>

#include "analysis/reference_noise.h"
#include "analysis/status.h"
#include "analysis/tails.h"

namespace halfslope {
namespace {

std::optional<double> if_finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

std::optional<double> if_positive(double value) {
  return std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

/// A mean squared error corrected for the reference, with the ends of its interval.
struct Corrected {
  std::optional<double> value, lo, hi;
};

/// `member` names the squared error of one replicate, `over_replicates` its moments.
Corrected corrected(const CellData& data, double ReplicateErrors::*member, const Moments& over_replicates,
                    double reference_share, double reference_noise, bool exact, bool with_interval) {
  // Errors that are all 0 against an exact reference are known to be 0; any other 0 would be a clamped one.
  if (exact && reference_share == 0) return {0.0, {}, {}};
  Corrected result;
  result.value = if_positive(over_replicates.mean - reference_share);
  if (!result.value || !with_interval) return result;
  std::vector<double> values;
  for (const ReplicateErrors& replicate : data.per_replicate) values.push_back(replicate.*member);
  const std::optional<Interval> interval = values.empty()
                                               ? log_mean_interval(data.interval, over_replicates)
                                               : log_mean_interval(data.interval, values, data.bootstrap_seed);
  if (interval) {
    const Interval wide = widened_for_reference(*interval, over_replicates.mean, reference_noise);
    result.lo = if_positive(std::exp(wide.lo) - reference_share);
    result.hi = if_positive(std::exp(wide.hi) - reference_share);
  }
  return result;
}

std::optional<double> root(std::optional<double> square) {
  return square ? std::optional(std::sqrt(*square)) : std::nullopt;
}

}  // namespace

CellStatistics summarise(const CellData& data) {
  const auto replicates = static_cast<double>(data.replicates);
  const bool deterministic = data.deterministic || data.replicates == 1;
  const bool exact = data.nonfinite == 0 && data.mae == 0;

  CellStatistics row;
  row.reference = data.reference_mean;
  row.reference_se = data.reference_se;
  row.reference_mse = data.reference_mse;
  row.nonfinite = data.nonfinite;
  row.mean = if_finite(data.mean.mean);
  row.bias = if_finite(data.mean_error.mean);
  row.mae = if_finite(data.mae);
  row.median_abs_error = if_finite(data.abs_error.median());
  if (data.deterministic) {
    row.bias_se = data.reference_se;
  } else if (data.replicates > 1) {
    row.bias_se = if_finite(std::hypot(data.mean_error.standard_error(), data.reference_se));
  }
  if (!deterministic) {
    row.variance = if_finite(data.sum_m2 * (replicates / (replicates - 1)) / static_cast<double>(data.integrals));
    row.kurtosis = if_finite(data.sum_m4 / data.sum_m2_squared);
    row.kurtosis_corrected = corrected_kurtosis(data.sum_m2_squared, data.sum_m4, data.replicates);
  }
  if (data.mse.mean > 0)
    row.worst_share = if_finite(data.worst_squared_error / (data.mse.mean * static_cast<double>(data.integrals)));

  const Corrected mse = corrected(data, &ReplicateErrors::mse, data.mse, data.reference_mse, data.reference_mse_noise,
                                  exact, !deterministic);
  row.rmse = root(mse.value);
  row.rmse_lo = root(mse.lo);
  row.rmse_hi = root(mse.hi);
  const Corrected relmse = corrected(data, &ReplicateErrors::relmse, data.relmse, data.reference_relmse,
                                     data.reference_relmse_noise, exact, !deterministic);
  row.relmse = relmse.value;
  row.relmse_lo = relmse.lo;
  row.relmse_hi = relmse.hi;

  if (data.infinite_variance) {
    for (std::optional<double>* number :
         {&row.variance, &row.rmse, &row.rmse_lo, &row.rmse_hi, &row.relmse, &row.relmse_lo, &row.relmse_hi,
          &row.kurtosis, &row.kurtosis_corrected, &row.worst_share}) {
      number->reset();
    }
    if (!data.deterministic) row.bias_se.reset();
  }

  const bool not_positive =
      (!mse.value && std::isfinite(data.mse.mean)) || (!relmse.value && std::isfinite(data.relmse.mean));
  row.invalid = data.nonfinite > 0 || !std::isfinite(data.mse.mean);
  Status status;
  status.mark_if(row.invalid, "invalid");
  status.mark_if(data.infinite_variance, "infinite-variance");
  status.mark_if(exact, "exact");
  status.mark_if(deterministic, "deterministic");
  status.mark_if(!deterministic && data.replicates < kCertifiedReplicates, "few-replicates");
  // Replicates that all err alike: the estimator has not met what contributes, or rounding is all that is left.
  status.mark_if(!deterministic && !exact && row.variance == 0.0, "no-spread");
  const bool heavy = row.kurtosis_corrected && *row.kurtosis_corrected > kurtosis_limit(data.replicates);
  status.mark_if(heavy, "heavy-tailed");
  status.mark_if(!exact && data.mse.mean < kRoundingReach * data.rounding_mse, "floor");
  status.mark_if(not_positive || data.reference_mse > kReferenceShare * data.mse.mean, "reference-limited");
  row.status = status.text();
  row.certified = (row.rmse_lo || row.rmse_hi) && data.replicates >= kCertifiedReplicates && !heavy;
  return row;
}

}  // namespace halfslope
