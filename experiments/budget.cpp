#include "experiments/budget.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "analysis/stopping.h"
#include "core/error.h"
#include "experiments/bytes.h"
#include "experiments/fold.h"
#include "experiments/parallel.h"
#include "experiments/stages.h"

namespace halfslope {
namespace {

/// Rounds are numbered from here in the journal, far from any unit.
constexpr std::uint64_t kFirstRound = std::uint64_t{1} << 63;

/// Seconds of a sample in a pass that was never timed, until it is: a journal cut off within its first round.
constexpr double kSecondsOfSample = 2e-8;

struct Advance {
  std::uint64_t pass = 0;
  PassWork work;  ///< of this round
};

/// What is kept of a round.
struct Round {
  double seconds = 0;  ///< from its beginning to its end
  std::vector<Advance> advances;
};

std::vector<std::byte> encode(const Round& round) {
  std::vector<std::byte> bytes;
  append_bytes(bytes, round.seconds);
  append_bytes<std::uint64_t>(bytes, round.advances.size());
  append_bytes<Advance>(bytes, std::span(round.advances));
  return bytes;
}

Round decode(std::span<const std::byte> bytes) {
  Round round;
  round.seconds = take_bytes<double>(bytes);
  const auto count = take_bytes<std::uint64_t>(bytes);
  round.advances = take_bytes<Advance>(bytes, count);
  return round;
}

/// Where a pass stands.
struct Standing {
  std::size_t stages = 0;  ///< measured
  PassWork timed;
  std::optional<double> half_width;  ///< the worst of its cells'
};

class BudgetRun {
 public:
  BudgetRun(double seconds, const Plan& plan, std::span<const Reference> references, Runner& runner)
      : budget_(seconds), plan_(plan), references_(references), runner_(runner), standings_(plan.passes.size()) {}

  std::vector<std::int64_t> run() {
    replay();
    std::vector<std::size_t> passes = unbegun();
    if (passes.empty()) {
      look(all());
      passes = choose();
    }
    const bool any = !passes.empty();
    while (!passes.empty()) {
      advance(passes);
      passes = choose();
    }
    if (any) keep({});  // what the last choice took, so that a second run has no time for another
    std::vector<std::int64_t> replicates;
    for (std::size_t p = 0; p < standings_.size(); ++p) replicates.push_back(replicates_of(p));
    return replicates;
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::int64_t replicates_of(std::size_t p) const {
    const std::size_t stages = standings_[p].stages;
    return stages == 0 ? 0 : plan_.passes[p].stages[stages - 1];
  }
  std::int64_t next_replicates_of(std::size_t p) const { return plan_.passes[p].stages[standings_[p].stages]; }
  std::vector<std::uint64_t> next_units(std::size_t p) const {
    return units_between(plan_.passes[p], replicates_of(p), next_replicates_of(p));
  }
  std::vector<std::size_t> all() const {
    std::vector<std::size_t> passes;
    for (std::size_t p = 0; p < standings_.size(); ++p) passes.push_back(p);
    return passes;
  }
  std::vector<std::size_t> unbegun() const {
    std::vector<std::size_t> passes;
    for (std::size_t p = 0; p < standings_.size(); ++p) {
      if (standings_[p].stages == 0) passes.push_back(p);
    }
    return passes;
  }

  void replay() {
    for (const Journal& journal = runner_.journal(); journal.has(kFirstRound + rounds_); ++rounds_)
      apply(decode(journal.read(kFirstRound + rounds_)));
  }

  void apply(const Round& round) {
    spent_ += round.seconds;
    for (const Advance& advance : round.advances) {
      Standing& standing = standings_.at(advance.pass);
      ++standing.stages;
      standing.timed.seconds += advance.work.seconds;
      standing.timed.evaluations += advance.work.evaluations;
    }
  }

  void keep(Round round) {
    round.seconds = std::chrono::duration<double>(Clock::now() - round_start_).count();
    round_start_ = Clock::now();
    runner_.journal().append(kFirstRound + rounds_++, encode(round));
    apply(round);
  }

  // Measures the next stage of these passes, a round.
  void advance(const std::vector<std::size_t>& passes) {
    std::vector<std::uint64_t> units;
    for (const std::size_t p : passes) {
      const auto more = next_units(p);
      units.insert(units.end(), more.begin(), more.end());
    }
    const std::vector<PassWork> before = runner_.work();
    expect_work(passes);
    try {
      runner_.run(units);
    } catch (const Error& error) {
      // The time is spent; the units that are done will be found when the round is run again.
      if (error.code() == ExitCode::kInterrupted) keep({});
      throw;
    }
    Round round;
    for (const std::size_t p : passes) {
      const PassWork& after = runner_.work()[p];
      round.advances.push_back({p, {after.seconds - before[p].seconds, after.evaluations - before[p].evaluations}});
    }
    keep(round);
    look(passes);
  }

  // For the bar: what the rest of the time is worth at the speed so far.
  void expect_work(const std::vector<std::size_t>& passes) const {
    double work = 0;
    for (const std::size_t p : passes)
      work += plan_.evaluations(plan_.passes[p], next_replicates_of(p) - replicates_of(p));
    PassWork timed;
    for (const PassWork& pass : runner_.work()) timed.seconds += pass.seconds, timed.evaluations += pass.evaluations;
    if (timed.seconds > 0)
      work = std::max(work, (budget_ - spent_) * runner_.threads() * timed.evaluations / timed.seconds);
    runner_.progress().set_total(runner_.progress().done() + work);
  }

  // The worst half-width of each pass's cells.
  void look(const std::vector<std::size_t>& passes) {
    std::vector<std::size_t> cells;
    for (std::size_t c = 0; c < plan_.cells.size(); ++c) {
      if (std::ranges::find(passes, plan_.cells[c].pass) != passes.end()) cells.push_back(c);
    }
    std::vector<std::optional<double>> half_widths(cells.size());
    with_threads(runner_.threads(), [&](int) {
      tbb::parallel_for(
          std::size_t{0}, cells.size(),
          [&](std::size_t i) {
            const Cell& cell = plan_.cells[cells[i]];
            const CellData data =
                fold_cell(plan_, cell, references_[cell.scene], runner_.journal(), replicates_of(cell.pass)).data;
            if (!data.deterministic && !data.infinite_variance)
              half_widths[i] = approximate_half_width(data.mse, data.reference_mse);
          },
          tbb::simple_partitioner());
    });
    for (const std::size_t p : passes) standings_[p].half_width.reset();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::optional<double>& worst = standings_[plan_.cells[cells[i]].pass].half_width;
      if (half_widths[i]) worst = std::max(worst.value_or(0), *half_widths[i]);
    }
  }

  // A pass's own where it was timed, else the mean of those that were.
  double seconds_of_sample(std::size_t p) const {
    PassWork timed = standings_[p].timed;
    if (timed.evaluations <= 0) {
      for (const Standing& standing : standings_) {
        timed.seconds += standing.timed.seconds;
        timed.evaluations += standing.timed.evaluations;
      }
    }
    return timed.evaluations > 0 ? timed.seconds / timed.evaluations : kSecondsOfSample;
  }

  // The next round: the most promising stages that end in time, enough of them to keep the threads busy.
  std::vector<std::size_t> choose() const {
    std::vector<StageOffer> offers;
    for (std::size_t p = 0; p < standings_.size(); ++p) {
      const Pass& pass = plan_.passes[p];
      const Standing& standing = standings_[p];
      if (standing.stages == pass.stages.size() || !standing.half_width) continue;
      const std::int64_t now = replicates_of(p), then = next_replicates_of(p);
      const std::size_t units = next_units(p).size();
      const double at_once =
          static_cast<double>(std::min<std::size_t>(units, static_cast<std::size_t>(runner_.threads())));
      const double seconds = plan_.evaluations(pass, then - now) * seconds_of_sample(p) / at_once;
      const double narrowing =
          *standing.half_width * (1 - std::sqrt(static_cast<double>(now) / static_cast<double>(then)));
      offers.push_back({p, units, seconds, narrowing});
    }
    const std::chrono::duration<double> deciding = Clock::now() - round_start_;
    return choose_stages(std::move(offers), budget_ - spent_ - deciding.count(),
                         static_cast<std::size_t>(runner_.threads()));
  }

  const double budget_;
  const Plan& plan_;
  std::span<const Reference> references_;
  Runner& runner_;
  std::vector<Standing> standings_;
  std::uint64_t rounds_ = 0;
  double spent_ = 0;
  Clock::time_point round_start_ = Clock::now();
};

}  // namespace

std::vector<std::size_t> choose_stages(std::vector<StageOffer> offers, double seconds, std::size_t units) {
  std::ranges::stable_sort(offers, [](const StageOffer& a, const StageOffer& b) {
    return a.narrowing * b.seconds > b.narrowing * a.seconds;
  });
  std::vector<std::size_t> chosen;
  std::size_t found = 0;
  for (const StageOffer& offer : offers) {
    if (found >= units) break;
    if (offer.seconds > seconds) continue;
    chosen.push_back(offer.pass);
    seconds -= offer.seconds;
    found += offer.units;
  }
  std::ranges::sort(chosen);
  return chosen;
}

std::vector<std::int64_t> measure_within_budget(double seconds, const Plan& plan, std::span<const Reference> references,
                                                Runner& runner) {
  return BudgetRun(seconds, plan, references, runner).run();
}

}  // namespace halfslope
