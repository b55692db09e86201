#include "analysis/stopping.h"

#include <algorithm>
#include <cmath>

#include "analysis/normal.h"
#include "analysis/status.h"

namespace halfslope {

std::vector<std::int64_t> replicate_schedule(std::int64_t most, int steps) {
  std::vector<std::int64_t> totals;
  for (std::int64_t total = kFirstStage; total < most;) {
    totals.push_back(total);
    const auto octave = static_cast<std::int64_t>(std::log2(static_cast<double>(total / kFirstStage)));
    const std::int64_t doubling = kFirstStage << octave;  // the largest of them that is not above the total
    total += std::max(kFirstStage, doubling / steps / kFirstStage * kFirstStage);
  }
  totals.push_back(most);
  return totals;
}

std::optional<double> log_half_width(const CellStatistics& cell) {
  if (!cell.rmse || !cell.rmse_lo || !cell.rmse_hi) return std::nullopt;
  return std::max(std::log(*cell.rmse_hi / *cell.rmse), std::log(*cell.rmse / *cell.rmse_lo));
}

std::optional<double> approximate_half_width(const Moments& mse, double reference_mse) {
  const double half_width = kNormal975 * mse.standard_error() / (2 * (mse.mean - reference_mse));
  return mse.mean > reference_mse && std::isfinite(half_width) ? std::optional(half_width) : std::nullopt;
}

TargetState target_state(const CellStatistics& cell, double target) {
  const auto marked = [&](std::string_view mark) { return has_mark(cell.status, mark); };
  if (cell.invalid || marked("infinite-variance") || marked("exact") || marked("deterministic"))
    return TargetState::kNone;
  if (marked("heavy-tailed") || marked("few-replicates")) return TargetState::kOpen;
  const std::optional<double> half_width = log_half_width(cell);
  return half_width && *half_width <= std::log1p(target) ? TargetState::kReached : TargetState::kOpen;
}

double gaussian_replicates(double target) {
  const double ratio = kNormal975 / std::log1p(target);
  return ratio * ratio / 2;
}

double expected_replicates(std::int64_t replicates, double half_width, double target) {
  const double ratio = half_width / std::log1p(target);
  return static_cast<double>(replicates) * ratio * ratio;
}

}  // namespace halfslope
