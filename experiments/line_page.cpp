#include "experiments/line_page.h"

#include <algorithm>

#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "analysis/typeface.h"
#include "experiments/figures.h"

namespace halfslope {
namespace {

constexpr double kTitle = 18, kPanelHeader = 13, kGap = 12, kCaptionLine = 9, kEdge = 1;
constexpr double kGuideMargin = 20;  // right of the frame, for slopes that leave there
constexpr double kRightMargin = 8;   // half of the last label

/// Where charts stand and how large they are, in points.
struct Plan {
  bool single;
  std::size_t columns, rows;
  double y_axis, column, width, height, header, row_height;

  explicit Plan(const LinePage& page) {
    const std::vector<LineChart>& charts = page.charts;
    single = charts.size() == 1;
    columns = charts.size() == 2 || charts.size() == 4 ? 2 : std::min<std::size_t>(charts.size(), 3);
    rows = (charts.size() + columns - 1) / columns;
    y_axis = header = 0;
    double right = kRightMargin;
    std::size_t most_lines = 0;
    for (const LineChart& chart : charts) {
      most_lines = std::max(most_lines, chart.lines.size());
      if (const auto scales = chart_scales(charts, chart.group)) y_axis = std::max(y_axis, width_of_y_axis(scales->y));
      header = std::max(header, height_above(chart.style) + (chart.title.empty() ? 3 : kPanelHeader));
      if (has_labelled_guides(chart.style)) right = kGuideMargin;
    }
    const bool beside = single && page.legends;
    column = beside ? std::clamp(kPageWidth - kGap - 3 - legend_width(charts.front()), 230.0, 345.0)
                    : (kPageWidth - kGap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
    if (single) column = std::min(column, 345.0);
    width = column - y_axis - right;
    height = (single ? 0.8 : 1.0) * width;
    const double legend = page.legends ? (static_cast<double>(most_lines) + 1) * kLegendLine + 6 : 0;
    row_height = header + height + kHeightOfXAxis + (single ? 2 : legend + 6);
  }
};

/// A label says what is left of it, so it stands where the chart to the left has another one.
std::string y_label(const LinePage& page, std::size_t k, std::size_t columns) {
  const std::string& label = page.charts[k].style.y_label;
  return k % columns == 0 || page.charts[k - 1].style.y_label != label ? label : "";
}

}  // namespace

Canvas draw_line_page(const LinePage& page) {
  const Plan plan(page);
  const std::vector<std::string> caption = wrapped(page.caption, kSmallSize, kPageWidth - 2 * kEdge);
  Canvas canvas(kPageWidth, kTitle + static_cast<double>(plan.rows) * plan.row_height + 5 +
                                kCaptionLine * static_cast<double>(caption.size()));
  const std::string name = fitted(page.title, 10, kPageWidth - 160, true);
  canvas.text({kEdge, 11}, name, {.size = 10, .bold = true});
  const double title_end = kEdge + text_width(name, 10, true) + 8;
  canvas.text({title_end, 11}, fitted(page.subtitle, kLabelSize, kPageWidth - title_end),
              {.size = kLabelSize, .ink = kInkGrey});
  for (std::size_t k = 0; k < page.charts.size(); ++k) {
    const LineChart& chart = page.charts[k];
    const double left = static_cast<double>(k % plan.columns) * (plan.column + kGap);
    const double top = kTitle + static_cast<double>(k / plan.columns) * plan.row_height + plan.header;
    canvas.text({left + plan.y_axis, top - 4.5 - height_above(chart.style)},
                fitted(chart.title, kLabelSize, plan.column - plan.y_axis, true), {.size = kLabelSize, .bold = true});
    if (auto scales = chart_scales(page.charts, chart.group)) {
      scales->y.label = y_label(page, k, plan.columns);
      draw_chart(canvas, {{left + plan.y_axis, top}, plan.width, plan.height, scales->x, scales->y}, scales->x_above,
                 chart);
    } else {
      canvas.text({left + plan.y_axis, top + 20}, page.nothing, {.size = kSmallSize, .ink = kInkGrey});
    }
    if (!page.legends) continue;
    const Position legend_at = plan.single ? Position{plan.column + kGap, top + kSmallSize}
                                           : Position{left + 2, top + plan.height + kHeightOfXAxis + kLegendLine};
    draw_legend(canvas, chart, legend_at, plan.single ? kPageWidth - plan.column - kGap - 3 : plan.column - 3,
                page.notes_title);
  }
  for (std::size_t k = 0; k < caption.size(); ++k) {
    canvas.text({kEdge, canvas.height() - 4 - kCaptionLine * static_cast<double>(caption.size() - 1 - k)}, caption[k],
                {.size = kSmallSize, .ink = kInkGrey});
  }
  return canvas;
}

}  // namespace halfslope
