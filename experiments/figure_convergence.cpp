// convergence: log RMSE against log N.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "analysis/typeface.h"
#include "core/error.h"
#include "core/numbers.h"
#include "experiments/convergence_panels.h"
#include "experiments/figures.h"

namespace halfslope {
namespace {

constexpr double kTitle = 18, kPanelHeader = 13, kLegendLine = 9.5, kGap = 12, kFooter = 14, kSample = 18, kEdge = 1;
constexpr double kGuideMargin = 20;  // right of the frame, for slopes that leave there
constexpr std::size_t kMostPanels = 24;

/// The least and the greatest of some positive values.
struct Range {
  double lo = std::numeric_limits<double>::infinity(), hi = 0;
  void add(double x) {
    lo = std::min(lo, x);
    hi = std::max(hi, x);
  }
  bool empty() const { return !(lo <= hi); }
};

struct Ranges {
  Range samples, rmse;
};

/// Of every panel of a scene, so that they can be compared. An interval reaches no further than a factor of 4 beyond
/// all RMSEs: one that knows nothing must not squeeze the rest.
Ranges ranges_of(const std::vector<ConvergencePanel>& panels, const std::string& scene) {
  Ranges ranges;
  Range ends;
  for (const ConvergencePanel& panel : panels) {
    if (panel.scene != scene) continue;
    for (const PanelLine& line : panel.lines) {
      for (const LinePoint& p : line.line->points) {
        ranges.samples.add(p.samples);
        ranges.rmse.add(p.rmse);
        if (p.lo) ends.add(*p.lo);
        if (p.hi) ends.add(*p.hi);
      }
    }
  }
  if (ends.empty()) return ranges;
  const Range points = ranges.rmse;
  ranges.rmse.add(std::max(ends.lo, points.lo / 4));
  ranges.rmse.add(std::min(ends.hi, points.hi * 4));
  return ranges;
}

bool power_of_two(double x) { return x >= 1 && std::exp2(std::round(std::log2(x))) == x; }

Axis samples_axis(const std::vector<ConvergencePanel>& panels, const std::string& scene, const Range& range) {
  bool powers = range.hi > range.lo;
  for (const ConvergencePanel& panel : panels) {
    for (const PanelLine& line : panel.lines) {
      for (const LinePoint& p : line.line->points) powers = powers && (panel.scene != scene || power_of_two(p.samples));
    }
  }
  const double pad = range.hi > range.lo ? std::pow(range.hi / range.lo, 0.05) : 2;
  Axis axis{{true, range.lo / pad, range.hi * pad}, {}, "samples N"};
  axis.ticks = log_ticks(axis.scale.lo, axis.scale.hi, powers ? 2 : 10, 6);
  if (axis.scale.hi < 20000) {  // short enough to be written out
    for (Tick& tick : axis.ticks) {
      if (!tick.label.empty()) tick.label = format_number(std::round(tick.value * 1e6) / 1e6);
    }
  }
  return axis;
}

Axis rmse_axis(const Ranges& ranges, const std::string& label) {
  const double pad = std::max(1.5, std::pow(ranges.rmse.hi / ranges.rmse.lo, 0.06));
  Axis axis{{true, ranges.rmse.lo / pad, ranges.rmse.hi * pad}, {}, label};
  axis.ticks = log_ticks(axis.scale.lo, axis.scale.hi, 10, 6);
  return axis;
}

std::string with_minus(std::string text) { return text.starts_with('-') ? "\u2212" + text.substr(1) : text; }

std::string rate_text(const ConvergenceLine& line) {
  if (line.points.empty()) return line.status;
  if (!line.rate) return line.rate_status;
  const auto number = [](double x) { return with_minus(fmt::format("{:.2f}", x)); };
  if (!line.rate_interval) return number(*line.rate);
  return fmt::format("{} [{}, {}]", number(*line.rate), number(line.rate_interval->lo), number(line.rate_interval->hi));
}

/// Bars and caps of the points' intervals, cut where the frame ends.
void draw_intervals(Canvas& canvas, const Axes& axes, const PanelLine& line, const Stroke& stroke) {
  const double lowest = axes.y.scale.lo, highest = axes.y.scale.hi;
  for (const LinePoint& p : line.line->points) {
    if (!p.hi) continue;
    const double lo = std::max(p.lo.value_or(0), lowest), hi = std::min(*p.hi, highest);
    const Position low = axes.at(p.samples, lo), high = axes.at(p.samples, hi);
    canvas.line({low, high}, stroke);
    for (const auto& [end, cut] : {std::pair(low, !p.lo || *p.lo < lowest), std::pair(high, *p.hi > highest)}) {
      if (!cut) canvas.line({{end.x - 1.5, end.y}, {end.x + 1.5, end.y}}, stroke);
    }
  }
}

void draw_line(Canvas& canvas, const Axes& axes, const PanelLine& line) {
  const Look& look = looks()[line.look];
  const ConvergenceLine& data = *line.line;
  canvas.begin_group(data.scene + ", " + data.estimator + ", " + data.sampler + ", " + data.precision);
  std::vector<Position> points;
  for (const LinePoint& p : data.points) points.push_back(axes.at(p.samples, p.rmse));
  if (points.size() > 1) canvas.line(points, {look.ink, 0.9, look.dashes});
  draw_intervals(canvas, axes, line, {look.ink, 0.5});
  for (std::size_t k = 0; k < points.size(); ++k) draw_marker(canvas, points[k], 1.7, look, !data.points[k].certified);
  canvas.end_group();
}

double legend_width(const ConvergencePanel& panel) {
  double label = 0, rate = 0;
  for (const PanelLine& line : panel.lines) {
    label = std::max(label, text_width(line.label, kSmallSize));
    rate = std::max(rate, text_width(rate_text(*line.line), kSmallSize));
  }
  return kSample + 3 + label + 4 + rate + 1;
}

void draw_legend(Canvas& canvas, const ConvergencePanel& panel, Position at, double width, bool rates) {
  if (rates) {
    canvas.text({at.x + width, at.y}, "rate [95 %]", {.size = kSmallSize, .anchor = Anchor::kEnd, .ink = kInkGrey});
  }
  for (const PanelLine& line : panel.lines) {
    at.y += kLegendLine;
    const Look& look = looks()[line.look];
    const double middle = at.y - 0.36 * kSmallSize;
    canvas.line({{at.x, middle}, {at.x + kSample, middle}}, {look.ink, 0.9, look.dashes});
    draw_marker(canvas, {at.x + kSample / 2, middle}, 1.7, look);
    const std::string rate = rate_text(*line.line);
    const double rate_width = rate.empty() ? 0 : text_width(rate, kSmallSize) + 4;
    canvas.text({at.x + kSample + 3, at.y}, fitted(line.label, kSmallSize, width - kSample - 3 - rate_width),
                {.size = kSmallSize});
    canvas.text({at.x + width, at.y}, rate, {.size = kSmallSize, .anchor = Anchor::kEnd});
  }
}

void draw_plot(Canvas& canvas, const Axes& axes, const ConvergencePanel& panel, const Ranges& ranges) {
  axes.draw_grid(canvas);
  // From above the first points, so that they run beside the lines.
  Range first;
  for (const PanelLine& line : panel.lines) {
    if (!line.line->points.empty()) first.add(line.line->points.front().rmse);
  }
  const double start = 1.25 * (first.empty() ? ranges.rmse.hi : first.hi);
  for (const auto& [slope, label] :
       {std::pair(-0.5, "\u2212½"), {-0.75, "\u2212¾"}, {-1.0, "\u22121"}, {-1.5, "\u22123/2"}}) {
    draw_slope_guide(canvas, axes, ranges.samples.lo, start, slope, label);
  }
  axes.draw_frame(canvas);
  for (const PanelLine& line : panel.lines) draw_line(canvas, axes, line);
}

std::string caption_of(const std::vector<ConvergenceLine>& lines) {
  bool intervals = false, uncertified = false, left_out = false;
  for (const ConvergenceLine& line : lines) {
    left_out = left_out || line.left_out > 0;
    for (const LinePoint& p : line.points) {
      intervals = intervals || p.hi;
      uncertified = uncertified || !p.certified;
    }
  }
  std::string text = "Dotted: slopes \u2212½, \u2212¾, \u22121, \u22123/2.";
  if (intervals) text += " Bars: 95 % intervals over replicates.";
  if (uncertified) text += " Hollow: interval not certified (status).";
  if (left_out) text += " N without a positive RMSE are left out.";
  return text;
}

}  // namespace

Canvas draw_convergence_figure(const FigureRequest& request, const Catalogue& /*catalogue*/) {
  if (request.run.empty()) {
    fail(ExitCode::kUsage, "--run is missing: the run folder to draw, e.g. out/veach-mis; `halfslope run` makes one");
  }
  LineFilter filter{request.spec.scenes, request.spec.estimators, request.spec.samplers, {}};
  for (const Precision precision : request.spec.precision) filter.precisions.push_back(to_string(precision));
  const std::vector<ConvergenceLine> lines = read_convergence_lines(request.run, filter);
  const auto [panels, common] = convergence_panels(lines);
  if (panels.size() > kMostPanels) {
    fail(ExitCode::kUsage,
         "{}: {} panels are more than a page's {}; choose with --scene, --estimators, --samplers or --precision",
         request.run, panels.size(), kMostPanels);
  }
  const bool rates =
      std::any_of(lines.begin(), lines.end(), [](const auto& line) { return !line.rate_status.empty(); });
  std::size_t most_lines = 0;
  for (const ConvergencePanel& panel : panels) most_lines = std::max(most_lines, panel.lines.size());

  // One panel has its legend to the right, several have theirs below.
  const bool single = panels.size() == 1;
  const std::size_t columns = panels.size() == 2 || panels.size() == 4 ? 2 : std::min<std::size_t>(panels.size(), 3);
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  double y_axis = 0;
  for (const ConvergencePanel& panel : panels) {
    const Ranges ranges = ranges_of(panels, panel.scene);
    if (!ranges.samples.empty()) y_axis = std::max(y_axis, width_of_y_axis(rmse_axis(ranges, "RMSE")));
  }
  const double column = single ? std::clamp(kPageWidth - kGap - 3 - legend_width(panels.front()), 230.0, 345.0)
                               : (kPageWidth - kGap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  const double width = column - y_axis - kGuideMargin, height = (single ? 0.8 : 1.0) * width;
  const double legend = (static_cast<double>(most_lines) + 1) * kLegendLine + 6;
  const double header = single && panels.front().title.empty() ? 3 : kPanelHeader;
  const double row_height = header + height + kHeightOfXAxis + (single ? 2 : legend + 6);
  Canvas canvas(kPageWidth, kTitle + static_cast<double>(rows) * row_height + kFooter);
  const std::string name = fitted(run_name(request.run), 10, kPageWidth - 160, true);
  canvas.text({kEdge, 11}, name, {.size = 10, .bold = true});
  const double title_end = kEdge + text_width(name, 10, true) + 8;
  canvas.text({title_end, 11}, fitted(common, kLabelSize, kPageWidth - title_end),
              {.size = kLabelSize, .ink = kInkGrey});
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const ConvergencePanel& panel = panels[k];
    const double left = static_cast<double>(k % columns) * (column + kGap);
    const double top = kTitle + static_cast<double>(k / columns) * row_height + header;
    canvas.text({left + y_axis, top - 4.5}, fitted(panel.title, kLabelSize, width + kGuideMargin, true),
                {.size = kLabelSize, .bold = true});
    const Ranges ranges = ranges_of(panels, panel.scene);
    if (ranges.samples.empty()) {
      canvas.text({left + y_axis, top + 20}, "nothing to draw: no RMSE above 0", {.size = kSmallSize, .ink = kInkGrey});
    } else {
      const Axes axes{{left + y_axis, top},
                      width,
                      height,
                      samples_axis(panels, panel.scene, ranges.samples),
                      rmse_axis(ranges, k % columns == 0 ? "RMSE" : "")};
      draw_plot(canvas, axes, panel, ranges);
    }
    const Position legend_at = single ? Position{column + kGap, top + kSmallSize}
                                      : Position{left + 2, top + height + kHeightOfXAxis + kLegendLine};
    draw_legend(canvas, panel, legend_at, single ? kPageWidth - column - kGap - 3 : column - 3, rates);
  }
  canvas.text({kEdge, canvas.height() - 4}, caption_of(lines), {.size = kSmallSize, .ink = kInkGrey});
  return canvas;
}

}  // namespace halfslope
