#include "analysis/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "analysis/typeface.h"
#include "core/numbers.h"

namespace halfslope {
namespace {

constexpr double kSample = 18;  // of a line in the legend
constexpr double kBandOpacity = 0.2;
constexpr std::size_t kMarkersOfCurve = 7;

/// The least and the greatest of some values.
struct Range {
  double lo = std::numeric_limits<double>::infinity(), hi = -std::numeric_limits<double>::infinity();
  void add(double x) {
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
  bool empty() const { return !(lo <= hi); }
};

bool drawn(const ChartPoint& p, const ChartStyle& style) { return std::isfinite(p.y) && (!style.log_y || p.y > 0); }

/// A lone curve needs none to be told from others.
bool has_markers(const LineChart& chart) { return chart.style.intervals == Intervals::kBars || chart.lines.size() > 1; }

/// A power of two, or halfway between two of them on a logarithmic scale.
bool power_of_two(double x) {
  const double twice = 2 * std::log2(x);
  return x >= 1 && std::abs(twice - std::round(twice)) < 1e-12;
}

Axis log_x_axis(const Range& range, bool powers_of_two, const std::string& label) {
  const double pad = range.hi > range.lo ? std::pow(range.hi / range.lo, 0.05) : 2;
  Axis axis{{true, range.lo / pad, range.hi * pad}, {}, label};
  axis.ticks = log_ticks(axis.scale.lo, axis.scale.hi, powers_of_two && range.hi > range.lo ? 2 : 10, 6);
  if (axis.scale.lo > 1e-3 && axis.scale.hi < 20000) {  // short enough to be written out
    for (Tick& tick : axis.ticks) {
      if (!tick.label.empty()) tick.label = format_number(std::round(tick.value * 1e6) / 1e6);
    }
  }
  return axis;
}

Axis log_y_axis(Range points, const Range& ends, const std::string& label) {
  if (!ends.empty()) {
    const Range alone = points;
    points.add(std::max(ends.lo, alone.lo / 4));
    points.add(std::min(ends.hi, alone.hi * 4));
  }
  const double pad = std::max(1.5, std::pow(points.hi / points.lo, 0.06));
  Axis axis{{true, points.lo / pad, points.hi * pad}, {}, label};
  axis.ticks = log_ticks(axis.scale.lo, axis.scale.hi, 10, 6);
  return axis;
}

Axis linear_y_axis(Range range, const Range& ends, const ChartStyle& style) {
  if (!ends.empty()) {
    const Range alone = range;
    range.add(std::max(ends.lo, alone.lo - style.y_reach));
    range.add(std::min(ends.hi, alone.hi + style.y_reach));
  }
  for (const Level& level : style.levels) range.add(level.y);
  const double span = range.hi > range.lo ? range.hi - range.lo : 1;
  const double lo = style.y_least.value_or(range.lo - 0.06 * span), hi = std::min(range.hi + 0.06 * span, style.y_most);
  Axis axis{{false, lo, hi}, {}, style.y_label};
  axis.ticks = linear_ticks(lo, hi, 7);
  return axis;
}

double middle(double lo, double hi, double at) { return lo + (hi - lo) * at; }

/// A line through points of the canvas, without what lies above `top` or below `bottom`, and with gaps where y is NaN.
void draw_cut_line(Canvas& canvas, const std::vector<Position>& points, double top, double bottom,
                   const Stroke& stroke) {
  std::vector<Position> piece;
  const auto end_piece = [&] {
    if (piece.size() > 1) canvas.line(piece, stroke);
    piece.clear();
  };
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Position &a = points[k], &b = points[k + 1];
    // The part of a … b between the two heights, as fractions of the way.
    double from = 0, to = 1;
    const double rise = b.y - a.y;
    if (std::isnan(rise)) {
      end_piece();
      continue;
    }
    for (const double edge : {top, bottom}) {
      const double inside = edge == top ? 1 : -1, da = inside * (a.y - edge), db = inside * (b.y - edge);
      if (da < 0 && db < 0) to = -1;
      if (da < 0 && db >= 0) from = std::max(from, (edge - a.y) / rise);
      if (da >= 0 && db < 0) to = std::min(to, (edge - a.y) / rise);
    }
    if (!(from <= to)) {
      end_piece();
      continue;
    }
    if (from > 0) end_piece();
    const auto at = [&](double t) {
      return Position{middle(a.x, b.x, t), t == 0 ? a.y : t == 1 ? b.y : a.y + rise * t};
    };
    if (piece.empty()) piece.push_back(at(from));
    piece.push_back(at(to));
    if (to < 1) end_piece();
  }
  end_piece();
}

/// A bar along x, with caps.
void draw_x_bar(Canvas& canvas, const Axes& axes, const ChartPoint& p, const Stroke& stroke) {
  const Position left = axes.at(*p.x_lo, p.y), right = axes.at(*p.x_hi, p.y);
  canvas.line({left, right}, stroke);
  for (const Position& end : {left, right}) canvas.line({{end.x, end.y - 1.5}, {end.x, end.y + 1.5}}, stroke);
}

/// Bars and caps of the points' intervals, cut where the frame ends.
void draw_bars(Canvas& canvas, const Axes& axes, const ChartLine& line, const ChartStyle& style, const Stroke& stroke) {
  const double lowest = axes.y.scale.lo, highest = axes.y.scale.hi;
  for (const ChartPoint& p : line.points) {
    if (p.x_lo && p.x_hi && drawn(p, style)) draw_x_bar(canvas, axes, p, stroke);
    if (!p.hi || !drawn(p, style)) continue;
    const double lo = std::max(p.lo.value_or(lowest), lowest), hi = std::min(*p.hi, highest);
    const Position low = axes.at(p.x, lo), high = axes.at(p.x, hi);
    canvas.line({low, high}, stroke);
    for (const auto& [end, cut] : {std::pair(low, !p.lo || *p.lo < lowest), std::pair(high, *p.hi > highest)}) {
      if (!cut) canvas.line({{end.x - 1.5, end.y}, {end.x + 1.5, end.y}}, stroke);
    }
  }
}

/// The area between the intervals' ends, a polygon for each run of points that have one.
void draw_bands(Canvas& canvas, const Axes& axes, const ChartLine& line, const ChartStyle& style, const Ink& ink) {
  std::vector<Position> above, below;
  const auto end_band = [&] {
    if (above.size() > 1) {
      above.insert(above.end(), below.rbegin(), below.rend());
      canvas.polygon(above, {.fill = ink, .opacity = kBandOpacity});
    }
    above.clear(), below.clear();
  };
  const auto inside = [&](double y) { return std::clamp(y, axes.y.scale.lo, axes.y.scale.hi); };
  for (const ChartPoint& p : line.points) {
    if (p.lo && p.hi && drawn(p, style)) {
      above.push_back(axes.at(p.x, inside(*p.hi)));
      below.push_back(axes.at(p.x, inside(*p.lo)));
    } else {
      end_band();
    }
  }
  end_band();
}

void draw_line(Canvas& canvas, const Axes& axes, const ChartStyle& style, const ChartLine& line, bool markers) {
  const Look& look = looks()[line.look];
  const double top = axes.top_left.y, bottom = top + axes.height;
  const bool curve = style.intervals == Intervals::kBands;
  canvas.begin_group(line.name);
  std::vector<Position> points;
  for (const ChartPoint& p : line.points) {
    points.push_back(axes.at(p.x, drawn(p, style) ? p.y : std::numeric_limits<double>::quiet_NaN()));
  }
  if (curve) draw_bands(canvas, axes, line, style, look.ink);
  draw_cut_line(canvas, points, top, bottom, {look.ink, 0.9, look.dashes});
  if (!curve) draw_bars(canvas, axes, line, style, {look.ink, 0.5});
  if (!markers) return canvas.end_group();
  // Of a curve, each line marks points of its own, so that markers of lines that run together lie side by side.
  const std::size_t step = curve ? std::max<std::size_t>(1, points.size() / kMarkersOfCurve) : 1;
  for (std::size_t k = step * (2 * line.look + 1) / (2 * looks().size()); k < points.size(); k += step) {
    if (points[k].y >= top && points[k].y <= bottom) draw_marker(canvas, points[k], 1.7, look, line.points[k].hollow);
  }
  canvas.end_group();
}

void draw_guides(Canvas& canvas, const Axes& axes, const LineChart& chart) {
  Range first, samples;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& p : line.points) samples.add(p.x);
    const auto begin = std::find_if(line.points.begin(), line.points.end(),
                                    [&](const ChartPoint& p) { return drawn(p, chart.style); });
    if (begin != line.points.end()) first.add(begin->y);
  }
  if (first.empty()) return;
  const double start = 1.25 * first.hi;  // from above the first points, so that they run beside the lines
  for (const double slope : chart.style.slopes)
    draw_slope_guide(canvas, axes, samples.lo, start, slope, slope_label(slope));
}

void draw_levels(Canvas& canvas, const Axes& axes, const std::vector<Level>& levels) {
  for (const auto& [y, label] : levels) {
    const Position left = axes.at(axes.x.scale.lo, y), right = axes.at(axes.x.scale.hi, y);
    canvas.line({left, right}, label.empty() ? Stroke{kInkGrey, 0.8} : Stroke{kInkGrey, 0.5, {1, 1.6}});
    canvas.text({right.x + 2, right.y + 0.36 * kSmallSize}, label, {.size = kSmallSize, .ink = kInkGrey});
  }
}

void draw_x_above(Canvas& canvas, const Axes& axes, const Axis& above) {
  const double top = axes.top_left.y;
  for (const Tick& tick : above.ticks) {
    const double px = axes.top_left.x + axes.width * above.scale.fraction(tick.value);
    canvas.line({{px, top - 3}, {px, top}}, {kBlack, 0.6});
    canvas.text({px, top - 4.5}, tick.label, {.size = kSmallSize, .anchor = Anchor::kMiddle});
  }
  canvas.text({axes.top_left.x + axes.width / 2, top - 13}, above.label,
              {.size = kLabelSize, .anchor = Anchor::kMiddle});
}

}  // namespace

std::optional<ChartScales> chart_scales(std::span<const LineChart> charts, const std::string& group) {
  Range x, y, ends;
  bool powers = true;
  const ChartStyle* style = nullptr;
  for (const LineChart& chart : charts) {
    if (chart.group != group) continue;
    style = &chart.style;
    for (const ChartLine& line : chart.lines) {
      for (const ChartPoint& p : line.points) {
        if (!drawn(p, *style)) continue;
        for (const double at : {p.x, p.x_lo.value_or(p.x), p.x_hi.value_or(p.x)}) x.add(at);
        y.add(p.y);
        powers = powers && power_of_two(p.x);
        for (const auto& end : {p.lo, p.hi}) {
          if (end && std::isfinite(*end) && (!style->log_y || *end > 0)) ends.add(*end);
        }
      }
    }
  }
  if (x.empty()) return std::nullopt;
  const Axis vertical = style->log_y ? log_y_axis(y, ends, style->y_label) : linear_y_axis(y, ends, *style);
  if (style->log_x) return ChartScales{log_x_axis(x, powers, style->x_label), vertical, {}};
  // A scale that ends just short of a round number ends there.
  double hi = x.hi > 0 ? x.hi : 1;
  if (const auto ticks = linear_ticks(0, 1.02 * hi, 7); !ticks.empty()) hi = std::max(hi, ticks.back().value);
  Axis axis{{false, 0, hi}, linear_ticks(0, hi, 7), style->x_label};
  std::optional<Axis> above;
  if (!style->x_above_label.empty()) {
    const double end = hi / style->x_above_unit;
    above = Axis{{false, 0, end}, linear_ticks(0, end, 7), style->x_above_label};
  }
  return ChartScales{axis, vertical, above};
}

bool has_labelled_guides(const ChartStyle& style) {
  return !style.slopes.empty() || std::ranges::any_of(style.levels, [](const Level& l) { return !l.label.empty(); });
}

double height_above(const ChartStyle& style) { return style.x_above_label.empty() ? 0 : kHeightOfXAxis - 2; }

void draw_chart(Canvas& canvas, const Axes& axes, const std::optional<Axis>& x_above, const LineChart& chart) {
  axes.draw_grid(canvas);
  draw_levels(canvas, axes, chart.style.levels);
  draw_guides(canvas, axes, chart);
  axes.draw_frame(canvas);
  if (x_above) draw_x_above(canvas, axes, *x_above);
  for (const ChartLine& line : chart.lines) draw_line(canvas, axes, chart.style, line, has_markers(chart));
}

double legend_width(const LineChart& chart) {
  double label = 0, note = 0;
  for (const ChartLine& line : chart.lines) {
    label = std::max(label, text_width(line.label, kSmallSize));
    note = std::max(note, text_width(line.note, kSmallSize));
  }
  return kSample + 3 + label + 4 + note + 1;
}

void draw_legend(Canvas& canvas, const LineChart& chart, Position at, double width, const std::string& notes_title) {
  if (!notes_title.empty())
    canvas.text({at.x + width, at.y}, notes_title, {.size = kSmallSize, .anchor = Anchor::kEnd, .ink = kInkGrey});
  for (const ChartLine& line : chart.lines) {
    at.y += kLegendLine;
    const Look& look = looks()[line.look];
    const double y = at.y - 0.36 * kSmallSize;
    canvas.line({{at.x, y}, {at.x + kSample, y}}, {look.ink, 0.9, look.dashes});
    if (has_markers(chart)) draw_marker(canvas, {at.x + kSample / 2, y}, 1.7, look);
    const double note_width = line.note.empty() ? 0 : text_width(line.note, kSmallSize) + 4;
    canvas.text({at.x + kSample + 3, at.y}, fitted(line.label, kSmallSize, width - kSample - 3 - note_width),
                {.size = kSmallSize});
    canvas.text({at.x + width, at.y}, line.note, {.size = kSmallSize, .anchor = Anchor::kEnd});
  }
}

std::string slope_label(double slope) {
  const double size = std::abs(slope);
  return (slope < 0 ? "\u2212" : "") + (size == 0.5    ? std::string("½")
                                        : size == 0.75 ? std::string("¾")
                                        : size == 1.5  ? std::string("3/2")
                                                       : format_number(size));
}

std::string slope_note(double slope, const std::optional<Interval>& interval, const std::string& before,
                       const std::string& after) {
  const auto number = [](double x) {
    const std::string text = fmt::format("{:.2f}", x);
    return text.starts_with('-') ? "\u2212" + text.substr(1) : text;
  };
  if (!interval) return number(slope);
  return fmt::format("{} {}[{}, {}]{}", number(slope), before, number(interval->lo), number(interval->hi), after);
}

}  // namespace halfslope
