#include "analysis/work_precision.h"

#include <algorithm>
#include <cmath>

#include "core/assertion.h"

namespace halfslope {
namespace {

using Side = std::optional<double> (PositiveEstimate::*)() const;

/// A place between two points of the curve.
struct Between {
  const WorkPoint &a, &b;
  double w;  ///< 0 at a, 1 at b

  double mix(double x, double y) const { return x + w * (y - x); }
  /// What was measured is met exactly, and rounding leads to nothing beyond it.
  double log_mix(double x, double y) const {
    if (w == 0 || w == 1) return w == 0 ? x : y;
    return std::clamp(std::exp(mix(std::log(x), std::log(y))), std::min(x, y), std::max(x, y));
  }
  /// Half-widths as they are at a and b, empty where one that counts is.
  std::optional<double> half_width(PositiveEstimate WorkPoint::*what, Side side) const {
    const auto x = ((a.*what).*side)(), y = ((b.*what).*side)();
    if (w == 0) return x;
    if (w == 1) return y;
    return x && y ? std::optional(mix(*x, *y)) : std::nullopt;
  }
  bool exact() const { return (w < 1 && a.rmse.value == 0) || (w > 0 && b.rmse.value == 0); }
  /// |s|; empty where it is not known.
  std::optional<double> steepness() const {
    if (&a == &b || a.rmse.value == 0 || b.rmse.value == 0) return std::nullopt;
    return std::fabs(std::log(b.rmse.value / a.rmse.value) / std::log(b.seconds.value / a.seconds.value));
  }
  bool both(bool WorkPoint::*what) const { return (w == 1 || a.*what) && (w == 0 || b.*what); }
};

/// `factor` times the half-width of `other` joins that of the number itself.
WorkAnswer answer(const Between& at, PositiveEstimate WorkPoint::*what, PositiveEstimate WorkPoint::*other,
                  double factor) {
  WorkAnswer result;
  result.value.value = at.log_mix((at.a.*what).value, (at.b.*what).value);
  result.samples = at.log_mix(at.a.samples, at.b.samples);
  result.certified = at.both(&WorkPoint::certified);
  result.covered = at.both(&WorkPoint::covered);
  // The curve falls: where the other number is at its upper end, so is this one.
  const auto side = [&](Side mine) -> std::optional<double> {
    const auto own = at.half_width(what, mine), joined = at.half_width(other, mine);
    if (!own || !joined) return std::nullopt;
    return std::hypot(*own, factor * *joined);
  };
  const auto known = [](const std::optional<double>& width) { return width && *width <= std::log(kFarthestEnd); };
  if (const auto below = side(&PositiveEstimate::log_below); known(below))
    result.value.lo = result.value.value * std::exp(-*below);
  if (const auto above = side(&PositiveEstimate::log_above); known(above))
    result.value.hi = result.value.value * std::exp(*above);
  return result;
}

double place(double x, double a, double b) {
  if (x == a || x == b) return x == a ? 0 : 1;
  return std::log(x / a) / std::log(b / a);
}

}  // namespace

std::string_view to_string(Reach reach) {
  switch (reach) {
    case Reach::kBelow:
      return "below-range";
    case Reach::kBeyond:
      return "above-range";
    case Reach::kExact:
      return "exact";
    case Reach::kUnknown:
      return "no-rmse";
    case Reach::kInside:
      break;
  }
  return "ok";
}

WorkCurve::WorkCurve(std::vector<WorkPoint> points) : points_(std::move(points)) {
  for (const WorkPoint& p : points_) {
    assert_equal(p.samples > 0 && p.seconds.value > 0, true, "a point's numbers are above 0");
    assert_equal(p.rmse.value >= 0, true, "a point's error is not below 0");
  }
  std::ranges::stable_sort(points_, {}, [](const WorkPoint& p) { return p.seconds.value; });
  const auto [first, last] = std::ranges::unique(points_, {}, [](const WorkPoint& p) { return p.seconds.value; });
  points_.erase(first, last);
}

WorkAnswer WorkCurve::error_after(double seconds) const {
  if (points_.empty()) return {Reach::kUnknown};
  if (seconds < points_.front().seconds.value) return {Reach::kBelow};
  if (seconds > points_.back().seconds.value) return {points_.back().rmse.value == 0 ? Reach::kExact : Reach::kBeyond};
  std::size_t k = std::min<std::size_t>(1, points_.size() - 1);
  while (points_[k].seconds.value < seconds) ++k;
  const WorkPoint &a = points_[k == 0 ? 0 : k - 1], &b = points_[k];
  const Between at = {a, b, place(seconds, a.seconds.value, b.seconds.value)};
  if (at.exact()) return {Reach::kExact};
  return answer(at, &WorkPoint::rmse, &WorkPoint::seconds, at.steepness().value_or(0));
}

WorkAnswer WorkCurve::time_until(double rmse) const {
  if (points_.empty()) return {Reach::kUnknown};
  if (points_.back().rmse.value > rmse) return {Reach::kBeyond};
  std::size_t k = points_.size() - 1;  // the first of those from which on the error is small enough
  while (k > 0 && points_[k - 1].rmse.value <= rmse) --k;
  if (points_[k].rmse.value == 0) return {Reach::kExact};
  if (k == 0 && points_[0].rmse.value < rmse) return {Reach::kBelow};
  const WorkPoint &a = points_[k == 0 ? 0 : k - 1],
                  &b = points_[k == 0 ? std::min<std::size_t>(1, points_.size() - 1) : k];
  const Between at = {a, b, k == 0 ? 0 : place(rmse, a.rmse.value, b.rmse.value)};
  const std::optional<double> steepness = at.steepness();
  return answer(at, &WorkPoint::seconds, &WorkPoint::rmse, steepness ? 1 / *steepness : 0);
}

}  // namespace halfslope
