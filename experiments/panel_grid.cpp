#include "experiments/panel_grid.h"

#include <algorithm>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/text_fit.h"

namespace halfslope {
namespace {

constexpr double kMargin = 22, kRight = 4, kGap = 12;
constexpr double kWidestSide = 180;

std::size_t columns_of(std::size_t count) {
  if (count == 4) return 2;
  return std::min<std::size_t>(count, count <= 6 ? 3 : count <= 16 ? 4 : 5);
}

}  // namespace

PanelGrid::PanelGrid(std::size_t count, double header, double footer)
    : columns_(columns_of(count)),
      rows_((count + columns_ - 1) / columns_),
      short_first_(count <= 6 ? count % columns_ : 0),
      header_(header),
      footer_(footer),
      side_(std::min(kWidestSide, (kPageWidth - kMargin - kRight - kGap * static_cast<double>(columns_ - 1)) /
                                      static_cast<double>(columns_))) {}

PanelGrid::Place PanelGrid::place(std::size_t k) const {
  if (k < short_first_) return {0, k};
  const std::size_t rest = k - short_first_;
  return {rest / columns_ + (short_first_ > 0 ? 1 : 0), rest % columns_};
}

Position PanelGrid::top_left(std::size_t k) const {
  const Place at = place(k);
  const std::size_t in_row = at.row == 0 && short_first_ > 0 ? short_first_ : columns_;
  const double width = static_cast<double>(in_row) * (side_ + kGap) - kGap;
  const double left = kMargin + (kPageWidth - kMargin - kRight - width) / 2;
  return {left + static_cast<double>(at.column) * (side_ + kGap), static_cast<double>(at.row) * row_height()};
}

void draw_panel_titles(Canvas& canvas, Position top_left, double side, const std::string& title,
                       const std::string& subtitle) {
  canvas.text({top_left.x, top_left.y + 9}, fitted(title, kTitleSize, side, true), {.size = kTitleSize, .bold = true});
  canvas.text({top_left.x, top_left.y + 19}, fitted(subtitle, kSmallSize, side), {.size = kSmallSize, .ink = kInkGrey});
}

}  // namespace halfslope
