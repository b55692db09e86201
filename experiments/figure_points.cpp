// points: what samplers' points look like.
#include <algorithm>
#include <cmath>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "core/error.h"
#include "experiments/command_flags.h"
#include "experiments/figures.h"
#include "samplers/stratified.h"

namespace halfslope {
namespace {

constexpr double kMargin = 22, kGap = 12, kHeader = 25, kFooter = 16;

struct Panel {
  SamplerInfo info;
  std::vector<Position> points;  ///< in the unit square, y upwards
};

std::string nearest_counts(const LegalNeighbours& neighbours) {
  std::string text;
  for (const auto& n : {neighbours.below, neighbours.above}) {
    if (n) text += (text.empty() ? "" : " and ") + std::to_string(*n);
  }
  return text;
}

Panel sample(const std::string& name, std::uint64_t count, const FigureRequest& request, const Catalogue& catalogue) {
  const auto sampler = make_sampler(catalogue, name, "--samplers");
  check_replicate(sampler->info(), request.replicate);
  Panel panel{sampler->info(), {}};
  const Layout layout{{2}};
  if (panel.info.max_dims < 2) fail(ExitCode::kUsage, "--samplers: '{}' has one dimension; two are drawn", name);
  if (const auto neighbours = sampler->illegal(count, layout)) {
    fail(ExitCode::kUsage, "--samples: sampler '{}' cannot make {} points in 2 dimensions; the nearest legal: {}", name,
         count, nearest_counts(*neighbours));
  }
  sampler->prepare({count, &layout, stream_key(request.spec.seed, name, "run"), 0, request.replicate, true});
  PointBlock block;
  block.reset(2, static_cast<int>(count), true);
  sampler->fill(0, block);
  for (int s = 0; s < block.samples(); ++s)
    panel.points.push_back({block.coordinate(0, s, 0), block.coordinate(1, s, 0)});
  return panel;
}

/// Lines between the strata that hold one point each.
void draw_strata(Canvas& canvas, const Axes& axes, const SamplerInfo& info, std::uint64_t count) {
  Grid grid{1, 1};
  if (info.name == "jittered" || info.name == "stratified" || info.name.find("multi-jittered") != std::string::npos)
    grid = squarest_grid(count);
  if (info.name == "n-rooks") grid = {count, count};
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
  if (info.name == "independent") return "uniform random points";
  if (info.name == "jittered" || info.name == "stratified") return "random, one point in each cell";
  if (info.name == "n-rooks") return "random, one point in each row and column";
  return fmt::format("{} {}", info.randomised ? "randomised" : "deterministic", info.sequence ? "sequence" : "set");
}

void draw_panel(Canvas& canvas, const Panel& panel, Position top_left, double side, bool y_labels) {
  const std::vector<Tick> ticks = {{0, "0"}, {0.5, "0.5"}, {1, "1"}}, bare = {{0, ""}, {0.5, ""}, {1, ""}};
  const Axes axes{{top_left.x, top_left.y + kHeader}, side, side, {{}, ticks, ""}, {{}, y_labels ? ticks : bare, ""}};
  canvas.begin_group(panel.info.name);
  canvas.text({top_left.x, top_left.y + 9}, fitted(sampler_label(panel.info.name), kTitleSize, side, true),
              {.size = kTitleSize, .bold = true});
  canvas.text({top_left.x, top_left.y + 19}, subtitle(panel.info), {.size = kSmallSize, .ink = kInkGrey});
  draw_strata(canvas, axes, panel.info, panel.points.size());
  axes.draw_frame(canvas);
  // Fewer points are drawn larger; a disc has the area of 1/80 of a point's share of the square, within limits.
  const double radius = std::clamp(side / std::sqrt(80.0 * static_cast<double>(panel.points.size())), 0.35, 2.5);
  for (const Position& p : panel.points) canvas.disc(axes.at(p.x, p.y), radius, {.fill = kInkBlue});
  canvas.end_group();
}

}  // namespace

Canvas draw_points_figure(const FigureRequest& request, const Catalogue& catalogue) {
  std::vector<std::string> names = request.spec.samplers;
  if (names.empty()) names = {"halton", "hammersley", "independent", "jittered", "n-rooks"};
  const std::uint64_t count = request.spec.samples.counts.empty() ? 100 : request.spec.samples.counts.front();
  constexpr std::uint64_t kMost = 1 << 16;
  if (count > kMost) fail(ExitCode::kUsage, "--samples: at most {} points can be told apart, found {}", kMost, count);
  std::vector<Panel> panels;
  for (const std::string& name : names) panels.push_back(sample(name, count, request, catalogue));

  // Rows of equal length but the first, so that five are two above three.
  const std::size_t columns = panels.size() == 4 ? 2 : std::min<std::size_t>(panels.size(), 3);
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  const double gaps = kGap * static_cast<double>(columns - 1);
  const double side = std::min(180.0, (kPageWidth - kMargin - 4 - gaps) / static_cast<double>(columns));
  const double row_height = kHeader + side + 18;
  Canvas canvas(kPageWidth, static_cast<double>(rows) * row_height + kFooter);
  std::size_t next = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t in_row = row == 0 ? panels.size() - (rows - 1) * columns : columns;
    const double width = static_cast<double>(in_row) * (side + kGap) - kGap;
    const double left = kMargin + (kPageWidth - kMargin - 4 - width) / 2;
    for (std::size_t k = 0; k < in_row; ++k) {
      draw_panel(canvas, panels[next++],
                 {left + static_cast<double>(k) * (side + kGap), static_cast<double>(row) * row_height}, side, k == 0);
    }
  }
  const bool randomised =
      std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.info.randomised; });
  std::string caption = fmt::format("The first two dimensions of the first N = {} points of each sampler", count);
  if (randomised) caption += fmt::format("; seed {}, replicate {}", request.spec.seed, request.replicate);
  canvas.text({kPageWidth / 2, canvas.height() - 6}, caption + ".",
              {.size = kSmallSize, .anchor = Anchor::kMiddle, .ink = kInkGrey});
  return canvas;
}

}  // namespace halfslope
