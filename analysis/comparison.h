// Whether one mean squared error is smaller than another, and by how much.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/comparison_bootstrap.h"
#include "analysis/intervals.h"
#include "analysis/power.h"

namespace halfslope {

/// What is compared: the squared errors of one cell's replicates.
struct ComparedErrors {
  std::span<const double> squared_errors;  ///< e²_r ≥ 0, one a replicate; empty: they were not kept
  double reference_mse = 0;                ///< V̄, which they contain and which is subtracted from their mean
  double rounding_mse = 0;                 ///< square of the rounding error of the estimates; 0: not known
};

/// Estimates that are so many rounding errors apart or less, four units in the last place, are the same number reached
/// in two ways.
inline constexpr double kRoundings = 8;

/// What a comparison says, at 5 % over the whole family.
enum class Verdict {
  kNone,       ///< nothing: it was refused, and `status` says why
  kUndecided,  ///< the two cannot be told apart
  kABetter,
  kBBetter,
};
const char* to_string(Verdict verdict);

/// Resamples of a comparison, so that 5 % of a family of tests are well inside.
inline constexpr int kComparisonResamples = 4999;
inline constexpr double kFamilyLevel = 0.05;
/// The ratio of mean squared errors that predictions are about, and how probably it should be told.
inline constexpr double kDifferenceToTell = 1.1;
inline constexpr double kPowerToTell = 0.8;

/// One comparison of a family.
struct Comparison {
  ColumnPair pair;
  std::int64_t replicates = 0;       ///< R, of which both sides have squared errors
  std::optional<double> log_ratio;   ///< log((M_a − V̄_a)/(M_b − V̄_b)): negative where a is better
  std::optional<Interval> interval;  ///< of it, 95 %, of this comparison alone; none if wider than ± log kFarthestEnd
  std::optional<double> p;           ///< two-sided, of this comparison alone
  std::optional<double> p_adjusted;  ///< for the whole family
  Verdict verdict = Verdict::kNone;  ///< of p_adjusted
  std::optional<InfluenceSpread> spread;
  /// The probability that a difference of kDifferenceToTell is told in a family like this with R replicates, and the
  /// replicates with which that probability is kPowerToTell.
  std::optional<Prediction> power, replicates_needed;
  double critical = 0;  ///< the normal number that replicates_needed is held against
  std::string status;   ///< "ok", or marks joined by ';'
};

/// Compares the mean squared errors of pairs of cells. With M_k the mean of cell k's squared errors and c_k = M_k −
/// V̄_k, the log ratio log c_a − log c_b has the influences u_r = e²_ar/c_a − e²_br/c_b, less their mean, and the
/// standard error se = sd(u)/√R. Row r of all cells is one replicate: where cells share its points the pairing narrows
/// the interval, where they don't it does no harm. All rows are resampled jointly, B = 4999 times
/// (ComparisonBootstrap), and
///
///   interval    log ratio ± se · |T*|_(0.95 (B + 1)): the symmetric bootstrap-t (P. Hall, "On
///               symmetric bootstrap confidence intervals", J. R. Statist. Soc. B 50(1), 1988)
///   p           (1 + #{|T*| ≥ |t|})/(B + 1), t = log ratio/se
///   p_adjusted  the same with the largest |T*| over this and all less significant comparisons of the family, and
///               never under that of a more significant one (J. P. Romano, M. Wolf, "Exact and approximate stepdown
///               methods for multiple hypothesis testing", JASA 100, 2005; "Efficient computation of adjusted p-values
///               for resampling-based stepdown multiple testing", Stat. Probab. Lett. 113, 2016). The probability that
///               any comparison of equal mean squared errors gets a verdict is 5 %, whatever the others are.
///
/// The hypothesis is that of equal *means*. Tests of log e²_r (Welch's, permutations) ask for equal geometric means,
/// which errors of equal MSE and unlike shapes do not have. V̄ is taken as exact.
///
/// Cells of unequal replicates are compared over the first R that both have; such pairs are resampled apart.
///
/// Marks that refuse a comparison: `many-replicates` (squared errors were not kept), `deterministic` (R = 1), `invalid`
/// (a squared error is not finite, or negative), `exact` (an M is 0), `equal` (the same squared errors on
/// both sides, but for kRoundings rounding errors of the estimates), `floor` (an M may be rounding alone: below 100 ·
/// rounding_mse), `no-spread` (the influences are equal, or all replicates of one side err alike, which have met too
/// little to know their error: the ratio stands, with nothing to say how sure it is), `reference-limited` (an M − V̄ is
/// not positive). That do not:
/// `few-replicates` (R < 16), `reference-limited` (V̄ above 10 % of an M).
///
/// Predictions (analysis/power.h) hold against the family's critical value of the first step, the 0.95 (B + 1)-th of
/// the largest |T*|; for other numbers of replicates, against that of a normal number as improbable as it.
///
/// Comparisons come in the order of `pairs`, whose columns must be there. A function of the errors and the seed alone.
std::vector<Comparison> compare(std::span<const ComparedErrors> cells, std::span<const ColumnPair> pairs,
                                std::uint64_t seed);

/// The probability that a ratio of kDifferenceToTell is told by another family like the one of this comparison, with so
/// many replicates. The comparison has a spread.
Prediction predicted_power(const Comparison& pilot, double replicates);

/// Every two of `count` columns, (0, 1), (0, 2), …; and every other one with `baseline`, which is their a.
std::vector<ColumnPair> all_pairs(std::size_t count);
std::vector<ColumnPair> pairs_with(std::size_t baseline, std::size_t count);

}  // namespace halfslope
