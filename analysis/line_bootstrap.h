// Errors at several N of the same replicates, resampled jointly: what every slope of log RMSE and its interval stand
// on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/intervals.h"

namespace halfslope {

/// What the reference's own error δ adds to every mean squared error. It is one draw, common to all replicates and all
/// N: δ² = mean over p of δ_p², of mean V̄ and variance 2 Σ_p V_p² / P². Both 0 where the reference is exact; a variance
/// of 0 beside V̄ > 0 takes δ² = V̄ as known.
struct ReferenceNoise {
  double mse = 0, mse_variance = 0;
};

/// A linear combination of the y_j below with its measured value: Σ c_j y_j, or what that is the linear part of.
struct Combination {
  std::vector<double> c;
  double value;
};

/// y_j = ½ log(M_j − V̄), M_j the mean over replicates of mse[j][r], and linear combinations Σ_j c_j y_j of them with
/// Σ_j c_j = 0: slopes, and residuals about lines.
///
/// Replicate r has the influence u_r = ½ Σ_j c_j (mse[j][r] − M_j) / (M_j − V̄), the derivative of the combination by
/// its weight, so the standard error is that of the mean of the u_r. One set of B = 999 resamples of replicates, joint
/// over all N because samples at different N share points, serves every combination: each keeps the ratios of its
/// means to those of all, and the covariance of what it drew; beyond kMostPaired N, whose pairs would be too many, what
/// it drew, from which every combination then takes J' R steps, J' the N that have a c_j.
///
/// The reference's δ² is drawn beside each resample, from the scaled χ² that has its mean and variance (F. E.
/// Satterthwaite, "An approximate distribution of estimates of variance components", Biometrics Bulletin 2(6), 1946).
class LineBootstrap {
 public:
  /// So many N have their covariances kept.
  static constexpr std::size_t kMostPaired = 24;

  /// mse[j] has the same R ≥ 1 finite numbers ≥ 0 for each j, in the same order of replicates, and M_j > V̄ for all j.
  LineBootstrap(std::span<const std::vector<double>> mse, const ReferenceNoise& reference, std::uint64_t seed);

  std::size_t counts() const { return corrected_.size(); }
  std::size_t replicates() const { return replicates_; }
  /// y_j.
  std::span<const double> log_rmse() const { return log_rmse_; }
  /// Estimated variances of the y_j: those of the replicates, each drawn towards what all N have in common (relative
  /// variances of squared errors are alike over N, and their estimates from few replicates are not), and the
  /// reference's. All equal with one replicate.
  std::vector<double> variances() const;

  double value(std::span<const double> c) const;
  /// √ of the variance of Σ c_j y_j over replicates; 0 with one replicate, or where their influences are equal.
  double standard_error(std::span<const double> c) const;

  /// 95 % interval of Σ c_j y_j: the value less the upper and the lower quantile over resamples of
  ///   w · se · T* + Σ_j c_j ½ log(1 + (δ*² − V̄) / (M_j − V̄)),   w = 1 + 3/R,
  /// T* = (Σ c_j y*_j − Σ c_j y_j) / se* the bootstrap-t, the sum what the reference's error does, at first hand since
  /// it is skewed and no standard error describes it. A resample without a T* (some M*_j ≤ V̄, or equal influences)
  /// counts as beyond both ends. Empty where se = 0 or too few resamples are left.
  std::optional<Interval> interval(std::span<const double> c) const;

  /// Whether combinations that should be 0 are not: the largest |value| / se among them is above the quantile 1 − level
  /// of the largest |T*|, so that `level` holds for all of them together. A combination that no replicate moves
  /// (se = 0) is not 0 if it is larger than rounding. False with one replicate.
  bool differ_from_zero(std::span<const Combination> combinations, double level) const;

 private:
  /// Of a combination in a resample: its change, and its standard error there.
  struct Deviation {
    double change, error;
  };
  /// Empty where some M*_j ≤ V̄ or all influences drawn are equal.
  std::optional<Deviation> deviation(std::size_t resample, std::span<const double> c) const;
  /// The same from the influences, where no covariances are kept.
  std::optional<Deviation> drawn_deviation(std::size_t resample, std::span<const double> c) const;
  /// What drawn number `resample` of the reference's error does to a combination; NaN where it leaves no error.
  double reference_change(std::size_t resample, std::span<const double> c) const;

  std::size_t replicates_ = 0;
  std::vector<double> corrected_, log_rmse_;
  double reference_sd_ = 0;
  std::vector<double> covariance_;  ///< of the deviations (mse − M_j) / (M_j − V̄) over replicates, j · J + k
  std::vector<double> log_ratio_;  ///< of resample b: ½ log of M*_j − V̄ over M_j − V̄, b · J + j; NaN where none
  std::vector<double>
      resample_;  ///< of resample b: covariances of the deviations over their mean ratios, b · J(J + 1)/2 + pair
  std::vector<double> deviations_;       ///< beyond kMostPaired N: (mse − M_j) / (M_j − V̄), j · R + r
  std::vector<std::uint16_t> weights_;   ///< and how often resample b drew replicate r, b · R + r
  std::vector<double> reference_draws_;  ///< δ*² − V̄ of resample b; empty where it is known
};

}  // namespace halfslope
