// What a run's errors cost: its timings beside its results.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/work_precision.h"
#include "experiments/results.h"
#include "experiments/timing.h"

namespace halfslope {

/// A timed cell: medians over repetitions, nanoseconds a sample. Points and the rest are timed apart, so that their
/// medians need not add up to that of both.
struct TimingResult {
  CellName name;
  CellTimes times;
  MedianEstimate all, points;
  MedianEstimate evaluation;                   ///< of each repetition's all − points
  std::optional<PositiveEstimate> rmse;        ///< where it is above 0
  bool exact = false;                          ///< it is 0
  std::optional<PositiveEstimate> efficiency;  ///< 1/(rmse² · seconds an integral)
  bool certified = true;                       ///< the interval of rmse
  std::string status;                          ///< the cell's own marks, and `few-repetitions`

  PositiveEstimate seconds() const;  ///< an integral: N samples
  bool covered() const;              ///< the intervals of times have 95 %: there are enough repetitions
};

/// Of every cell that was timed; `times` are as the results' cells.
std::vector<TimingResult> timing_results(const Results& results, std::vector<CellTimes> times);

/// What one line of convergence answers.
struct LineAnswer {
  CellName line;  ///< its samples are 0
  WorkAnswer answer;

  std::string status() const;  ///< of the answer and its interval: "ok", or marks joined by ';'
};

/// The lines of one scene and precision side by side at one time or one error.
struct EqualWork {
  double at = 0;  ///< seconds an integral, or RMSE
  std::vector<LineAnswer> lines;
};

/// Errors after equal times: the time t that the fastest line with an error above 0 takes for the largest N, the
/// longest to which no line with that N has to be extrapolated, and t/4 and t/16 where some line has an answer. By
/// scene and precision, t first.
std::vector<EqualWork> equal_times(const std::vector<TimingResult>& rows);

/// Times to equal errors: the median e of the lines' errors after t, which half of them have reached then, and 2e and
/// 4e where some line has an answer. e first, always: a line whose error rises again after t may not answer it.
std::vector<EqualWork> equal_errors(const std::vector<TimingResult>& rows);

}  // namespace halfslope
