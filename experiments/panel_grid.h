// Square panels side by side on a page.
#pragma once

#include <cstddef>

#include "analysis/canvas.h"
#include "experiments/figures.h"

namespace halfslope {

/// Where each of `count` squares of equal size stands: up to 3 in a row, of more than 6 up to 4, of more than 16 up to
/// 5, so that 24 fit a page. Where a row is not full it is the first, centred, of up to 6, else the last. Lengths in
/// points.
class PanelGrid {
 public:
  /// `header` and `footer`: the height above and below each square.
  PanelGrid(std::size_t count, double header, double footer);

  double side() const { return side_; }
  double height() const { return static_cast<double>(rows_) * row_height(); }
  /// Left of the square, top of its header.
  Position top_left(std::size_t k) const;
  bool begins_row(std::size_t k) const { return place(k).column == 0; }

 private:
  struct Place {
    std::size_t row, column;
  };
  Place place(std::size_t k) const;
  double row_height() const { return header_ + side_ + footer_; }

  std::size_t columns_, rows_;
  std::size_t short_first_;  ///< squares of the first row, where it is not full; else 0
  double header_, footer_, side_;
};

/// What is written above a square in its header of kPanelHeader points.
void draw_panel_titles(Canvas& canvas, Position top_left, double side, const std::string& title,
                       const std::string& subtitle);
inline constexpr double kPanelHeader = 25;

}  // namespace halfslope
