#include "experiments/stages.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "analysis/status.h"
#include "analysis/stopping.h"
#include "experiments/budget.h"
#include "experiments/interrupt.h"
#include "experiments/joined.h"
#include "experiments/parallel.h"
#include "experiments/stopping_keys.h"

namespace halfslope {
namespace {

/// Where a pass stands.
struct Standing {
  std::size_t stage = 0;  ///< the one it is to measure next
  bool open = true;
  double expected = 0;  ///< replicates that its worst known cell is expected to need
};

double not_measured(const Plan& plan, const Journal& journal, std::span<const std::uint64_t> units) {
  double sum = 0;
  for (const std::uint64_t u : units) {
    const Unit& unit = plan.units[u];
    if (!journal.has(u))
      sum += static_cast<double>(plan.passes[unit.pass].evaluations()) * static_cast<double>(unit.pixel_count) *
             static_cast<double>(unit.replicate_count);
  }
  return sum;
}

class TargetRun {
 public:
  TargetRun(double target, const Plan& plan, std::span<const Reference> references, Runner& runner)
      : target_(target), plan_(plan), references_(references), runner_(runner), standings_(plan.passes.size()) {
    for (std::size_t p = 0; p < plan.passes.size(); ++p)
      standings_[p].expected = static_cast<double>(plan.passes[p].stages.front());
  }

  std::vector<std::int64_t> run() {
    while (std::ranges::any_of(standings_, &Standing::open)) {
      const std::vector<std::uint64_t> units = next_units();
      runner_.progress().set_total(runner_.progress().done() + expected_work());
      runner_.run(units);
      look();
    }
    std::vector<std::int64_t> replicates;
    for (std::size_t p = 0; p < standings_.size(); ++p)
      replicates.push_back(plan_.passes[p].stages[standings_[p].stage]);
    return replicates;
  }

 private:
  std::vector<std::uint64_t> next_units() const {
    std::vector<std::uint64_t> units;
    for (std::size_t p = 0; p < standings_.size(); ++p) {
      const Pass& pass = plan_.passes[p];
      const std::size_t stage = standings_[p].stage;
      if (!standings_[p].open) continue;
      const auto more = units_between(pass, stage == 0 ? 0 : pass.stages[stage - 1], pass.stages[stage]);
      units.insert(units.end(), more.begin(), more.end());
    }
    return units;
  }

  // What is left to do if half-widths fall as they should.
  double expected_work() const {
    double sum = 0;
    for (std::size_t p = 0; p < standings_.size(); ++p) {
      const Pass& pass = plan_.passes[p];
      const Standing& standing = standings_[p];
      if (!standing.open) continue;
      const auto enough = std::ranges::lower_bound(pass.stages, standing.expected, {},
                                                   [](std::int64_t total) { return static_cast<double>(total); });
      const std::int64_t last =
          std::max(enough == pass.stages.end() ? pass.replicates : *enough, pass.stages[standing.stage]);
      const std::int64_t done = standing.stage == 0 ? 0 : pass.stages[standing.stage - 1];
      sum += not_measured(plan_, runner_.journal(), units_between(pass, done, last));
    }
    return sum;
  }

  // Decides which passes are done with the stage at hand.
  void look() {
    std::vector<std::size_t> cells;
    for (std::size_t c = 0; c < plan_.cells.size(); ++c) {
      if (standings_[plan_.cells[c].pass].open) cells.push_back(c);
    }
    // One open cell keeps its pass open, so the others need not be looked at, whichever comes first.
    std::vector<std::atomic<double>> needed(standings_.size());
    with_threads(runner_.threads(), [&](int) {
      tbb::parallel_for(
          std::size_t{0}, cells.size(),
          [&](std::size_t i) {
            const Cell& cell = plan_.cells[cells[i]];
            if (needed[cell.pass] > 0 || interrupted()) return;
            if (const double more = replicates_needed(cell); more > 0) needed[cell.pass] = more;
          },
          tbb::simple_partitioner());
    });
    check_interrupt(plan_, runner_.journal());
    for (std::size_t p = 0; p < standings_.size(); ++p) {
      Standing& standing = standings_[p];
      if (!standing.open) continue;
      standing.open = needed[p] > 0 && standing.stage + 1 < plan_.passes[p].stages.size();
      standing.expected = needed[p];
      if (standing.open) ++standing.stage;
    }
  }

  // 0 where the cell is not open; where nobody knows, as many as there are.
  double replicates_needed(const Cell& cell) const {
    const Pass& pass = plan_.passes[cell.pass];
    const std::int64_t replicates = pass.stages[standings_[cell.pass].stage];
    const FoldedCell folded = fold_cell(plan_, cell, references_[cell.scene], runner_.journal(), replicates);
    const CellStatistics statistics = summarise(folded.data);
    if (target_state(statistics, target_) != TargetState::kOpen) return 0;
    const std::optional<double> half_width = log_half_width(statistics);
    return half_width ? expected_replicates(replicates, *half_width, target_) : static_cast<double>(pass.replicates);
  }

  const double target_;
  const Plan& plan_;
  std::span<const Reference> references_;
  Runner& runner_;
  std::vector<Standing> standings_;
};

std::vector<std::int64_t> measure_all(const Plan& plan, Runner& runner) {
  std::vector<std::uint64_t> units(plan.units.size());
  std::iota(units.begin(), units.end(), 0);
  const double work = not_measured(plan, runner.journal(), units);
  runner.progress().set_total(work);
  if (work > 0) runner.run(units);
  std::vector<std::int64_t> replicates;
  for (const Pass& pass : plan.passes) replicates.push_back(pass.replicates);
  return replicates;
}

// "64, 128, 256, … 4096": of the pass with the longest way.
std::string stages_text(const Plan& plan) {
  const Pass& longest = *std::ranges::max_element(plan.passes, {}, [](const Pass& pass) { return pass.stages.size(); });
  std::string text;
  for (std::size_t s = 0; s < longest.stages.size(); ++s) {
    const bool shown = s < 3 || s + 1 == longest.stages.size();
    if (shown) text += fmt::format("{}{}", s == 0 ? "" : ", ", longest.stages[s]);
    if (s == 3 && !shown) text += ", …";
  }
  return text;
}

/// One replicate of a randomised sampler is marked `deterministic` too, but more of them would have had an interval.
TargetState state_of(const CellResult& cell, double target) {
  const std::string& status = cell.statistics.status;
  const bool alone = !cell.facts.deterministic && has_mark(status, "deterministic");
  const bool nothing_to_know =
      cell.statistics.invalid || has_mark(status, "infinite-variance") || has_mark(status, "exact");
  return alone && !nothing_to_know ? TargetState::kOpen : target_state(cell.statistics, target);
}

/// What all cells came to: "every cell knows its rmse ±5%", or "3 of 7 cells know their rmse ±5%; 2 have no interval to
/// narrow (1 exact, 1 deterministic); 2 missed it".
std::string report_target(double target, const std::vector<CellResult>& cells) {
  constexpr std::array kReasons = {"invalid", "infinite-variance", "exact", "deterministic"};
  std::array<std::size_t, kReasons.size()> counts = {};
  std::size_t reached = 0, missed = 0;
  for (const CellResult& cell : cells) {
    const TargetState state = state_of(cell, target);
    reached += state == TargetState::kReached ? 1 : 0;
    missed += state == TargetState::kOpen ? 1 : 0;
    if (state != TargetState::kNone) continue;
    const auto reason =
        std::ranges::find_if(kReasons, [&](const char* mark) { return has_mark(cell.statistics.status, mark); });
    ++counts[static_cast<std::size_t>(reason - kReasons.begin())];
  }
  if (reached == cells.size()) return fmt::format("every cell knows its {}", target_text(target));
  std::string text = fmt::format("{} of {} cells {} {}", reached, cells.size(),
                                 reached == 1 ? "knows its" : "know their", target_text(target));
  std::vector<std::string> reasons;
  for (std::size_t k = 0; k < kReasons.size(); ++k) {
    if (counts[k] > 0) reasons.push_back(fmt::format("{} {}", counts[k], kReasons[k]));
  }
  const std::size_t none = cells.size() - reached - missed;
  if (none > 0)
    text += fmt::format("; {} {} no interval to narrow ({})", none, none == 1 ? "has" : "have", joined(reasons));
  if (missed > 0) text += fmt::format("; {} missed it", missed);
  return text;
}

}  // namespace

std::vector<std::uint64_t> units_between(const Pass& pass, std::int64_t first_replicate, std::int64_t last_replicate) {
  const std::size_t begin = pass.batches_within(first_replicate), end = pass.batches_within(last_replicate);
  std::vector<std::uint64_t> units((end - begin) * pass.tiles);
  std::iota(units.begin(), units.end(), pass.first_unit + begin * pass.tiles);
  return units;
}

std::vector<std::int64_t> measure(const Spec& spec, const Plan& plan, std::span<const Reference> references,
                                  Runner& runner) {
  if (spec.target) return TargetRun(*spec.target, plan, references, runner).run();
  if (spec.budget) return measure_within_budget(*spec.budget, plan, references, runner);
  return measure_all(plan, runner);
}

void set_replicates(Plan& plan, const std::vector<std::int64_t>& replicates) {
  for (std::size_t p = 0; p < plan.passes.size(); ++p) plan.passes[p].replicates = replicates[p];
}

void mark_missed(Results& results, double target) {
  for (CellResult& cell : results.cells) {
    if (state_of(cell, target) != TargetState::kOpen) continue;
    std::string& status = cell.statistics.status;
    status = status == "ok" ? "target-missed" : status + ";target-missed";
  }
}

double least_evaluations(const Plan& plan) {
  double sum = 0;
  for (const Pass& pass : plan.passes) sum += plan.evaluations(pass, pass.stages.front());
  return sum;
}

std::string describe_stopping(const Spec& spec, const Plan& plan) {
  if (!spec.in_stages()) return "";
  const std::string stages = stages_text(plan);
  if (spec.budget) {
    return fmt::format(
        "replicates: {}, as far as {} of work go: the first stage everywhere, then where the rmse narrows most\n",
        stages, budget_text(*spec.budget));
  }
  const double needed = gaussian_replicates(*spec.target);
  std::int64_t enough = kFirstStage;
  while (static_cast<double>(enough) < needed) enough *= 2;
  const std::int64_t most = std::ranges::max(plan.passes, {}, &Pass::replicates).replicates;
  return fmt::format(
      "replicates: {}, until every cell of a pass knows its {}; one integral with Gaussian errors needs {:.0f}, so {}, "
      "P independent ones as many / P, a heavy-tailed cell all{}\n",
      stages, target_text(*spec.target), std::ceil(needed), enough,
      enough > most ? fmt::format("; there are {} at most: more with --replicates {}", most, enough) : "");
}

std::string report_stopping(const Spec& spec, const Plan& plan, const Results& results) {
  if (!spec.in_stages()) return "";
  const auto [least, most] = std::ranges::minmax(plan.passes, {}, &Pass::replicates);
  std::string text =
      fmt::format("{}: {}{} {} a pass, {} samples", spec.name,
                  least.replicates < most.replicates ? fmt::format("{} to ", least.replicates) : "", most.replicates,
                  most.replicates == 1 ? "replicate" : "replicates", short_count(plan.evaluations()));
  if (spec.target) text += "; " + report_target(*spec.target, results.cells);
  return text + "\n";
}

}  // namespace halfslope
