#include "experiments/theory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/cumulants.h"
#include "analysis/intervals.h"
#include "analysis/moments.h"
#include "analysis/sample_variance.h"
#include "estimators/exact_variance.h"

namespace halfslope {
namespace {

constexpr std::array kChecks = {
    TheoryCheckInfo{"balance-bound", "V[balance] - V[F] <= (1/min n_i - 1/sum n_i) mu^2"},
    TheoryCheckInfo{"one-sample-balance", "V[one-sample-balance] <= V[any other one-sample]"},
    TheoryCheckInfo{"average-bound", "V[average] <= the largest V of its n techniques alone / n"},
    TheoryCheckInfo{"exact-variance", "measured variance = exact variance"},
};
constexpr double kFamilyError = 0.01;
constexpr std::int64_t kFewest = 16;         // replicates of an interval that is certified
constexpr std::uint64_t kAsymptotic = 1024;  // rounds
constexpr double kAsymptoticError = 0.03;
constexpr double kQuadratureError = 1e-10;  // of a mean: variances below its square are not known

/// A comparison before its interval is known, whose level depends on how many there are.
struct Open {
  TheoryRow row;
  /// Differences over replicates, of each alternative: the bound is broken where it is for all of them.
  std::vector<Moments> differences;
  double slack = 0;           ///< what rounding may add to a difference
  Cumulants replicate;        ///< exact ones of a replicate's value, for exact-variance
  double relative_error = 0;  ///< what the prediction may be off by
  std::int64_t replicates = 0;
  bool judged() const { return row.verdict.empty(); }
};

class Checker {
 public:
  Checker(const Plan& plan, const Results& results, std::span<const Reference> references)
      : plan_(plan), results_(results), references_(references) {}

  void run(std::span<const std::string> checks) {
    const auto wants = [&](std::string_view name) { return std::ranges::find(checks, name) != checks.end(); };
    for (std::size_t c = 0; c < plan_.cells.size(); ++c) {
      if (plan_.cells[c].sampler != "independent") continue;
      const Estimator& e = estimator(c);
      const bool several = e.allocation.techniques.size() > 1;
      if (several && is_fold(e.heuristic.kind) && e.heuristic.kind != HeuristicKind::kBalance) {
        const bool one_sample = e.allocation.one_sample;
        if (wants(one_sample ? "one-sample-balance" : "balance-bound")) against_balance(c, one_sample);
      }
      const bool average = e.heuristic.kind == HeuristicKind::kAverage && !e.allocation.one_sample;
      if (average && wants("average-bound")) against_techniques(c);
      if (wants("exact-variance")) against_prediction(c);
    }
  }

  TheoryReport close() {
    const auto judged = std::ranges::count_if(open_, [](const Open& o) { return o.judged(); });
    const double level = 1 - kFamilyError / static_cast<double>(std::max<std::ptrdiff_t>(judged, 1));
    TheoryReport report;
    for (Open& open : open_) {
      if (open.judged()) open.differences.empty() ? judge_prediction(open, level) : judge_bound(open, level);
      report.rows.push_back(std::move(open.row));
    }
    return report;
  }

 private:
  const Estimator& estimator(std::size_t c) const {
    return plan_.scenes[plan_.cells[c].scene].estimators[plan_.cells[c].estimator];
  }

  // The cell of the same pass and N with that heuristic.
  const CellResult* beside(std::size_t c, HeuristicKind kind) const {
    for (std::size_t d = 0; d < plan_.cells.size(); ++d) {
      if (plan_.cells[d].pass == plan_.cells[c].pass && plan_.cells[d].n == plan_.cells[c].n &&
          estimator(d).heuristic.kind == kind)
        return &results_.cells[d];
    }
    return nullptr;
  }

  // The cell of technique `technique` alone.
  const CellResult* alone(std::size_t c, int technique) const {
    const Cell& like = plan_.cells[c];
    const Allocation wanted = {{technique}, {1}};
    for (std::size_t d = 0; d < plan_.cells.size(); ++d) {
      const Cell& cell = plan_.cells[d];
      if (cell.scene == like.scene && cell.sampler == like.sampler && cell.precision == like.precision &&
          cell.samples == like.samples && estimator(d).allocation == wanted)
        return &results_.cells[d];
    }
    return nullptr;
  }

  // Mean over integrals of μ², which is the pixel's without what is known of it.
  double mean_square(std::size_t scene) const {
    const PlannedScene& planned = plan_.scenes[scene];
    const auto channels = static_cast<std::size_t>(planned.source->channels());
    const Reference& reference = references_[scene];
    double sum = 0;
    for (std::size_t p = 0; p < planned.pixels.size(); ++p) {
      const Color constant = planned.source->pixel(planned.pixels[p]).constant;
      for (std::size_t c = 0; c < channels; ++c) {
        const double mu = reference.value[p * channels + c] - constant[c];
        sum += mu * mu - reference.variance[p * channels + c];
      }
    }
    return sum / static_cast<double>(reference.value.size());
  }

  Open start(std::size_t c, const char* check) const {
    Open open;
    open.row.cell = results_.cells[c].name;
    open.row.check = check;
    open.replicates = results_.cells[c].replicates;
    if (open.replicates < kFewest) open.row.verdict = "few-replicates";
    return open;
  }

  // Why the differences of these cells' errors cannot be judged; empty if they can.
  static std::string unfit(std::initializer_list<const CellResult*> cells) {
    for (const CellResult* cell : cells) {
      for (const char* mark : {"invalid", "infinite-variance", "heavy-tailed", "reference-limited"}) {
        if (cell->statistics.status.find(mark) != std::string::npos) return mark;
      }
      if (cell->replicate_mse.empty()) return "many-replicates";
    }
    return "";
  }

  // Of the errors of `a` less `share` of those of `b`, replicate by replicate. Squares of errors e that rounding moves
  // by ε move by 2eε + ε².
  static void add_difference(Open& open, const CellResult& a, const CellResult& b, double share) {
    std::vector<double> differences;
    const double va = a.statistics.reference_mse, vb = b.statistics.reference_mse;
    for (std::size_t r = 0; r < a.replicate_mse.size(); ++r)
      differences.push_back(a.replicate_mse[r] - va - share * (b.replicate_mse[r] - vb));
    open.differences.emplace_back().add(std::span<const double>(differences));
    const double rounding = std::sqrt(a.facts.rounding_mse);
    open.slack = std::max(open.slack, 4 * rounding * (std::sqrt(std::max(a.mse, share * b.mse)) + rounding));
  }

  void against_balance(std::size_t c, bool one_sample) {
    const CellResult* balance = beside(c, HeuristicKind::kBalance);
    if (!balance) return;
    Open open = start(c, one_sample ? "one-sample-balance" : "balance-bound");
    const Allocation& allocation = estimator(c).allocation;
    open.row.expected = 0;
    if (!one_sample) {
      const auto rounds = static_cast<double>(open.row.cell.samples) / allocation.round();
      const auto least = static_cast<double>(*std::ranges::min_element(allocation.counts));
      open.row.expected =
          (1 / (rounds * least) - 1 / static_cast<double>(open.row.cell.samples)) * mean_square(plan_.cells[c].scene);
    }
    if (open.judged()) open.row.verdict = unfit({balance, &results_.cells[c]});
    if (open.judged()) add_difference(open, *balance, results_.cells[c], 1);
    open_.push_back(std::move(open));
  }

  void against_techniques(std::size_t c) {
    Open open = start(c, "average-bound");
    open.row.expected = 0;
    const Allocation& allocation = estimator(c).allocation;
    const auto n = static_cast<double>(allocation.techniques.size());
    for (std::size_t k = 0; k < allocation.techniques.size(); ++k) {
      const CellResult* technique = alone(c, allocation.techniques[k]);
      if (!technique) return;  // the bound is not measured
      if (open.judged()) open.row.verdict = unfit({&results_.cells[c], technique});
      // n_i of N samples are the technique's: its variance is N/n_i times that at N.
      const double share = allocation.round() / (allocation.counts[k] * n);
      if (open.judged()) add_difference(open, results_.cells[c], *technique, share);
    }
    open_.push_back(std::move(open));
  }

  void against_prediction(std::size_t c) {
    const Cell& cell = plan_.cells[c];
    const auto densities = plan_.scenes[cell.scene].source->exact_densities();
    if (!densities) return;
    const std::optional<Cumulants>& round = exact_round(cell, *densities);
    if (!round) return;
    const CellResult& result = results_.cells[c];
    const CellStatistics& s = result.statistics;
    Open open = start(c, "exact-variance");
    const auto rounds = cell.samples / static_cast<std::uint64_t>(estimator(c).allocation.round());
    open.replicate = round->of_mean(static_cast<double>(rounds));
    const double expected = open.replicate[2], measured = s.variance.value_or(0);
    open.row.expected = expected;
    open.row.measured = s.variance;
    const bool optimal = estimator(c).heuristic.kind == HeuristicKind::kOptimal;
    // Numbers of variance V that rounding moves by ε have one within V (1 ± ε/√V)².
    const double rounding = expected > 0 ? std::sqrt(result.facts.rounding_mse / expected) : 0;
    open.relative_error = (optimal ? kAsymptoticError : 0) + rounding * (2 + rounding);
    const double resolved = 100 * result.facts.rounding_mse, known = kQuadratureError * (*round)[1];
    const auto say = [&](bool so, const char* verdict) {
      if (so && open.judged()) open.row.verdict = verdict;
    };
    say(s.invalid, "invalid");
    say(!s.variance, "deterministic");
    say(optimal && rounds < kAsymptotic, "asymptotic");
    say(std::max(measured, expected) <= resolved, "holds");  // both 0 but for rounding
    say(!has_sample_variance_range(open.replicate, open.replicates), "heavy-tailed");
    say(measured <= resolved && (*round)[2] <= known * known, "no-spread");
    open_.push_back(std::move(open));
  }

  // Of one round of the cell's estimator, which every N of it shares.
  const std::optional<Cumulants>& exact_round(const Cell& cell, const ExactDensities& densities) {
    const auto [at, is_new] = rounds_.try_emplace({cell.scene, cell.estimator});
    if (is_new) at->second = exact_round_cumulants(plan_.scenes[cell.scene].estimators[cell.estimator], densities);
    return at->second;
  }

  static void judge_bound(Open& open, double level) {
    TheoryRow& row = open.row;
    for (const Moments& difference : open.differences) {
      const Interval interval = t_interval(difference, level).value_or(Interval{difference.mean, difference.mean});
      if (row.lo && *row.lo <= interval.lo) continue;
      row.measured = difference.mean, row.lo = interval.lo, row.hi = interval.hi;
    }
    row.verdict = *row.lo > *row.expected + open.slack ? "violated" : "holds";
  }

  static void judge_prediction(Open& open, double level) {
    TheoryRow& row = open.row;
    const Interval range = sample_variance_range(open.replicate, open.replicates, level);
    row.lo = *row.measured / range.hi;
    if (range.lo > 0) row.hi = *row.measured / range.lo;
    const double off = open.relative_error;
    const bool below = *row.expected * (1 + off) < *row.lo, above = row.hi && *row.expected * (1 - off) > *row.hi;
    row.verdict = below || above ? "violated" : "holds";
  }

  const Plan& plan_;
  const Results& results_;
  std::span<const Reference> references_;
  std::map<std::pair<std::size_t, std::size_t>, std::optional<Cumulants>> rounds_;  ///< by scene and estimator
  std::vector<Open> open_;
};

}  // namespace

std::span<const TheoryCheckInfo> theory_checks() { return kChecks; }

std::size_t TheoryReport::violated() const {
  return static_cast<std::size_t>(std::ranges::count(rows, "violated", &TheoryRow::verdict));
}

TheoryReport check_theory(std::span<const std::string> checks, const Plan& plan, const Results& results,
                          std::span<const Reference> references) {
  Checker checker(plan, results, references);
  checker.run(checks);
  return checker.close();
}

}  // namespace halfslope
