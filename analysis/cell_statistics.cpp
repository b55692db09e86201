#include "analysis/cell_statistics.h"

#include <algorithm>
#include <cmath>

#include "analysis/reference_noise.h"
#include "analysis/status.h"
#include "analysis/tails.h"

namespace halfslope {
namespace {

std::optional<double> if_finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

/// `member` names the squared error of one replicate, `over_replicates` its moments.
CorrectedMean corrected(const CellData& data, double ReplicateErrors::*member, const Moments& over_replicates,
                        const ReferencePart& reference, bool exact, bool with_interval) {
  // Errors that are all 0 against an exact reference are known to be 0; any other 0 would be a clamped one.
  if (exact && reference.mean == 0) return {0.0, {}, {}};
  std::vector<double> values;
  for (const ReplicateErrors& replicate : data.per_replicate) values.push_back(replicate.*member);
  std::optional<Interval> interval;
  if (with_interval) {
    interval = values.empty() ? log_mean_interval(data.interval, over_replicates)
                              : log_mean_interval(data.interval, values, data.bootstrap_seed);
  }
  return corrected_mean(over_replicates.mean, interval, reference);
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
  row.worst_share = share_of_largest(data.worst_squared_error, data.other_squared_error);

  const CorrectedMean mse = corrected(data, &ReplicateErrors::mse, data.mse,
                                      {data.reference_mse, data.reference_mse_noise}, exact, !deterministic);
  const CorrectedMean rmse = rooted(mse);
  row.rmse = rmse.value;
  row.rmse_lo = rmse.lo;
  row.rmse_hi = rmse.hi;
  const CorrectedMean relmse = corrected(data, &ReplicateErrors::relmse, data.relmse,
                                         {data.reference_relmse, data.reference_relmse_noise}, exact, !deterministic);
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
