// Error against time: what each can afford, and how long it takes to a given error.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/timing.h"

namespace halfslope {

/// One N of a line of convergence: what an integral takes, and the error it leaves. Values > 0; an rmse of 0 is that of
/// errors that are all 0.
struct WorkPoint {
  double samples = 0;
  PositiveEstimate seconds, rmse;
  bool certified = true;  ///< the interval of rmse
  bool covered = true;    ///< that of seconds has the 95 % it is called after
};

/// Why a question has an answer or none.
enum class Reach {
  kInside,  ///< answered
  kBelow,   ///< less than the smallest N takes; or an error that the smallest N undercuts already
  kBeyond,  ///< more than the largest N takes; or an error that is not reached
  kExact,   ///< the error there is 0, or that of a neighbour is: it is reached, and no logarithm says what lies between
  kUnknown,  ///< no error of the line is known
};
std::string_view to_string(Reach reach);  ///< "ok", "below-range", "above-range", "exact", "no-rmse"

/// What was read off between two measured N, or why nothing was: nothing is said of what lies beyond them.
struct WorkAnswer {
  Reach reach = Reach::kInside;
  PositiveEstimate value = {};
  double samples = 0;     ///< N there, in general between two that were measured
  bool certified = true;  ///< both neighbours are
  bool covered = true;    ///< likewise
};

/// The points of one line, read as a polyline of log rmse over log seconds.
class WorkCurve {
 public:
  /// Any order; points that take equally long count as one, the first. Without a point every answer is kUnknown.
  explicit WorkCurve(std::vector<WorkPoint> points);

  const std::vector<WorkPoint>& points() const { return points_; }  ///< ascending in seconds

  /// The error after `seconds` > 0. With w the place between the neighbours and s the slope there, the half-width on
  /// the log is that of the errors, (1 − w) h₀ + w h₁, joined in quadrature with |s| times that of the times, taken
  /// likewise. (The neighbours share samples, so their errors deviate together, and half-widths add as they are.) Of a
  /// lone point, and beside an error of 0, s is not known, and the point's own half-width stands. At a point itself the
  /// answer is its own numbers, bit by bit; an end further than kFarthestEnd is empty.
  WorkAnswer error_after(double seconds) const;

  /// The time from which on the error is `rmse` > 0 or less: where the polyline falls below it for the last time. The
  /// half-width on the log is that of the times, joined in quadrature with that of the errors divided by |s|; an error
  /// that hardly falls gives a wide one.
  WorkAnswer time_until(double rmse) const;

 private:
  std::vector<WorkPoint> points_;
};

}  // namespace halfslope
