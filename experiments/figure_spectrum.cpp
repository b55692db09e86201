// spectrum: the power spectra of samplers' points as pictures.
#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "analysis/typeface.h"
#include "core/error.h"
#include "experiments/figure_measurements.h"
#include "experiments/figure_samplers.h"
#include "experiments/figures.h"
#include "experiments/measured_pages.h"
#include "experiments/panel_grid.h"
#include "experiments/spectrum_image.h"

namespace halfslope {
namespace {

constexpr double kCaptionLine = 9;
constexpr double kRamp = 60;  // width of the scale of greys
constexpr std::int64_t kReplicates = 32;
constexpr std::size_t kMostPanels = 24;
constexpr double kWhite = 2.5;  // power; independent points have 1

/// Grey of a power, black at 0 and white from kWhite.
std::uint8_t grey_of(double power) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(power / kWhite, 0.0, 1.0)));
}

RgbImage grey_picture(const SpectrumImage& spectrum) {
  RgbImage image(spectrum.width, spectrum.height);
  for (std::size_t k = 0; k < spectrum.power.size(); ++k) {
    const double power = spectrum.power[k];
    if (std::isfinite(power)) std::fill_n(image.values.begin() + static_cast<std::ptrdiff_t>(3 * k), 3, grey_of(power));
  }
  return image;
}

/// Of whole frequencies on an axis where each has the width 1.
Axis frequency_axis(int least, int most, bool labels) {
  Axis axis{{false, least - 0.5, most + 0.5}, linear_ticks(least - 0.5, most + 0.5, 5), ""};
  for (Tick& tick : axis.ticks) {
    if (!labels) tick.label.clear();
  }
  return axis;
}

struct Panel {
  const MeasuredPoints* points;
  std::uint64_t count;
  SpectrumImage spectrum;
};

std::vector<Panel> panels_of(const std::vector<MeasuredMean>& means) {
  std::vector<Panel> panels;
  for (auto begin = means.begin(); begin != means.end();) {
    const auto end = std::find_if(begin, means.end(), [&](const MeasuredMean& mean) {
      return mean.points != begin->points || mean.count != begin->count;
    });
    SpectrumImage image = spectrum_image(std::span(begin, end));
    if (image.width > 0) panels.push_back({begin->points, begin->count, std::move(image)});
    begin = end;
  }
  return panels;
}

void draw_panel(Canvas& canvas, const Panel& panel, Position top_left, double side, bool y_labels) {
  SpectrumImage spectrum = panel.spectrum;
  // The frequencies go from −⌊size/2⌋ up; (0, 0), where the power is N whatever the points, is left out.
  const int left = -(spectrum.width / 2), bottom = -(spectrum.height / 2);
  spectrum.power[static_cast<std::size_t>((spectrum.height - 1 + bottom) * spectrum.width - left)] = 0;
  const Axes axes{{top_left.x, top_left.y + kPanelHeader},
                  side,
                  side,
                  frequency_axis(left, left + spectrum.width - 1, true),
                  frequency_axis(bottom, bottom + spectrum.height - 1, y_labels)};
  const std::int64_t replicates = panel.points->replicates;
  canvas.begin_group(panel.points->sampler);
  draw_panel_titles(
      canvas, top_left, side, sampler_label(panel.points->sampler),
      fmt::format("N = {}, {}", panel.count, replicates == 1 ? "one set" : fmt::format("mean of {} sets", replicates)));
  canvas.picture({top_left.x, top_left.y + kPanelHeader}, side, side, grey_picture(spectrum));
  axes.draw_frame(canvas);
  canvas.end_group();
}

/// What black and white are.
void draw_ramp(Canvas& canvas, Position left_baseline) {
  RgbImage ramp(64, 1);
  for (int x = 0; x < ramp.width; ++x)
    std::fill_n(ramp.values.begin() + 3 * x, 3, grey_of(kWhite * x / (ramp.width - 1.0)));
  const TextStyle style = {.size = kSmallSize, .ink = kInkGrey};
  const std::string before = "power 0";
  const double left = left_baseline.x + text_width(before, kSmallSize) + 3;
  canvas.text(left_baseline, before, style);
  canvas.picture({left, left_baseline.y - 5.5}, kRamp, 6, ramp);
  canvas.rectangle({left, left_baseline.y - 5.5}, kRamp, 6, {.stroke = Stroke{kBlack, 0.4}});
  canvas.text({left + kRamp + 3, left_baseline.y}, fmt::format("{:g} and above; independent points: 1", kWhite), style);
}

}  // namespace

Canvas spectrum_page(const std::vector<MeasuredMean>& means, const std::string& subtitle) {
  const std::vector<Panel> panels = panels_of(means);
  const PanelGrid grid(panels.size(), kPanelHeader, 18);
  double left = kPageWidth;
  for (std::size_t k = 0; k < panels.size(); ++k) left = std::min(left, grid.top_left(k).x);
  const auto caption = wrapped(
      "Power |Σ exp(\u22122πi k·x)|²/N at whole frequencies k, the first to the right and the "
      "second upwards; k = 0 is left out. " +
          subtitle + ".",
      kSmallSize, kPageWidth - left - 1);
  Canvas canvas(kPageWidth, grid.height() + 14 + kCaptionLine * static_cast<double>(caption.size() + 1));
  for (std::size_t k = 0; k < panels.size(); ++k)
    draw_panel(canvas, panels[k], grid.top_left(k), grid.side(), grid.begins_row(k));
  double y = grid.height() + 12;
  draw_ramp(canvas, {left, y});
  for (const std::string& line : caption) {
    y += kCaptionLine;
    canvas.text({left, y}, line, {.size = kSmallSize, .ink = kInkGrey});
  }
  return canvas;
}

Canvas draw_spectrum_figure(const FigureRequest& request, const Catalogue& catalogue) {
  std::vector<MeasuresRequest> requests;
  for (const std::string& name :
       figure_samplers(request, catalogue, {"independent", "jittered", "poisson-disk", "sobol-owen"}, 2)) {
    const SampleCounts counts = figure_counts(request, catalogue.samplers.make(name)->info(), {{1024}, false});
    const double root = std::sqrt(static_cast<double>(counts.counts.front()));
    const int most = static_cast<int>(std::min(511.0, std::ceil(2 * root)));
    requests.push_back({{name},
                        counts,
                        2,
                        figure_measures(request, {"spectrum"}, {"spectrum"}, fmt::format("size={}", 2 * most + 1)),
                        request.replicates.value_or(kReplicates),
                        request.spec.seed});
  }
  if (requests.size() > kMostPanels)
    fail(ExitCode::kUsage, "--samplers: at most {} panels, found {}", kMostPanels, requests.size());
  const FigureMeasurements measured = measure_for_figure(request, catalogue, requests);
  return spectrum_page(measured.means, fmt::format("Seed {}", request.spec.seed));
}

}  // namespace halfslope
