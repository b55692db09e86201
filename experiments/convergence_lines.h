// The lines of a convergence diagram, as a run folder's tables hold them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/intervals.h"

namespace halfslope {

/// Which rows to take; an empty list takes all.
struct LineFilter {
  std::vector<std::string> scenes, estimators, samplers, precisions;
};

/// RMSE at one N. A row without an rmse (reference-limited, invalid) or with one of 0 (exact) is no point.
struct LinePoint {
  double samples, rmse;
  std::optional<double> lo, hi;  ///< of the 95 % interval, as far as the table has it
  bool certified;                ///< its status is `ok` or `deterministic`
  /// An integral takes, and the ends of the interval; from timing.csv, by read_times().
  std::optional<double> seconds = std::nullopt, seconds_lo = std::nullopt, seconds_hi = std::nullopt;
};

/// From the least to the largest of some N.
struct SamplesRange {
  double lo, hi;
};

/// The slope between two neighbouring N.
struct LocalRatePoint {
  double samples_lo, samples_hi, rate;
  std::optional<double> lo, hi;  ///< of the 95 % interval, as far as the table has it
  bool certified;                ///< its status is `ok` or `deterministic`
};

struct ConvergenceLine {
  std::string scene, estimator, sampler, precision;
  std::vector<LinePoint> points = {};  ///< ascending in N
  std::size_t left_out = 0;            ///< rows that are no points
  std::string status = {};             ///< of the first of them
  std::optional<double> rate = std::nullopt;
  std::optional<Interval> rate_interval = std::nullopt;
  std::string rate_status = {};  ///< empty where rates.csv has no row for the line
  std::optional<double> theory = std::nullopt;
  /// Where the errors follow a line, if that is less than all N; from the table's further rows.
  std::optional<SamplesRange> window = std::nullopt;
  std::vector<LocalRatePoint> local_rates = {};  ///< ascending in N; from local_rates.csv, by read_local_rates()
};

/// What a run folder's convergence.csv and, if it is there, rates.csv say of each (scene, estimator, sampler,
/// precision), in the table's order; of several rates, that over the widest range of N. Lines without a single point
/// are kept. Throws Error(kBadInput) that says what to do where the folder has no table, the table is broken, or the
/// filter leaves nothing.
std::vector<ConvergenceLine> read_convergence_lines(const std::filesystem::path& run_folder, const LineFilter& filter);

/// Adds what timing.csv says to the lines' points; a point that it does not have is left out and counted so. Error
/// (kBadInput) where the folder has no timing.csv, or a broken one.
void read_times(const std::filesystem::path& run_folder, std::vector<ConvergenceLine>& lines);

/// Adds what local_rates.csv says to the lines. Error(kBadInput) where the folder has none, or a broken one.
void read_local_rates(const std::filesystem::path& run_folder, std::vector<ConvergenceLine>& lines);

/// The `name` in a run folder's manifest.json, or the folder's own where there is none to read.
std::string run_name(const std::filesystem::path& run_folder);

}  // namespace halfslope
