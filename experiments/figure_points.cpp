// points: what samplers' points look like.
#include <algorithm>
#include <cmath>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "core/error.h"
#include "experiments/command_flags.h"
#include "experiments/figure_samplers.h"
#include "experiments/figures.h"
#include "experiments/panel_grid.h"
#include "samplers/stratified.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

constexpr double kCaptionLine = 9;
constexpr std::size_t kMostPanels = 24;
constexpr std::uint64_t kMostPoints = 1 << 16;

struct Panel {
  SamplerInfo info;
  std::vector<Position> points;  ///< in the unit square, y upwards
  Grid strata;                   ///< 1 × 1 where there are none
};

/// The strata that hold one point each, in the two dimensions that are drawn.
Grid strata_of(const SamplerInfo& info, std::uint64_t count, std::array<int, 2> axes) {
  const std::string& name = info.name;
  if (name == "n-rooks") return {count, count};
  if (name == "orthogonal-array") return squarest_grid(count);
  const auto [low, high] = std::minmax(axes[0], axes[1]);
  // The full grid is over all dimensions; those of pairs, over each pair.
  const bool full = name == "jittered" || name == "regular";
  const bool paired = name == "stratified" || name == "multi-jittered" || name == "correlated-multi-jittered";
  if (!(full && high == 1) && !(paired && low % 2 == 0 && high == low + 1)) return {1, 1};
  const Grid grid = squarest_grid(count);
  return axes[0] == low ? grid : Grid{grid.rows, grid.columns};
}

Panel sample(const std::string& name, const FigureRequest& request, const Catalogue& catalogue) {
  const auto sampler = catalogue.samplers.make(name);
  Panel panel{sampler->info(), {}, {}};
  const std::uint64_t count = figure_counts(request, panel.info, {{100}, false}).counts.front();
  if (count > kMostPoints) {
    fail(ExitCode::kUsage, "--samples: at most {} points can be told apart, found {} of '{}'", kMostPoints, count,
         name);
  }
  const Layout layout = pairs(std::max(request.axes[0], request.axes[1]) + 1);
  check_count(*sampler, count, layout, "--samples");
  check_replicate(panel.info, request.replicate);
  panel.strata = strata_of(panel.info, count, request.axes);
  sampler->prepare({count, &layout, stream_key(request.spec.seed, name, "run"), 0, request.replicate, true});
  PointBlock block;
  block.reset(layout.dims(), static_cast<int>(count), true);
  sampler->fill(0, block);
  for (int s = 0; s < block.samples(); ++s)
    panel.points.push_back({block.coordinate(request.axes[0], s, 0), block.coordinate(request.axes[1], s, 0)});
  return panel;
}

void draw_strata(Canvas& canvas, const Axes& axes, const Grid& grid) {
  // Rows and columns of many rooks are a fabric rather than lines.
  const Stroke stroke = {kInkLightGrey, std::min(0.5, 0.12 * axes.width / static_cast<double>(grid.columns))};
  for (std::uint64_t k = 1; k < grid.columns; ++k) {
    const double x = static_cast<double>(k) / static_cast<double>(grid.columns);
    canvas.line({axes.at(x, 0), axes.at(x, 1)}, stroke);
  }
  for (std::uint64_t k = 1; k < grid.rows; ++k) {
    const double y = static_cast<double>(k) / static_cast<double>(grid.rows);
    canvas.line({axes.at(0, y), axes.at(1, y)}, stroke);
  }
}

std::string subtitle(const SamplerInfo& info) {
  if (info.replicates) return "points from a file";
  if (info.name == "independent") return "uniform random points";
  if (info.name == "jittered" || info.name == "stratified") return "random, one point in each cell";
  if (info.name == "n-rooks") return "one point in each row and column";
  return fmt::format("{} {}", info.randomised ? "randomised" : "deterministic", info.sequence ? "sequence" : "set");
}

void draw_panel(Canvas& canvas, const Panel& panel, Position top_left, double side, bool y_labels, bool tell_count) {
  const std::vector<Tick> ticks = {{0, "0"}, {0.5, "0.5"}, {1, "1"}}, bare = {{0, ""}, {0.5, ""}, {1, ""}};
  const Axes axes{
      {top_left.x, top_left.y + kPanelHeader}, side, side, {{}, ticks, ""}, {{}, y_labels ? ticks : bare, ""}};
  const std::string count = tell_count ? fmt::format("N = {}, ", panel.points.size()) : "";
  canvas.begin_group(panel.info.name);
  draw_panel_titles(canvas, top_left, side, sampler_label(panel.info.name), count + subtitle(panel.info));
  draw_strata(canvas, axes, panel.strata);
  axes.draw_frame(canvas);
  // Fewer points are drawn larger; a disc has the area of 1/80 of a point's share of the square, within limits.
  const double radius = std::clamp(side / std::sqrt(80.0 * static_cast<double>(panel.points.size())), 0.35, 2.5);
  for (const Position& p : panel.points) canvas.disc(axes.at(p.x, p.y), radius, {.fill = kInkBlue});
  canvas.end_group();
}

std::string caption_of(const std::vector<Panel>& panels, bool same_count, const FigureRequest& request) {
  const auto& [x, y] = request.axes;
  std::string caption = x == 0 && y == 1
                            ? "The first two dimensions"
                            : fmt::format("Dimensions {} (to the right) and {} (upwards), counted from 0,", x, y);
  caption += same_count ? fmt::format(" of the first N = {} points of each sampler", panels.front().points.size())
                        : " of the first N points of each sampler";
  if (std::ranges::any_of(panels, [](const Panel& panel) { return panel.info.randomised; }))
    caption += fmt::format("; seed {}, replicate {}", request.spec.seed, request.replicate);
  return caption + ".";
}

}  // namespace

Canvas draw_points_figure(const FigureRequest& request, const Catalogue& catalogue) {
  const std::vector<std::string> names =
      figure_samplers(request, catalogue, {"halton", "hammersley", "independent", "jittered", "n-rooks"},
                      std::max(request.axes[0], request.axes[1]) + 1);
  if (names.size() > kMostPanels)
    fail(ExitCode::kUsage, "--samplers: at most {} panels, found {}", kMostPanels, names.size());
  std::vector<Panel> panels;
  for (const std::string& name : names) panels.push_back(sample(name, request, catalogue));
  const bool same_count = std::ranges::all_of(
      panels, [&](const Panel& panel) { return panel.points.size() == panels.front().points.size(); });

  const PanelGrid grid(panels.size(), kPanelHeader, 18);
  const auto caption = wrapped(caption_of(panels, same_count, request), kSmallSize, kPageWidth);
  Canvas canvas(kPageWidth, grid.height() + 7 + kCaptionLine * static_cast<double>(caption.size()));
  for (std::size_t k = 0; k < panels.size(); ++k)
    draw_panel(canvas, panels[k], grid.top_left(k), grid.side(), grid.begins_row(k), !same_count);
  for (std::size_t k = 0; k < caption.size(); ++k) {
    canvas.text({kPageWidth / 2, grid.height() + 10 + kCaptionLine * static_cast<double>(k)}, caption[k],
                {.size = kSmallSize, .anchor = Anchor::kMiddle, .ink = kInkGrey});
  }
  return canvas;
}

}  // namespace halfslope
