// discrepancy: measures of samplers' points against N.
#include <algorithm>
#include <map>

#include "analysis/palette.h"
#include "core/error.h"
#include "core/parameters.h"
#include "core/random.h"
#include "experiments/figure_measurements.h"
#include "experiments/figure_samplers.h"
#include "experiments/figures.h"
#include "experiments/measured_pages.h"

namespace halfslope {
namespace {

constexpr std::int64_t kReplicates = 16;
constexpr std::size_t kMostCharts = 24;

/// The measures that are one number.
std::vector<std::string> numbers() {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measure_catalogue()) {
    if (!info.curve) names.push_back(info.name);
  }
  return names;
}

std::string note_of(const RateFit& fit) { return fit.rate ? slope_note(*fit.rate, fit.interval) : fit.status; }

}  // namespace

std::vector<MeasuredSlope> measured_slopes(const MeasuresPlan& plan, const Measurements& measured) {
  struct Values {
    std::vector<double> samples;
    std::vector<std::vector<double>> values;  ///< [N][replicate]
  };
  std::vector<MeasuredSlope> slopes;
  std::map<std::pair<const MeasuredPoints*, std::string>, Values> all;
  visit_measurements(plan, measured,
                     [&](const MeasuredPoints& points, std::uint64_t count, std::int64_t replicate,
                         const std::string& name, const MeasuredValue& value) {
                       Values& line = all[{&points, name}];
                       if (replicate == 0) {
                         line.samples.push_back(static_cast<double>(count));
                         line.values.emplace_back();
                       }
                       line.values.back().push_back(value.value);
                     });
  for (auto& [key, line] : all) {
    // fit_rate() halves the slope, since it is made for squared errors.
    RateFit fit =
        fit_rate({line.samples, line.values}, hash_text(sampler_label(key.first->sampler) + "," + key.second, 1));
    if (fit.rate) fit.rate = 2 * *fit.rate;
    if (fit.interval) fit.interval = Interval{2 * fit.interval->lo, 2 * fit.interval->hi};
    slopes.push_back({key.first, key.second, fit});
  }
  return slopes;
}

LinePage discrepancy_page(const std::vector<MeasuredMean>& means, const std::vector<MeasuredSlope>& slopes) {
  std::vector<std::string> names;
  std::vector<const MeasuredPoints*> points;
  for (const MeasuredMean& mean : means) {
    if (std::ranges::find(names, mean.name) == names.end()) names.push_back(mean.name);
    if (std::ranges::find(points, mean.points) == points.end()) points.push_back(mean.points);
  }
  LinePage page;
  page.title = (names.size() == 1 ? names.front() : "Measures") + " against N";
  page.notes_title = slopes.empty() ? "" : "slope [95 %]";
  page.nothing = "nothing to draw: no value above 0";
  bool intervals = false, left_out = false;
  for (const std::string& name : names) {
    for (std::size_t first = 0; first < points.size(); first += looks().size()) {
      LineChart& chart = page.charts.emplace_back();
      chart.title = names.size() > 1 ? name : "";
      chart.group = name;
      chart.style.x_label = "points N";
      chart.style.y_label = name;
      chart.style.slopes = {-0.5, -0.75, -1};
      for (std::size_t k = first; k < std::min(points.size(), first + looks().size()); ++k) {
        const std::string& sampler = points[k]->sampler;
        ChartLine& line = chart.lines.emplace_back();
        line = {name + ", " + sampler, sampler_label(sampler), "", k - first, {}};
        for (const MeasuredMean& mean : means) {
          if (mean.points != points[k] || mean.name != name) continue;
          ChartPoint point{static_cast<double>(mean.count), mean.value};
          if (mean.upper > mean.lower) point.lo = mean.lower, point.hi = mean.upper;
          intervals = intervals || point.hi;
          left_out = left_out || !(mean.value > 0);
          line.points.push_back(point);
        }
        for (const MeasuredSlope& slope : slopes) {
          if (slope.points == points[k] && slope.measure == name) line.note = note_of(slope.fit);
        }
      }
    }
  }
  page.caption = "Dotted: slopes \u2212½, \u2212¾, \u22121.";
  if (intervals) page.caption += " Bars: 95 % intervals of the mean over replicates.";
  if (!slopes.empty()) page.caption += " Slopes: ordinary least squares of log mean on log N, over all N drawn.";
  if (left_out) page.caption += " Values that are not above 0 are left out.";
  return page;
}

Canvas draw_discrepancy_figure(const FigureRequest& request, const Catalogue& catalogue) {
  const int dims = request.dims.value_or(2);
  const std::vector<std::string> names = figure_samplers(
      request, catalogue, {"independent", "jittered", "halton", "hammersley", "poisson-disk", "sobol-owen"}, dims);
  SampleCounts usual{{}, true};
  for (std::uint64_t n = 16; n <= 4096; n *= 2) usual.counts.push_back(n);
  MeasuresRequest measures{names,
                           request.spec.samples.counts.empty() ? usual : request.spec.samples,
                           dims,
                           figure_measures(request, {"star"}, numbers(), ""),
                           request.replicates.value_or(kReplicates),
                           request.spec.seed};
  const FigureMeasurements measured = measure_for_figure(request, catalogue, {measures});
  LinePage page = discrepancy_page(measured.means, measured_slopes(measured.plan, measured.values));
  if (page.charts.size() > kMostCharts)
    fail(ExitCode::kUsage, "{} diagrams are more than a page's {}; choose fewer --samplers or --measures",
         page.charts.size(), kMostCharts);
  page.subtitle = measured_subtitle(measured.means, request.spec.seed);
  return draw_line_page(page);
}

}  // namespace halfslope
