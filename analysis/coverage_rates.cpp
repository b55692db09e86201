#include "analysis/coverage_rates.h"

#include <optional>

#include "core/random.h"

namespace halfslope {
namespace {

constexpr std::uint32_t kPurpose = 0x52415445;  // of RunRandom: "RATE"

const char* use_text(ReferenceUse use) {
  switch (use) {
    case ReferenceUse::kCarried:
      return "";
    case ReferenceUse::kSubtracted:
      return ", V̄ taken as exact";
    case ReferenceUse::kIgnored:
      return ", reference ignored";
  }
  return "";
}

/// The intervals of one kind of fit over all runs.
struct Outcomes {
  std::vector<std::optional<Interval>> intervals;
  std::vector<char> marked;

  explicit Outcomes(std::int64_t runs)
      : intervals(static_cast<std::size_t>(runs)), marked(static_cast<std::size_t>(runs)) {}

  CoverageRow row(std::string method, std::string law, double rate, std::int64_t replicates) const {
    CoverageRow row;
    row.number = "rate";
    row.method = std::move(method);
    row.law = std::move(law);
    row.replicates = replicates;
    row.runs = std::ssize(intervals);
    std::int64_t found = 0, marks = 0;
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      marks += marked[i];
      if (!intervals[i]) continue;
      ++found;
      row.width += intervals[i]->hi - intervals[i]->lo;
      row.covered += intervals[i]->lo <= rate && rate <= intervals[i]->hi;
    }
    if (found > 0) row.width /= static_cast<double>(found);
    row.marked = static_cast<double>(marks) / static_cast<double>(row.runs);
    return row;
  }
};

std::uint64_t run_seed(const CoverageRequest& request, std::int64_t run) {
  return hash_text("rate", request.seed + static_cast<std::uint64_t>(run));
}

void promise(std::vector<CoverageRow>& rows, double coverage_least, double coverage_most) {
  for (CoverageRow& row : rows) row.coverage_least = coverage_least, row.coverage_most = coverage_most;
}

}  // namespace

std::vector<CoverageRow> measure_rates(const RateLaw& law, std::int64_t replicates, ReferenceUse use,
                                       const CoverageRequest& request, double share) {
  Outcomes plain(request.runs), window(request.runs);
  const bool done = for_each_run(request, share, [&](std::int64_t run) {
    RunRandom random(request.seed, static_cast<std::uint64_t>(run), kPurpose);
    RateData data = law.draw(replicates, random);
    if (use == ReferenceUse::kSubtracted) data.reference.mse_variance = 0;
    if (use == ReferenceUse::kIgnored) data.reference = {};
    const LineRates rates = analyse_rates(data, run_seed(request, run));
    const auto i = static_cast<std::size_t>(run);
    plain.intervals[i] = rates.plain.interval;
    if (rates.window) window.intervals[i] = rates.window->interval;
    plain.marked[i] = window.marked[i] = rates.plain.status != "ok";
  });
  if (!done) return {};
  const std::string name = law.name + use_text(use);
  return {plain.row("least squares", name, law.rate, replicates),
          window.row("weighted, window", name, law.rate, replicates)};
}

std::vector<CoverageRow> measure_variance_rate(std::int64_t replicates, const CoverageRequest& request, double share) {
  const RateLaw law = walk_spread();
  Outcomes outcomes(request.runs);
  const bool done = for_each_run(request, share, [&](std::int64_t run) {
    RunRandom random(request.seed, static_cast<std::uint64_t>(run), kPurpose);
    const RateFit fit = fit_rate(law.draw(replicates, random), run_seed(request, run));
    outcomes.intervals[static_cast<std::size_t>(run)] = fit.interval;
    outcomes.marked[static_cast<std::size_t>(run)] = fit.status != "ok";
  });
  if (!done) return {};
  return {outcomes.row("sample variance", law.name, law.rate, replicates)};
}

std::vector<CoverageRow> rate_coverage(const CoverageRequest& request) {
  std::vector<CoverageRow> rows;
  constexpr double kParts = 21, kShare = 1 / kParts;
  const auto add = [&](std::vector<CoverageRow> more) {
    rows.insert(rows.end(), more.begin(), more.end());
    return !more.empty();
  };
  for (const std::int64_t replicates : {16, 64, 256}) {
    for (const RateLaw& law : {walks(), owen_like(1.65), owen_like(2)}) {
      std::vector<CoverageRow> measured = measure_rates(law, replicates, ReferenceUse::kCarried, request, kShare);
      promise(measured, replicates == 16 ? 0.92 : 0.925, replicates == 16 ? 1 : 0.975);
      if (!add(std::move(measured))) return rows;
    }
    std::vector<CoverageRow> measured = measure_variance_rate(replicates, request, kShare);
    promise(measured, replicates == 16 ? 0.92 : 0.925, replicates == 16 ? 1 : 0.975);
    if (!add(std::move(measured))) return rows;
    // With a floor the plain fit is refused, and the window's has the rate above it.
    for (const RateLaw& law : {biased(), rounded()}) {
      measured =
          measure_rates(law, replicates, ReferenceUse::kCarried, request, replicates == 256 ? kShare / 2 : kShare);
      if (replicates > 16) {
        measured[0].coverage_most = 0.01;
        measured[0].marked_least = measured[1].marked_least = 0.98;
        measured[1].coverage_least = 0.9;
      }
      if (!add(std::move(measured))) return rows;
    }
  }
  constexpr std::int64_t kPixels = 64;
  for (const std::int64_t pixels : {std::int64_t{1}, kPixels}) {
    for (const ReferenceUse use : {ReferenceUse::kCarried, ReferenceUse::kSubtracted, ReferenceUse::kIgnored}) {
      std::vector<CoverageRow> measured = measure_rates(walks(pixels, 4), 256, use, request, kShare / 2);
      if (use == ReferenceUse::kCarried) promise(measured, 0.925, 0.975);
      if (!add(std::move(measured))) return rows;
    }
    std::vector<CoverageRow> refused =
        measure_rates(walks(pixels, 1), 256, ReferenceUse::kCarried, request, kShare / 2);
    if (!refused.empty()) {
      refused[0].coverage_most = 0.001;
      refused[0].marked_least = refused[1].marked_least = 0.99;
    }
    if (!add(std::move(refused))) return rows;
  }
  return rows;
}

}  // namespace halfslope
