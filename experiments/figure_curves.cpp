// pcf and radial-spectrum: how the points of samplers are spaced, as curves.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "analysis/palette.h"
#include "core/error.h"
#include "core/numbers.h"
#include "experiments/figure_measurements.h"
#include "experiments/figure_samplers.h"
#include "experiments/figures.h"
#include "experiments/measured_pages.h"

namespace halfslope {
namespace {

// Peaks of grids and lattices go up to N, and would squeeze everything else.
constexpr double kHighest = 4;
constexpr std::int64_t kReplicates = 64;
constexpr std::size_t kMostCharts = 24;

int dims_of(const MeasuredMean& mean) { return mean.points->layout.dims(); }

/// How many mean distances a distance is.
double per_distance(const MeasuredMean& mean) { return std::pow(static_cast<double>(mean.count), 1.0 / dims_of(mean)); }
double as_it_is(const MeasuredMean& /*mean*/) { return 1; }
double per_root(const MeasuredMean& mean) { return 1 / std::sqrt(static_cast<double>(mean.count)); }

/// Adds one chart of all lines, or one of each; which, `side_by_side` says.
void add_charts(LinePage& page, const std::string& group, const ChartStyle& style, std::vector<ChartLine> lines,
                bool side_by_side) {
  bool cut = false;
  for (const ChartLine& line : lines)
    cut = cut || std::ranges::any_of(line.points, [&](const ChartPoint& p) { return p.y > style.y_most; });
  const bool intervals = std::ranges::any_of(lines, [](const ChartLine& line) {
    return std::ranges::any_of(line.points, [](const ChartPoint& p) { return p.hi.has_value(); });
  });
  const std::string bands = "Bands: 95 % intervals of the mean over replicates. ";
  if (intervals && !page.caption.starts_with(bands)) page.caption = bands + page.caption;
  if (cut) page.caption += fmt::format(" Values above {:g} are cut off.", style.y_most);
  if (!side_by_side && lines.size() <= looks().size()) {
    page.charts.push_back({"", group, style, std::move(lines)});
    return;
  }
  page.legends = false;
  for (ChartLine& line : lines) {
    line.look = 0;
    const std::string title = line.label;
    page.charts.push_back({title, group, style, {std::move(line)}});
  }
}

void check_charts(const LinePage& page) {
  if (page.charts.size() > kMostCharts)
    fail(ExitCode::kUsage, "--samplers: at most {} diagrams, found {}", kMostCharts, page.charts.size());
}

/// A request for each sampler, whose measures may depend on its N.
template <class Measures>
std::vector<MeasuresRequest> requests_of(const FigureRequest& request, const Catalogue& catalogue, int dims,
                                         Measures measures) {
  std::vector<MeasuresRequest> requests;
  for (const std::string& name :
       figure_samplers(request, catalogue, {"independent", "jittered", "poisson-disk", "sobol-owen"}, dims)) {
    const SampleCounts counts = figure_counts(request, catalogue.samplers.make(name)->info(), {{1024}, false});
    requests.push_back({{name},
                        counts,
                        dims,
                        measures(static_cast<double>(counts.counts.front())),
                        request.replicates.value_or(kReplicates),
                        request.spec.seed});
  }
  return requests;
}

}  // namespace

std::vector<ChartLine> curve_lines(const std::vector<MeasuredMean>& means, const std::string& prefix,
                                   double (*unit)(const MeasuredMean& mean)) {
  std::vector<ChartLine> lines;
  const MeasuredMean* before = nullptr;  // of the same line
  for (const MeasuredMean& mean : means) {
    if (!mean.name.starts_with(prefix)) continue;
    if (!before || before->points != mean.points || before->count != mean.count) {
      const std::string title = sampler_label(mean.points->sampler);
      const std::string count = same_count(means) ? "" : fmt::format(", N = {}", mean.count);
      lines.push_back({mean.points->sampler + count, title + count, "", lines.size() % looks().size(), {}});
    }
    before = &mean;
    ChartPoint point{std::strtod(mean.name.c_str() + prefix.size(), nullptr) * unit(mean), mean.value};
    if (mean.upper > mean.lower) point.lo = mean.lower, point.hi = mean.upper;
    lines.back().points.push_back(point);
  }
  return lines;
}

LinePage pair_correlation_page(const std::vector<MeasuredMean>& means, bool side_by_side) {
  LinePage page;
  page.title = "Pair correlation";
  page.caption = "Grey line: 1, independent points. Distances are toroidal.";
  const int dims = means.empty() ? 2 : dims_of(means.front());
  ChartStyle style;
  style.x_label = dims == 1   ? "distance r · N"
                  : dims == 2 ? "distance r · √N"
                              : fmt::format("distance r · N^(1/{})", dims);
  style.y_label = "pair correlation g(r)";
  style.log_x = style.log_y = false;
  style.intervals = Intervals::kBands;
  style.levels = {{1}};
  style.y_least = 0;
  style.y_most = kHighest;
  add_charts(page, "pcf", style, curve_lines(means, "pcf:r=", per_distance), side_by_side);
  return page;
}

LinePage radial_spectrum_page(const std::vector<MeasuredMean>& means, bool side_by_side) {
  const bool same = same_count(means);
  LinePage page;
  page.title = "Radial power spectrum";
  page.caption = "Grey line: independent points.";
  ChartStyle style;
  style.x_label = same ? "frequency f" : "frequency f/√N";
  style.y_label = "radial mean power P(f)";
  style.log_x = style.log_y = false;
  style.intervals = Intervals::kBands;
  style.levels = {{1}};
  style.y_least = 0;
  style.y_most = kHighest;
  if (same && !means.empty()) {
    style.x_above_label = "f/√N";
    style.x_above_unit = 1 / per_root(means.front());
  }
  const auto unit = same ? as_it_is : per_root;
  add_charts(page, "power", style, curve_lines(means, "radial-spectrum:f=", unit), side_by_side);
  if (auto lines = curve_lines(means, "anisotropy:f=", unit); !lines.empty()) {
    style.y_label = "anisotropy (dB)";
    style.levels = {{0}};
    style.y_least = std::nullopt;
    style.y_most = std::numeric_limits<double>::infinity();
    add_charts(page, "anisotropy", style, std::move(lines), side_by_side);
  }
  std::erase_if(page.charts, [](const LineChart& chart) { return chart.lines.empty(); });
  return page;
}

Canvas draw_pair_correlation_figure(const FigureRequest& request, const Catalogue& catalogue) {
  const int dims = request.dims.value_or(2);
  const auto requests = requests_of(request, catalogue, dims, [&](double count) {
    const double most = std::min(0.5, 5 / std::pow(count, 1.0 / dims));
    return figure_measures(request, {"pcf"}, {"pcf"}, "bins=100,max=" + format_number(most));
  });
  const FigureMeasurements measured = measure_for_figure(request, catalogue, requests);
  LinePage page = pair_correlation_page(measured.means, request.side_by_side);
  check_charts(page);
  page.subtitle = measured_subtitle(measured.means, request.spec.seed);
  return draw_line_page(page);
}

Canvas draw_radial_spectrum_figure(const FigureRequest& request, const Catalogue& catalogue) {
  const auto requests = requests_of(request, catalogue, 2, [&](double count) {
    const int most = static_cast<int>(std::min(512.0, std::ceil(3 * std::sqrt(count))));
    return figure_measures(request, {"radial-spectrum"}, {"radial-spectrum", "anisotropy"},
                           fmt::format("size={}", 2 * most));
  });
  const FigureMeasurements measured = measure_for_figure(request, catalogue, requests);
  LinePage page = radial_spectrum_page(measured.means, request.side_by_side);
  check_charts(page);
  page.subtitle = measured_subtitle(measured.means, request.spec.seed);
  return draw_line_page(page);
}

}  // namespace halfslope
