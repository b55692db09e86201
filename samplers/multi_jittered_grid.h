// What the multi-jittered sets have in common.
#pragma once

#include "samplers/pair_set.h"
#include "samplers/strata.h"
#include "samplers/stratified.h"

namespace halfslope {

/// N = a · b points in the cells of a grid of a columns and b rows: point index i stands in column i mod a and row
/// i div a. Within its column it has one of b strata of x, within its row one of a strata of y, and is uniform in that
/// box of 1/N × 1/N.
class MultiJitteredGrid {
 public:
  void prepare(const PointRequest& request, int dim) {
    words_.prepare(request);
    dim_ = dim;
    if (request.count == count_) return;
    count_ = request.count;
    strata_.reset(count_);
    grid_ = squarest_grid(count_);
  }
  const WordSource& words() const { return words_; }
  Grid grid() const { return grid_; }

  /// Fills the rows. x_stratum(column, row, lane) < b is the stratum within the column, y_stratum(column, row, lane) <
  /// a the one within the row.
  template <class XStratum, class YStratum>
  void fill(const PairRows& rows, XStratum x_stratum, YStratum y_stratum) const {
    words_.fill(Draw::kHigh, dim_, rows.begin, rows.rows, rows.x);
    if (rows.y) words_.fill(Draw::kHigh, dim_ + 1, rows.begin, rows.rows, rows.y);
    const auto a = static_cast<std::uint32_t>(grid_.columns), b = static_cast<std::uint32_t>(grid_.rows);
    for (std::size_t s = 0; s < static_cast<std::size_t>(rows.rows) * kLanes; s += kLanes) {
      std::uint32_t strata[kLanes];
      for (int l = 0; l < kLanes; ++l) {
        const std::uint32_t cell = rows.indices[s + static_cast<std::size_t>(l)], row = cell / a,
                            column = cell - row * a;
        strata[l] = column * b + x_stratum(column, row, l);
      }
      strata_.place_lanes(strata, rows.x + s);
      if (!rows.y) continue;
      for (int l = 0; l < kLanes; ++l) {
        const std::uint32_t cell = rows.indices[s + static_cast<std::size_t>(l)], row = cell / a,
                            column = cell - row * a;
        strata[l] = row * a + y_stratum(column, row, l);
      }
      strata_.place_lanes(strata, rows.y + s);
    }
  }

 private:
  WordSource words_;
  int dim_ = 0;
  std::uint64_t count_ = 0;
  Grid grid_ = {1, 1};
  Strata strata_;
};

}  // namespace halfslope
