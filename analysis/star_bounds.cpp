#include "analysis/star_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/box_search.h"
#include "analysis/critical_boxes.h"
#include "analysis/threshold_accepting.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

// A coordinate takes 100 bytes, and both searches up to a gigabyte each.
constexpr std::size_t kMostCoordinates = std::size_t{1} << 24, kMostSearched = std::size_t{1} << 22;
constexpr std::uint64_t kMostSteps = 80000;  // of a walk: more find little more

/// The largest excess found for an eighth of the work at most. (A step takes as long as about 40 looks at a point in
/// each dimension, and one more for every 160 points.)
double walk(const CriticalBoxes& full, const CriticalBoxes& empty, std::uint64_t& work) {
  const std::uint64_t step = full.dims() * (full.count() / 160 + 40);
  const std::uint64_t steps = std::min(kMostSteps, work / 16 / step + 1);
  work -= std::min(work, 2 * steps * step);
  return std::max(threshold_accepting(full, steps), threshold_accepting(empty, steps));
}

/// `found` is rounded down: a volume is a product of so many numbers.
StarBounds between(double found, double upper, std::size_t dims) {
  return {found - static_cast<double>(dims + 2) * 0x1p-53, std::min(1.0, upper), false};
}

class Searches {
 public:
  Searches(const PointSet& points, std::uint64_t work)
      : full_(points, Side::kFullest),
        empty_(points, Side::kEmptiest),
        search_full_(full_),
        search_empty_(empty_),
        work_(work) {}

  /// Exact where a search ends that passes over nothing; else a threshold that no box is above. Higher thresholds take
  /// less work, which goes about as a power of them: the searches so far foretell it.
  StarBounds bracket() {
    if (none_above(0, work_ / 16)) return bounds(best_);
    best_ = std::max(best_, walk(full_, empty_, work_));
    double threshold = (1 + best_) / 2;
    while (!none_above(threshold, work_ / 4)) {
      threshold = (1 + threshold) / 2;
      if (threshold > 0.99) return bounds(1);
    }
    bool hope = true;  // of an end
    for (double power = static_cast<double>(full_.dims()) / 2; threshold > best_;) {
      const auto left = static_cast<double>(work_);
      const double growth = std::min(4.0, 0.8 * left / spent_);
      const bool all = hope && spent_ * std::pow(threshold / best_, power) < 0.6 * left;
      if (!all && growth < 1.1) break;
      const double next = all ? best_ : std::max(best_, threshold * std::pow(growth, -1 / power));
      const double before = spent_;
      if (none_above(next, all ? work_ / 4 * 3 : work_)) {
        power = std::max(1.0, std::log(spent_ / before) / std::log(threshold / next));
        threshold = std::max(next, best_);
      } else if (all) {
        hope = false, spent_ = before;
      } else {
        break;
      }
    }
    return bounds(threshold);
  }

 private:
  bool none_above(double threshold, std::uint64_t most) {
    std::uint64_t left = most;
    const bool none = search_full_.run(threshold, best_, left) && search_empty_.run(threshold, best_, left);
    work_ -= most - left;
    spent_ = static_cast<double>(most - left);
    return none;
  }
  StarBounds bounds(double threshold) const {
    if (threshold <= best_) return {best_, best_, true};
    return between(best_, threshold + BoxSearch::kTolerance, full_.dims());
  }

  CriticalBoxes full_, empty_;
  BoxSearch search_full_, search_empty_;
  std::uint64_t work_;
  double best_ = 0, spent_ = 0;
};

}  // namespace

StarBounds star_bounds(const PointSet& points, std::uint64_t work) {
  assert_equal(star_refusal(points.count(), points.dims()), std::string(), "memory for the star discrepancy");
  if (points.dims() <= 2) {
    const double star = star_discrepancy(points);
    return {star, star, true};
  }
  if (points.dims() <= BoxSearch::kMostDims) return Searches(points, work).bracket();
  return between(walk({points, Side::kFullest}, {points, Side::kEmptiest}, work), 1, points.dims());
}

std::string_view star_method(const StarBounds& bounds) {
  if (bounds.exact) return "exact";
  return bounds.upper < 1 ? "bounds: threshold accepting, branch and bound" : "bounds: threshold accepting";
}

std::string star_refusal(std::size_t count, std::size_t dims) {
  const std::size_t most = dims <= 2 ? kMostCoordinates : kMostSearched;
  if (count <= most / dims) return {};
  return fmt::format(
      "it takes at most {} coordinates (N times the dimensions) in {} dimensions, for which it needs {} GB", most, dims,
      dims <= 2 ? 4 : 1);
}

}  // namespace halfslope
