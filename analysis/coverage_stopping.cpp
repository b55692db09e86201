#include "analysis/coverage_stopping.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/run_random.h"
#include "analysis/stopping.h"

namespace halfslope {
namespace {

constexpr std::int64_t kMost = 4096;
constexpr std::uint32_t kPurpose = 0x73746f70;  // of the random numbers

/// A cell whose errors are those of a simulated image, grown stage by stage.
class SimulatedCell {
 public:
  SimulatedCell(const ErrorLaw& law, int pixels, std::uint64_t seed, std::uint64_t run)
      : law_(law), random_(seed, run, kPurpose), pixels_(static_cast<std::size_t>(pixels)) {
    data_.integrals = pixels;
    data_.bootstrap_seed = run;
  }

  CellStatistics at(std::int64_t replicates) {
    for (; data_.replicates < replicates; ++data_.replicates) {
      ReplicateErrors image;
      for (Moments& pixel : pixels_) {
        const double error = law_.draw(random_);
        pixel.add(error);
        image.mse += error * error / static_cast<double>(pixels_.size());
        data_.mae += std::abs(error);  // not a mean; only that it is not 0 is looked at
      }
      data_.mse.add(image.mse);
      data_.per_replicate.push_back(image);
    }
    data_.sum_m2 = data_.sum_m2_squared = data_.sum_m4 = 0;
    for (const Moments& pixel : pixels_) {
      data_.sum_m2 += pixel.m2();
      data_.sum_m2_squared += pixel.m2() * pixel.m2();
      data_.sum_m4 += pixel.m4();
    }
    return summarise(data_);
  }

 private:
  const ErrorLaw& law_;
  RunRandom random_;
  std::vector<Moments> pixels_;
  CellData data_;
};

struct Stopped {
  CellStatistics cell;
  std::int64_t replicates;
};

Stopped run_until(SimulatedCell cell, double target) {
  for (const std::int64_t replicates : replicate_schedule(kMost)) {
    const CellStatistics statistics = cell.at(replicates);
    if (replicates == kMost || target_state(statistics, target) == TargetState::kReached)
      return {statistics, replicates};
  }
  return {};
}

}  // namespace

CoverageRow stopping_coverage(const ErrorLaw& law, int pixels, double target, const CoverageRequest& request,
                              double share) {
  struct Run {
    bool covered = false, missed = false;
    std::int64_t replicates = 0;
    double width = 0;
  };
  const double truth = std::sqrt(law.variance);
  std::vector<Run> runs(static_cast<std::size_t>(request.runs));
  const bool whole = for_each_run(request, share, [&](std::int64_t run) {
    const auto [cell, used] =
        run_until(SimulatedCell(law, pixels, request.seed, static_cast<std::uint64_t>(run)), target);
    Run& found = runs[static_cast<std::size_t>(run)];
    found.covered = cell.rmse_lo && cell.rmse_hi && *cell.rmse_lo <= truth && truth <= *cell.rmse_hi;
    found.missed = target_state(cell, target) != TargetState::kReached;
    found.replicates = used;
    if (cell.rmse_lo && cell.rmse_hi) found.width = std::log(*cell.rmse_hi / *cell.rmse_lo);
  });
  CoverageRow row;
  if (!whole) return row;
  row.number = "rmse";
  row.method = fmt::format("bootstrap-t, stopped at ±{:g} %", 100 * target);
  row.law = pixels == 1 ? law.name : fmt::format("{} pixels, {}", pixels, law.name);
  row.runs = request.runs;
  const auto count = static_cast<double>(row.runs);
  double replicates = 0;
  for (const Run& run : runs) {
    row.covered += run.covered ? 1 : 0;
    row.marked += run.missed ? 1 / count : 0;
    row.width += run.width / count;
    replicates += static_cast<double>(run.replicates) / count;
  }
  row.replicates = std::llround(replicates);
  return row;
}

std::vector<CoverageRow> stopping_coverage(const CoverageRequest& request) {
  struct Case {
    ErrorLaw law;
    int pixels;
    double target;
    bool promised;
  };
  // Where a number of the schedule is just what a target needs, half of the runs stop there and half go on; where it is
  // well above, as at ±10 % and ±5 %, nearly all stop there.
  const Case cases[] = {
      {gaussian_errors(), 1, 0.10, true},      {gaussian_errors(), 1, 0.09, true},
      {gaussian_errors(), 1, 0.08, true},      {gaussian_errors(), 1, 0.05, true},
      {gaussian_errors(), 16, 0.02, true},     {gaussian_errors(), 256, 0.01, true},
      {lognormal_errors(1.5), 1, 0.10, false},
  };
  std::vector<CoverageRow> rows;
  for (const Case& c : cases) {
    CoverageRow row = stopping_coverage(c.law, c.pixels, c.target, request, 1 / static_cast<double>(std::size(cases)));
    if (row.runs == 0) break;
    if (c.promised) row.coverage_least = 0.93, row.coverage_most = 0.96;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace halfslope
