#include "analysis/discrepancy.h"
#include "core/assertion.h"

namespace halfslope {

PointSet::PointSet(std::vector<std::span<const double>> columns) : columns_(std::move(columns)) {
  assert_equal(columns_.empty(), false, "a point set without dimensions");
  assert_equal(columns_.front().empty(), false, "a point set without points");
  for (const auto& column : columns_) {
    assert_equal(column.size(), columns_.front().size(), "points in every dimension");
    for (const double x : column) assert_equal(x >= 0 && x <= 1, true, "a coordinate lies in [0, 1]");
  }
}

}  // namespace halfslope
