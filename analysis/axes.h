// Axes of a diagram: where a value lies on the canvas, and what is written beside it.
#pragma once

#include <string>
#include <vector>

#include "analysis/canvas.h"

namespace halfslope {

/// A range of values, lo < hi, on a linear or a logarithmic scale (then lo > 0).
struct Scale {
  bool log = false;
  double lo = 0, hi = 1;

  /// 0 at lo, 1 at hi.
  double fraction(double value) const;
};

/// A mark on an axis; without a label it is a short one.
struct Tick {
  double value;
  std::string label;
};

/// "10⁻³", "2¹⁰": an exponent in Unicode's superscripts.
std::string power_label(int base, int exponent);

/// Ticks of a logarithmic scale: labels at powers of `base` (2 or 10), as few of them as keep to `most_labels`, evenly
/// spaced, and bare ticks at the powers between (over up to three decades at 2 … 9 times a power of 10 too). Where
/// fewer than two powers of 10 lie in the range, 1, 2 and 5 times powers of 10 have labels, and where even these are
/// fewer than two, round numbers as of a linear scale.
std::vector<Tick> log_ticks(double lo, double hi, int base, int most_labels);

/// Round numbers, 1, 2 or 5 times a power of ten apart: the closest that give at most `most_labels`.
std::vector<Tick> linear_ticks(double lo, double hi, int most_labels);

struct Axis {
  Scale scale;
  std::vector<Tick> ticks;
  std::string label;
};

/// A frame with an x axis below and a y axis to its left.
struct Axes {
  Position top_left;
  double width, height;
  Axis x, y;

  Position at(double x_value, double y_value) const;
  /// Grid lines at the labelled ticks; draw it first.
  void draw_grid(Canvas& canvas) const;
  /// Frame, ticks, their labels and the axes' labels.
  void draw_frame(Canvas& canvas) const;
};

/// Space that an axis' ticks and labels take beside the frame, in points.
double width_of_y_axis(const Axis& y);
inline constexpr double kHeightOfXAxis = 22;

/// Where a line of slope `slope` in log–log axes, which starts at (x, y), leaves the frame; the line is drawn in thin
/// grey, and `label` is written beside its end: right of the frame, or inside, left of where it
/// leaves below.
void draw_slope_guide(Canvas& canvas, const Axes& axes, double x, double y, double slope, const std::string& label);

/// The font's sizes, in points: of panel titles, of axes' labels, and of everything smaller.
inline constexpr double kTitleSize = 8.5, kLabelSize = 7.5, kSmallSize = 6.5;

}  // namespace halfslope
