#include "analysis/coverage.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "analysis/coverage_comparisons.h"
#include "analysis/coverage_intervals.h"
#include "analysis/coverage_rates.h"
#include "analysis/coverage_stopping.h"
#include "analysis/coverage_timing.h"

namespace halfslope {

std::span<const CoverageStudyInfo> coverage_studies() {
  static constexpr CoverageStudyInfo kStudies[] = {
      {"intervals", "of the RMSE by every method, and of the mean; and the heavy-tail mark", interval_coverage, 20000},
      {"rates", "of rates: every law, reference and floor that fits are promised for", rate_coverage, 4000},
      {"comparisons", "of the ratios of mean squared errors; false alarms of families, and differences found",
       comparison_coverage, 4000},
      {"stopping", "of an RMSE whose interval decided how many replicates there are", stopping_coverage, 4000},
      {"timing", "of medians of times, and of efficiencies", timing_coverage, 4000},
  };
  return kStudies;
}

bool keeps_promise(const CoverageRow& row) {
  constexpr double kPromisedRuns = 20000;
  const auto runs = static_cast<double>(row.runs);
  const auto slack = [&](double bound) {
    return 5 * std::sqrt(bound * (1 - bound)) * std::max(0.0, 1 / std::sqrt(runs) - 1 / std::sqrt(kPromisedRuns));
  };
  const auto within = [&](double share, double least, double most) {
    return share >= least - slack(least) && share <= most + slack(most);
  };
  return within(row.coverage(), row.coverage_least, row.coverage_most) &&
         within(row.marked, row.marked_least, row.marked_most);
}

bool for_each_run(const CoverageRequest& request, double share, const std::function<void(std::int64_t run)>& body) {
  constexpr std::int64_t kBlock = 50;  // runs; small beside what two calls of `progress` may be apart
  const int threads = request.threads > 0 ? request.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  std::atomic<bool> stopped = false;
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, request.runs, kBlock),
        [&](const tbb::blocked_range<std::int64_t>& block) {
          if (stopped) return;
          for (std::int64_t run = block.begin(); run < block.end(); ++run) body(run);
          const auto done = static_cast<double>(block.size()) / static_cast<double>(request.runs);
          if (request.progress && !request.progress(share * done)) stopped = true;
        },
        tbb::simple_partitioner());
  });
  return !stopped;
}

}  // namespace halfslope
