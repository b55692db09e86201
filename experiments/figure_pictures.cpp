// veach and glossy: pictures of one scene side by side.
#include <algorithm>
#include <cmath>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/text_fit.h"
#include "analysis/tone_map.h"
#include "core/error.h"
#include "experiments/command_flags.h"
#include "experiments/figures.h"
#include "experiments/message.h"
#include "experiments/picture_labels.h"
#include "experiments/render.h"

namespace halfslope {
namespace {

constexpr double kGap = 7, kHeader = 15, kCaptionLine = 9, kEdge = 1;
constexpr int kMagnified = 4;  // a part of so many times smaller width and height is shown below

/// What a figure of pictures shows where its flags do not say.
struct Defaults {
  std::string scene;
  std::vector<std::string> estimators, samplers;
  std::uint64_t samples;
  std::array<int, 2> resolution;
  double exposure;
  bool magnify;
};

Defaults defaults_of(const std::string& name) {
  if (name == "veach") return {"veach-mis", {"light", "bsdf", "power"}, {"independent"}, 32, {600, 400}, 0, false};
  return {"glossy-reflection", {"light"}, {"independent", "stratified"}, 16, {440, 293}, 0, true};
}

struct Panel {
  std::string title;
  RgbImage image;
};

std::string estimator_title(const std::string& name) {
  if (name == "light") return "light: sampling the lights";
  if (name == "bsdf") return "bsdf: sampling the BSDF";
  if (name == "balance") return "balance: both, balance heuristic";
  if (name == "power") return "power: both, power heuristic";
  return name;
}

/// How far a pixel is from its neighbours' mean, in the sum of its channels.
std::int64_t roughness(const RgbImage& image, int x, int y) {
  std::int64_t sum = 0;
  const std::uint8_t *left = image.pixel(std::max(x - 1, 0), y),
                     *right = image.pixel(std::min(x + 1, image.width - 1), y);
  for (int c = 0; c < 3; ++c) sum += std::abs(2 * image.pixel(x, y)[c] - left[c] - right[c]);
  return sum;
}

/// Corner of the part of `size` pixels where two pictures of the same thing differ most in their noise on the screen.
std::array<int, 2> telling_part(const RgbImage& a, const RgbImage& b, std::array<int, 2> size) {
  // Sums over all parts by a table of sums over rectangles from the top-left corner.
  const auto width = static_cast<std::size_t>(a.width) + 1;
  std::vector<std::int64_t> sums(width * (static_cast<std::size_t>(a.height) + 1), 0);
  const auto sum = [&](int x, int y) -> std::int64_t& {
    return sums[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const std::int64_t difference = roughness(a, x, y) - roughness(b, x, y);
      sum(x + 1, y + 1) = difference + sum(x, y + 1) + sum(x + 1, y) - sum(x, y);
    }
  }
  std::array<int, 2> best = {0, 0};
  std::int64_t largest = -1;  // of either sign: the second picture may be the noisier
  for (int y = 0; y + size[1] <= a.height; ++y) {
    for (int x = 0; x + size[0] <= a.width; ++x) {
      const std::int64_t inside = sum(x + size[0], y + size[1]) - sum(x, y + size[1]) - sum(x + size[0], y) + sum(x, y);
      if (inside > largest) largest = inside, best = {x, y};
    }
  }
  return best;
}

RgbImage part_of(const RgbImage& image, std::array<int, 2> corner, std::array<int, 2> size) {
  RgbImage part(size[0], size[1]);
  for (int y = 0; y < size[1]; ++y) {
    std::copy_n(image.pixel(corner[0], corner[1] + y), 3 * static_cast<std::ptrdiff_t>(size[0]), part.pixel(0, y));
  }
  return part;
}

/// Width on the page: one that makes a pixel a whole number of a PNG's, unless that leaves much of the room empty.
double panel_width(int pixels, double room) {
  const double unit = static_cast<double>(pixels) / kPixelsPerPoint, whole = unit * std::floor(room / unit);
  return whole >= 0.8 * room ? whole : room;
}

std::string plural(std::uint64_t n, const char* thing) { return fmt::format("{} {}{}", n, thing, n == 1 ? "" : "s"); }

}  // namespace

Canvas draw_pictures_figure(const FigureRequest& request, const Catalogue& catalogue) {
  const Defaults defaults = defaults_of(request.name);
  const Spec& spec = request.spec;
  if (spec.scenes.size() > 1) fail(ExitCode::kUsage, "--scene: one at a time");
  const std::string scene = spec.scenes.empty() ? defaults.scene : spec.scenes.front();
  const auto estimators = spec.estimators.empty() ? defaults.estimators : spec.estimators;
  const auto samplers = spec.samplers.empty() ? defaults.samplers : spec.samplers;
  const std::size_t count = estimators.size() * samplers.size();
  if (count > 4)
    fail(ExitCode::kUsage, "--estimators and --samplers: at most 4 pictures side by side, found {}", count);
  const std::uint64_t samples = spec.samples.counts.empty() ? defaults.samples : spec.samples.counts.front();
  const auto of_path = [](const std::string& name) { return is_path_estimator(name); };
  const bool paths = std::all_of(estimators.begin(), estimators.end(), of_path);
  if (!paths && std::any_of(estimators.begin(), estimators.end(), of_path))
    fail(ExitCode::kUsage, "--estimators: pictures of paths and of direct light have nothing to be compared by");
  const auto make = [&](const Catalogue::Resolution& resolution) {
    return paths ? make_path_source(catalogue, scene, resolution, {spec.max_depth, spec.russian_roulette})
                 : make_source(catalogue, scene, resolution);
  };
  if (!make(std::nullopt)->takes_resolution())
    fail(ExitCode::kUsage, "--scene: '{}' has no picture; a rendered scene with a camera is needed", scene);
  const auto source = make(spec.resolution ? *spec.resolution : defaults.resolution);
  const double stops = request.exposure.value_or(defaults.exposure);

  std::vector<RenderSettings> jobs;
  for (const std::string& estimator : estimators) {
    for (const std::string& sampler : samplers) {
      RenderSettings& job = jobs.emplace_back();
      job.sampler = sampler;
      job.samples = samples;
      job.seed = spec.seed;
      job.replicate = request.replicate;
      job.threads = request.threads;
      job.quiet = request.quiet;
      job.label = fmt::format("{}: {}, {}", request.name, estimator, sampler);
      job.estimator = check_render(*source, estimator, job, catalogue, {"--estimators", "--samplers"});
    }
  }
  std::vector<Panel> panels;
  for (const RenderSettings& job : jobs) {
    const std::string title = samplers.size() == 1     ? estimator_title(job.estimator.name)
                              : estimators.size() == 1 ? sampler_label(job.sampler)
                                                       : job.estimator.name + ", " + sampler_label(job.sampler);
    const std::vector<double> values = render_replicate(*source, job, catalogue);
    const auto bad = std::count_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad > 0) message("halfslope: {}: {} values are not finite; their pixels are magenta\n", job.label, bad);
    panels.push_back({title, tone_mapped_image(values, source->width(), source->height(), source->channels(), stops)});
  }

  const PictureLabels labels = picture_labels(scene, source->width(), source->height());
  const double margin = labels.margin() + kEdge, n = static_cast<double>(panels.size());
  const double room = (kPageWidth - margin - kEdge - kGap * (n - 1)) / n;
  const double width = panel_width(source->width(), std::min(room, 300.0));
  const double height = width * source->height() / source->width();
  const double top = kHeader + labels.header(), row = n * width + (n - 1) * kGap;
  const bool magnify = defaults.magnify && panels.size() > 1 && source->width() >= 8 * kMagnified;
  const double bottom = top + height + (magnify ? kGap + height : 0);
  std::string caption = fmt::format("{}: N = {} a pixel", scene, plural(samples, "sample"));
  if (samplers.size() == 1) caption += fmt::format(" ({} points)", sampler_label(samplers.front()));
  if (estimators.size() == 1) caption += fmt::format(" ({})", estimators.front());
  caption += fmt::format(", seed {}; ", spec.seed);
  if (stops != 0) caption += fmt::format("exposure {}{:g} stops, ", stops < 0 ? "\u2212" : "+", std::fabs(stops));
  caption += "radiance above 1 clipped, sRGB.";
  const auto caption_lines = wrapped(caption, kSmallSize, row);
  Canvas canvas(margin + row + kEdge, bottom + kCaptionLine * (static_cast<double>(caption_lines.size()) + 0.7));
  const std::array<int, 2> size = {source->width() / kMagnified, std::max(1, source->height() / kMagnified)};
  const auto corner = magnify ? telling_part(panels[0].image, panels[1].image, size) : std::array<int, 2>{};
  const double point = width / source->width();  // of a pixel
  const Stroke frame = {kBlack, 0.4}, window = {kInkVermillion, 0.9};
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const double left = margin + static_cast<double>(k) * (width + kGap);
    canvas.begin_group(panels[k].title);
    canvas.text({left, 9},
                fitted(fmt::format("({}) {}", static_cast<char>('a' + k), panels[k].title), kLabelSize, width, true),
                {.size = kLabelSize, .bold = true});
    labels.draw(canvas, {left, top}, point, k == 0);
    canvas.picture({left, top}, width, height, panels[k].image);
    canvas.rectangle({left, top}, width, height, {.stroke = frame});
    if (magnify) {
      canvas.rectangle({left + corner[0] * point, top + corner[1] * point}, size[0] * point, size[1] * point,
                       {.stroke = window});
      canvas.picture({left, top + height + kGap}, width, height, part_of(panels[k].image, corner, size));
      canvas.rectangle({left, top + height + kGap}, width, height, {.stroke = window});
    }
    canvas.end_group();
  }
  for (std::size_t k = 0; k < caption_lines.size(); ++k) {
    canvas.text({margin, bottom + 4 + kCaptionLine * static_cast<double>(k + 1)}, caption_lines[k],
                {.size = kSmallSize, .ink = kInkGrey});
  }
  return canvas;
}

}  // namespace halfslope
