// Error against time: what each can afford, and how long it takes to a given error.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/timing.h"

namespace halfslope {

/// One N of a line of convergence: what an integral takes, and the error it leaves. All values > 0.
struct WorkPoint {
  double samples = 0;
  PositiveEstimate seconds, rmse;
  bool certified = true;  ///< the interval of rmse
};

/// Why a question has an answer or none.
enum class Reach {
  kInside,  ///< answered
  kBelow,   ///< less than the smallest N takes; or an error that the smallest N undercuts already
  kBeyond,  ///< more than the largest N takes; or an error that is not reached
};
std::string_view to_string(Reach reach);  ///< "ok", "below-range", "above-range"

/// What was read off between two measured N, or why nothing was: nothing is said of what lies beyond them.
struct WorkAnswer {
  Reach reach = Reach::kInside;
  PositiveEstimate value = {};
  double samples = 0;     ///< N there, in general between two that were measured
  bool certified = true;  ///< both neighbours are
};

/// The points of one line, read as a polyline of log rmse over log seconds.
class WorkCurve {
 public:
  /// Any order; points that take equally long count as one, the first. Without a point every answer is kBeyond.
  explicit WorkCurve(std::vector<WorkPoint> points);

  const std::vector<WorkPoint>& points() const { return points_; }  ///< ascending in seconds

  /// The error after `seconds` > 0. With w the place between the neighbours and s the slope there, the half-width on
  /// the log is that of the errors, (1 − w) h₀ + w h₁, joined in quadrature with |s| times that of the times, taken
  /// likewise. (The neighbours share samples, so their errors deviate together, and half-widths add as they are.) Of a
  /// lone point s is not known, and its own half-width stands.
  WorkAnswer error_after(double seconds) const;

  /// The time from which on the error is `rmse` > 0 or less: where the polyline falls below it for the last time. The
  /// half-width on the log is that of the times, joined in quadrature with that of the errors divided by |s|; an error
  /// that hardly falls gives a wide one.
  WorkAnswer time_until(double rmse) const;

 private:
  std::vector<WorkPoint> points_;
};

}  // namespace halfslope
