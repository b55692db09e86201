// From a cell's folded sums to the numbers of its row in convergence.csv.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/interval_methods.h"
#include "analysis/log_histogram.h"
#include "analysis/moments.h"

namespace halfslope {

/// What one replicate measured: quantities over the whole image, that is over P integrals (pixels × channels).
struct ReplicateErrors {
  double mean = 0;           ///< (1/P) Σ Î
  double mean_error = 0;     ///< (1/P) Σ e, e = Î − R̂
  double mse = 0;            ///< (1/P) Σ e²
  double variance = 0;       ///< (1/P) Σ (Î − m)² n/(n − 1), m the mean of n replicates, this one among them: of
                             ///< expectation (1/P) Σ Var(Î), whatever the reference. NaN of one replicate
  double relmse = 0;         ///< (1/P) Σ e² / (R̂² + 0.01)
  double mae = 0;            ///< (1/P) Σ |e|
  double max_abs_error = 0;  ///< max |e|
};

/// All that a cell's statistics need. `per_replicate` is kept up to 4096 replicates; the moments over replicates
/// always.
struct CellData {
  std::int64_t replicates = 0;
  std::int64_t integrals = 0;  ///< P, the known constants counted
  std::vector<ReplicateErrors> per_replicate;
  Moments mean, mean_error, mse, relmse;  ///< over replicates
  double mae = 0;                         ///< over all (replicate, integral)
  double sum_m2 = 0;                      ///< Σ_p m2_p, m_k = (1/R) Σ_i (Î_ip − Ī_p)^k
  double sum_m2_squared = 0;              ///< Σ_p m2_p²
  double sum_m4 = 0;                      ///< Σ_p m4_p
  double worst_squared_error = 0;         ///< Σ of the mean e² of the worst_count(P) integrals where it is largest
  double other_squared_error = 0;         ///< that of all others
  LogHistogram abs_error;                 ///< |e| over all (replicate, integral)
  double reference_mean = 0;              ///< mean of R̂ over p
  double reference_se = 0;                ///< standard error of that mean
  double reference_mse = 0;               ///< V̄ = mean over p of Var(R̂_p)
  double reference_relmse = 0;            ///< mean over p of Var(R̂_p) / (R̂_p² + 0.01)
  double reference_mse_noise = 0;         ///< variance of mean δ², δ = R̂ − I (analysis/reference_noise.h)
  double reference_relmse_noise = 0;      ///< that of mean δ²/(R̂² + 0.01)
  std::int64_t nonfinite = 0;             ///< non-finite estimates met
  std::uint64_t bootstrap_seed = 0;       ///< of the cell's name
  IntervalMethod interval = IntervalMethod::kBootstrapT;
  double rounding_mse = 0;         ///< square of the rounding error of values as large as these; 0: not known
  bool deterministic = false;      ///< the sampler has one replicate
  bool infinite_variance = false;  ///< of the integrand: no squared error has an expectation
};

/// The numbers of one row. Empty where a number has no meaning, is not finite (the cell is then `invalid`), or cannot
/// be estimated; never 0 instead (docs/columns.md).
struct CellStatistics {
  std::optional<double> mean, bias, bias_se, variance, rmse, rmse_lo, rmse_hi, mae, relmse, relmse_lo, relmse_hi,
      kurtosis, kurtosis_corrected, median_abs_error, worst_share;
  double reference = 0, reference_se = 0, reference_mse = 0;
  std::int64_t nonfinite = 0;
  bool invalid = false;
  bool certified = false;  ///< the intervals are there, and nothing speaks against their coverage
  std::string status;      ///< "ok", or several marks joined by ';'
};

/// With R replicates, P integrals, M the mean of e² and V̄ the reference's mean variance:
///
///   bias_se     √(sd_i(ē_i)²/R + reference_se²); a deterministic sampler has no first term, a single replicate of a
///               randomised one no bias_se
///   variance    Σ_p m2_p · R/(R − 1) / P, so M = (R − 1)/R · variance + mean_p(ē_p²)
///   rmse        √(M − V̄); [rmse_lo, rmse_hi] is the 95 % interval of log M (log_mean_interval over the replicates'
///               MSE, or over their moments where they are not kept), made wider for the reference's own error
///               (widened_for_reference), less V̄, rooted; an end that is not positive then, or not finite, is empty
///   relmse      mean e²/(R̂² + 0.01) less the reference's share, its interval likewise
///   kurtosis    Σ_p m4_p / Σ_p m2_p² over replicates about each integral's own mean; 3 for normal errors, whatever
///               their variances; kurtosis_corrected is the same without the bias of few replicates (analysis/tails.h)
///   worst_share the share of the ⌈P/1000⌉ worst integrals in Σ_p mean e², the reference's noise included
///
/// Marks, in this order:
///   invalid            an estimate is not finite, or a reference, or their squared errors
///   infinite-variance  the integrand has none: variance, rmse, relmse, kurtosis and their intervals would estimate
///   what
///                      does not exist and are empty, and so is the bias_se of a randomised sampler; mae stays, since
///                      E |e| is finite
///   exact              every error is 0; rmse is 0, without interval
///   deterministic      the sampler is, or R = 1: variance, kurtosis and intervals are empty
///   few-replicates     R < 16: the intervals are not certified
///   heavy-tailed       kurtosis_corrected > max(5, R/40): the intervals are not certified
///   floor              M < 100 · rounding_mse: the precision's rounding is in what is measured
///   reference-limited  V̄ > 10 % of M, or a difference M − V̄ that is not positive, whose root is then empty
CellStatistics summarise(const CellData& data);

}  // namespace halfslope
