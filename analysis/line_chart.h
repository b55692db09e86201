// Diagrams of lines with intervals: errors or discrepancies against N, pair correlations, spectra.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/axes.h"
#include "analysis/canvas.h"
#include "analysis/intervals.h"

namespace halfslope {

/// A value that is not finite is a gap in its line; so is one ≤ 0 of a logarithmic scale.
struct ChartPoint {
  double x, y;
  std::optional<double> lo = std::nullopt, hi = std::nullopt;  ///< of the 95 % interval, as far as it is known
  bool hollow = false;                                         ///< its marker
  std::optional<double> x_lo = std::nullopt,
                        x_hi = std::nullopt;  ///< of the interval of x, where that is estimated too
};

struct ChartLine {
  std::string name;                ///< in full, which SVG viewers show
  std::string label;               ///< in the legend
  std::string note;                ///< at the end of the same line of the legend
  std::size_t look;                ///< index into looks()
  std::vector<ChartPoint> points;  ///< ascending in x
};

/// Bars with a marker at every point; or, for curves of many points, bands, with a marker now and then that tells the
/// lines of one chart apart.
enum class Intervals { kBars, kBands };

/// A line across at a height: thin, or dotted where it has a label, which stands to the right.
struct Level {
  double y;
  std::string label = {};
};

/// What is drawn around and between the lines.
struct ChartStyle {
  std::string x_label, y_label;
  bool log_x = true, log_y = true;  ///< else linear; a linear x begins at 0
  Intervals intervals = Intervals::kBars;
  std::vector<double> slopes = {};               ///< of dotted guides; for logarithmic scales
  std::vector<Level> levels = {};                ///< for a linear y scale
  std::optional<double> y_least = std::nullopt;  ///< where a linear y scale begins
  double y_reach =
      std::numeric_limits<double>::infinity();              ///< beyond all points, in which a linear y counts intervals
  double y_most = std::numeric_limits<double>::infinity();  ///< lines are cut off above
  /// A second scale above the frame, x / x_above_unit, with this label; none where it is empty.
  std::string x_above_label = {};
  double x_above_unit = 1;
};

struct LineChart {
  std::string title;  ///< may be empty
  std::string group;  ///< charts of one group have the same scales
  ChartStyle style;
  std::vector<ChartLine> lines;
};

/// The scales that hold every point of the group, and ticks. Intervals of logarithmic scales reach no further than a
/// factor of 4 beyond all points: one that knows nothing must not squeeze the rest. Empty where there is no point.
struct ChartScales {
  Axis x, y;
  std::optional<Axis> x_above;
};
std::optional<ChartScales> chart_scales(std::span<const LineChart> charts, const std::string& group);

/// Whether labels stand right of the frame.
bool has_labelled_guides(const ChartStyle& style);

/// Space above the frame that the second scale takes, in points.
double height_above(const ChartStyle& style);

/// Grid, guides, frame and lines; each line is a group of its name.
void draw_chart(Canvas& canvas, const Axes& axes, const std::optional<Axis>& x_above, const LineChart& chart);

/// A line for each line of the chart, the first one kLegendLine below `at`; notes end `width` right of it, under
/// `notes_title`, which stands at `at`'s height.
void draw_legend(Canvas& canvas, const LineChart& chart, Position at, double width, const std::string& notes_title);
inline constexpr double kLegendLine = 9.5;
double legend_width(const LineChart& chart);

/// "−½", "−¾", "−3/2", "−0.625".
std::string slope_label(double slope);

/// "−0.50 [−0.62, −0.40]", as far as it is known; `before` and `after` stand at the interval.
std::string slope_note(double slope, const std::optional<Interval>& interval, const std::string& before = "",
                       const std::string& after = "");

}  // namespace halfslope
