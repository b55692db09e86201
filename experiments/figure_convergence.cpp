// convergence: log RMSE against log N. work-precision: the same against log time.
#include <algorithm>

#include "core/error.h"
#include "experiments/convergence_panels.h"
#include "experiments/figures.h"
#include "experiments/line_page.h"

namespace halfslope {
namespace {

constexpr std::size_t kMostPanels = 24;

/// What the errors are drawn against.
enum class Against { kSamples, kTime };

std::string note_of(const ConvergenceLine& line, Against against) {
  if (line.points.empty()) return line.status;
  if (against == Against::kTime) return "";
  return line.rate ? slope_note(*line.rate, line.rate_interval) : line.rate_status;
}

ChartPoint chart_point(const LinePoint& p, Against against) {
  ChartPoint point = {p.samples, p.rmse, p.lo, p.hi, !p.certified};
  if (against == Against::kTime) point.x = *p.seconds, point.x_lo = p.seconds_lo, point.x_hi = p.seconds_hi;
  return point;
}

LineChart chart_of(const ConvergencePanel& panel, Against against) {
  LineChart chart{panel.title, panel.scene, {}, {}};
  chart.style.x_label = against == Against::kTime ? "CPU seconds an integral" : "samples N";
  chart.style.y_label = "RMSE";
  chart.style.slopes = {-0.5, -0.75, -1, -1.5};
  for (const PanelLine& line : panel.lines) {
    const ConvergenceLine& data = *line.line;
    ChartLine& drawn = chart.lines.emplace_back();
    drawn = {data.scene + ", " + data.estimator + ", " + data.sampler + ", " + data.precision,
             line.label,
             note_of(data, against),
             line.look,
             {}};
    for (const LinePoint& p : data.points) drawn.points.push_back(chart_point(p, against));
  }
  return chart;
}

std::string caption_of(const std::vector<ConvergenceLine>& lines, Against against) {
  bool intervals = false, uncertified = false, left_out = false;
  for (const ConvergenceLine& line : lines) {
    left_out = left_out || line.left_out > 0;
    for (const LinePoint& p : line.points) {
      intervals = intervals || p.hi;
      uncertified = uncertified || !p.certified;
    }
  }
  std::string text = "Dotted: slopes \u2212½, \u2212¾, \u22121, \u22123/2.";
  if (against == Against::kTime) {
    text += " Bars: 95 % intervals, of RMSE over replicates, of time over timings; points are N.";
  } else if (intervals) {
    text += " Bars: 95 % intervals over replicates.";
  }
  if (uncertified) text += " Hollow: interval not certified (status).";
  if (left_out) {
    text += against == Against::kTime ? " N without a time or a positive RMSE are left out."
                                      : " N without a positive RMSE are left out.";
  }
  return text;
}

Canvas draw_lines_of_run(const FigureRequest& request, Against against) {
  if (request.run.empty()) {
    fail(ExitCode::kUsage, "--run is missing: the run folder to draw, e.g. out/veach-mis; `halfslope run` makes one");
  }
  LineFilter filter{request.spec.scenes, request.spec.estimators, request.spec.samplers, {}};
  for (const Precision precision : request.spec.precision) filter.precisions.push_back(to_string(precision));
  std::vector<ConvergenceLine> lines = read_convergence_lines(request.run, filter);
  if (against == Against::kTime) read_times(request.run, lines);
  const auto [panels, common] = convergence_panels(lines);
  if (panels.size() > kMostPanels) {
    fail(ExitCode::kUsage,
         "{}: {} panels are more than a page's {}; choose with --scene, --estimators, --samplers or --precision",
         request.run, panels.size(), kMostPanels);
  }
  const bool rates = against == Against::kSamples && std::any_of(lines.begin(), lines.end(), [](const auto& line) {
                       return !line.rate_status.empty();
                     });
  LinePage page{run_name(request.run), common, rates ? "rate [95 %]" : "", {}, true, caption_of(lines, against), {}};
  page.nothing = "nothing to draw: no RMSE above 0";
  for (const ConvergencePanel& panel : panels) page.charts.push_back(chart_of(panel, against));
  return draw_line_page(page);
}

}  // namespace

Canvas draw_convergence_figure(const FigureRequest& request, const Catalogue& /*catalogue*/) {
  return draw_lines_of_run(request, Against::kSamples);
}

Canvas draw_work_precision_figure(const FigureRequest& request, const Catalogue& /*catalogue*/) {
  return draw_lines_of_run(request, Against::kTime);
}

}  // namespace halfslope
