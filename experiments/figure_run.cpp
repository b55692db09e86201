// What is drawn of a run folder. convergence: log RMSE against log N; work-precision: the same against log time; rates:
// slopes between neighbouring N against log N.
#include <algorithm>
#include <cmath>

#include "analysis/status.h"
#include "core/error.h"
#include "experiments/convergence_panels.h"
#include "experiments/figures.h"
#include "experiments/line_page.h"
#include "experiments/tables.h"

namespace halfslope {
namespace {

constexpr std::size_t kMostPanels = 24;
constexpr double kReachOfRates = 0.3;  // beyond all local rates, for their intervals

enum class Diagram { kConvergence, kWorkPrecision, kRates };

bool bent(const ConvergenceLine& line) { return has_mark(line.rate_status, "pre-asymptotic"); }

std::vector<ChartPoint> points_of(const ConvergenceLine& line, Diagram diagram) {
  std::vector<ChartPoint> points;
  if (diagram == Diagram::kRates) {
    const auto outside = [&](const LocalRatePoint& p) {
      return line.window ? p.samples_lo < line.window->lo || p.samples_hi > line.window->hi : bent(line);
    };
    for (const LocalRatePoint& p : line.local_rates)
      points.push_back({std::sqrt(p.samples_lo * p.samples_hi), p.rate, p.lo, p.hi, !p.certified || outside(p)});
    return points;
  }
  for (const LinePoint& p : line.points) {
    ChartPoint& point = points.emplace_back(ChartPoint{p.samples, p.rmse, p.lo, p.hi, !p.certified});
    if (diagram == Diagram::kWorkPrecision) point.x = *p.seconds, point.x_lo = p.seconds_lo, point.x_hi = p.seconds_hi;
  }
  return points;
}

std::string note_of(const ConvergenceLine& line, const std::vector<ChartPoint>& points, Diagram diagram) {
  if (points.empty() && !line.status.empty()) return line.status;
  if (diagram == Diagram::kWorkPrecision) return "";
  const std::string rate =
      line.rate ? slope_note(*line.rate, line.rate_interval, is_certified(line.rate_status) ? "" : kNotCertified,
                             bent(line) ? kNotStraight : "")
                : line.rate_status;
  return diagram == Diagram::kRates && line.theory ? rate + ", " + slope_label(*line.theory) : rate;
}

ChartStyle style_of(const ConvergencePanel& panel, Diagram diagram) {
  ChartStyle style;
  style.x_label = diagram == Diagram::kWorkPrecision ? "CPU seconds an integral" : "samples N";
  style.y_label = "RMSE";
  style.slopes = {-0.5, -0.75, -1, -1.5};
  if (diagram != Diagram::kRates) return style;
  style.y_label = "rate between neighbouring N";
  style.log_y = false;
  style.y_reach = kReachOfRates;
  style.slopes.clear();
  for (const PanelLine& line : panel.lines) {
    const std::optional<double>& theory = line.line->theory;
    if (theory && !line.line->local_rates.empty() &&
        std::ranges::find(style.levels, *theory, &Level::y) == style.levels.end())
      style.levels.push_back({*theory, slope_label(*theory)});
  }
  return style;
}

LineChart chart_of(const ConvergencePanel& panel, Diagram diagram) {
  LineChart chart{panel.title, panel.scene, style_of(panel, diagram), {}};
  for (const PanelLine& line : panel.lines) {
    const ConvergenceLine& data = *line.line;
    const std::string name = data.scene + ", " + data.estimator + ", " + data.sampler + ", " + data.precision;
    std::vector<ChartPoint> points = points_of(data, diagram);
    const std::string note = note_of(data, points, diagram);
    chart.lines.push_back({name, line.label, note, line.look, std::move(points)});
  }
  return chart;
}

std::string caption_of(const LinePage& page, bool left_out, Diagram diagram) {
  bool intervals = false, hollow = false, levels = false, uncertain = false, curved = false;
  for (const LineChart& chart : page.charts) {
    levels = levels || !chart.style.levels.empty();
    for (const ChartLine& line : chart.lines) {
      uncertain = uncertain || line.note.find(std::string(kNotCertified) + "[") != std::string::npos;
      curved = curved || line.note.find("]" + std::string(kNotStraight)) != std::string::npos;
      for (const ChartPoint& p : line.points) intervals = intervals || p.hi, hollow = hollow || p.hollow;
    }
  }
  std::string text;
  const auto say = [&](bool applies, const char* sentence) {
    if (applies) text += (text.empty() ? "" : " ") + std::string(sentence);
  };
  const auto say_marks = [&] {
    say(uncertain, "~: not certified.");
    say(curved, "*: pre-asymptotic, no line over all N.");
    return text;
  };
  if (diagram == Diagram::kRates) {
    say(levels, "Dotted: theory.");
    say(intervals, "Bars: 95 % intervals over replicates.");
    say(hollow, "Hollow: interval not certified (status), or outside the N over which the errors follow a line.");
    return say_marks();
  }
  say(true, "Dotted: slopes \u2212½, \u2212¾, \u22121, \u22123/2.");
  if (diagram == Diagram::kWorkPrecision) {
    say(true, "Bars: 95 % intervals, of RMSE over replicates, of time over timings; points are N.");
  } else {
    say(intervals, "Bars: 95 % intervals over replicates.");
  }
  say(hollow, "Hollow: interval not certified (status).");
  say(left_out, diagram == Diagram::kWorkPrecision ? "N without a time or a positive RMSE are left out."
                                                   : "N without a positive RMSE are left out.");
  return say_marks();
}

Canvas draw_run(const FigureRequest& request, Diagram diagram) {
  if (request.run.empty()) {
    fail(ExitCode::kUsage, "--run is missing: the run folder to draw, e.g. out/veach-mis; `halfslope run` makes one");
  }
  LineFilter filter{request.spec.scenes, request.spec.estimators, request.spec.samplers, {}};
  for (const Precision precision : request.spec.precision) filter.precisions.push_back(to_string(precision));
  std::vector<ConvergenceLine> lines = read_convergence_lines(request.run, filter);
  if (diagram == Diagram::kWorkPrecision) read_times(request.run, lines);
  if (diagram == Diagram::kRates) read_local_rates(request.run, lines);
  const auto [panels, common] = convergence_panels(lines);
  if (panels.size() > kMostPanels) {
    fail(ExitCode::kUsage,
         "{}: {} panels are more than a page's {}; choose with --scene, --estimators, --samplers or --precision",
         request.run, panels.size(), kMostPanels);
  }
  const auto any = [&](auto&& of) { return std::ranges::any_of(lines, of); };
  LinePage page{run_name(request.run), common, "", {}, true, "", "nothing to draw: no RMSE above 0"};
  if (diagram != Diagram::kWorkPrecision && any([](const auto& line) { return !line.rate_status.empty(); }))
    page.notes_title = diagram == Diagram::kRates ? "rate over all N [95 %], theory" : "rate [95 %]";
  if (diagram == Diagram::kRates) page.nothing = "nothing to draw: no two N with a rate between them";
  for (const ConvergencePanel& panel : panels) page.charts.push_back(chart_of(panel, diagram));
  page.caption = caption_of(page, any([](const auto& line) { return line.left_out > 0; }), diagram);
  return draw_line_page(page);
}

}  // namespace

Canvas draw_convergence_figure(const FigureRequest& request, const Catalogue& /*catalogue*/) {
  return draw_run(request, Diagram::kConvergence);
}

Canvas draw_work_precision_figure(const FigureRequest& request, const Catalogue& /*catalogue*/) {
  return draw_run(request, Diagram::kWorkPrecision);
}

Canvas draw_rates_figure(const FigureRequest& request, const Catalogue& /*catalogue*/) {
  return draw_run(request, Diagram::kRates);
}

}  // namespace halfslope
