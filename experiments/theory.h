// Theorems of multiple importance sampling, held against what was measured: theory.csv.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/cell_name.h"
#include "experiments/plan.h"
#include "experiments/reference.h"
#include "experiments/results.h"

namespace halfslope {

/// What key `checks` can name. V is the variance of an estimate at N, n_i of its samples technique i's, C_i the
/// probability of technique i in the one-sample model; means over the image's integrals where there are several, which
/// hold where each does. (E. Veach, "Robust Monte Carlo methods for light transport simulation", 1997, section 9.2.)
///
///   balance-bound       V[balance] − V[F] ≤ (1/min n_i − 1/Σ n_i) μ² for every F of the same techniques and n_i whose
///                       weights are not negative (theorem 9.2)
///   one-sample-balance  V[one-sample-balance] ≤ V[F] for every one-sample F of the same C_i (theorem 9.4)
///   average-bound       V[average of n techniques] ≤ max_i V_i / n, V_i that of technique i alone with n_i samples:
///                       the parts are independent, so it is Σ_i V_i / n². With two techniques and as many samples of
///                       each the bound is the larger variance of the two alone at the same N
///   exact-variance      V = V_exact where the scene knows its densities (estimators/exact_variance.h); for `optimal`,
///                       whose exact variance is a limit, from 1024 rounds on and give or take 3 %. Where the exact
///                       tails are too heavy for so many replicates it is not judged
struct TheoryCheckInfo {
  std::string_view name, statement;
};
std::span<const TheoryCheckInfo> theory_checks();

/// One comparison. `measured` is a difference of variances (balance-bound, one-sample-balance, average-bound) or a
/// variance (exact-variance), [lo, hi] its interval: of Student's t over replicates jointly, or, for a variance, from
/// the law that a sample variance has at the exact cumulants (analysis/sample_variance.h), without hi where that is
/// infinite. All intervals of a run hold together with probability 99 % (Bonferroni).
struct TheoryRow {
  CellName cell;
  std::string check;
  std::optional<double> measured, lo, hi, expected;  ///< expected: the bound, or the prediction
  /// "holds", "violated" (lo beyond the bound, or the prediction outside), or why it is not judged.
  std::string verdict;
};

struct TheoryReport {
  std::vector<TheoryRow> rows;
  std::size_t violated() const;
};

/// Which samplers and scenes the checks leave out, and why: lines for the plan.
std::vector<std::string> left_out_of_checks(const Plan& plan);

/// The checks' rows, in the order of the plan's cells. `results` are the plan's.
TheoryReport check_theory(std::span<const std::string> checks, const Plan& plan, const Results& results,
                          std::span<const Reference> references);

std::string theory_csv(const TheoryReport& report);
/// How many hold, by check and scene, how near they are, every one that is violated, and which of `checks`, those that
/// were asked for, found nothing to check, and what they need.
std::string theory_summary(const TheoryReport& report, std::span<const std::string> checks);

}  // namespace halfslope
