// When a measurement may stop: replicates come in stages, and after each the RMSE's interval is looked at.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/cell_statistics.h"

namespace halfslope {

/// Replicates of the first stage. Fewer would let a lucky run of small errors stop a measurement.
inline constexpr std::int64_t kFirstStage = 64;

/// How many replicates there are after each stage: 64, then every doubling in `steps` equal parts, and `most` at last.
/// steps = 1: 64, 128, 256, …; steps = 4: 64, 128, 192, 256, 320, … 512, 640, … in multiples of 64. {most} where
/// most ≤ 64. most ≥ 1, steps ≥ 1.
std::vector<std::int64_t> replicate_schedule(std::int64_t most, int steps = 1);

/// The larger of log(rmse_hi / rmse) and log(rmse / rmse_lo): how far off the RMSE may be, as a logarithm. Empty where
/// one of the three is.
std::optional<double> log_half_width(const CellStatistics& cell);

/// The same by the delta method, without an interval's work: z s / (2 √R (M − V̄)), z = 1.96, with M and s the mean and
/// the standard deviation of the replicates' squared errors and V̄ the reference's variance. Enough to compare cells.
/// Empty where M ≤ V̄ or a moment is not finite.
std::optional<double> approximate_half_width(const Moments& mse, double reference_mse);

enum class TargetState : std::uint8_t {
  kReached,  ///< the interval is narrow enough, and certified
  kOpen,     ///< not yet
  kNone,     ///< there is no interval to be narrowed: deterministic, exact, of infinite variance, or invalid
};

/// Whether the RMSE is known to ± `target`, a share of it: both log half-widths are at most log(1 + target). A cell
/// whose interval is not certified (heavy-tailed, few-replicates) is open whatever the interval says, and so is one
/// without an interval (no-spread, reference-limited).
///
/// A measurement that stops at the first stage where its cells are kReached stops the sooner the smaller the spread
/// happens to look, so its intervals cover a little less than those of a fixed number of replicates (Y. S. Chow,
/// H. Robbins, "On the asymptotic theory of fixed-width sequential confidence intervals for the mean", Ann. Math.
/// Statist. 36, 1965). Stages that double look rarely, and from 64 on; stopping_coverage() measures what that costs.
TargetState target_state(const CellStatistics& cell, double target);

/// Replicates that one integral with Gaussian errors needs for a half-width of log(1 + target): Var(log rmse) = 1/(2R),
/// so R = z² / (2 log²(1 + target)), z = 1.96. The mean over P independent integrals of equal variance needs 1/P of it.
double gaussian_replicates(double target);

/// Replicates at which a half-width that is `half_width` after `replicates` of them is expected to be log(1 + target),
/// since it falls as R^−½: R (h / log(1 + target))².
double expected_replicates(std::int64_t replicates, double half_width, double target);

}  // namespace halfslope
