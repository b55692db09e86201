// figure: draws a page and writes it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "experiments/commands.h"
#include "experiments/figures.h"
#include "experiments/fold.h"
#include "experiments/interrupt.h"
#include "experiments/joined.h"
#include "experiments/message.h"
#include "samplers/file_points.h"

namespace halfslope {
namespace {

constexpr int kMostDims = 1 << 16;

const FigureInfo& find_figure(const std::vector<FigureInfo>& figures, const std::string& name) {
  std::vector<std::string> names;
  for (const FigureInfo& figure : figures) {
    if (figure.name == name) return figure;
    names.push_back(figure.name);
  }
  fail(ExitCode::kUsage, "there is no figure '{}'{}; allowed: {}", name, did_you_mean(name, names), joined(names));
}

template <class T>
T parse_number(const std::string& key, const std::string& text, const char* allowed) {
  T value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    fail(ExitCode::kUsage, "--{}: found '{}'; allowed: {}", key, text, allowed);
  }
  return value;
}

bool takes(const FigureInfo& figure, const std::string& flag) {
  return std::find(figure.flags.begin(), figure.flags.end(), flag) != figure.flags.end();
}

[[noreturn]] void refuse(const std::string& flag, const FigureInfo& figure) {
  std::string allowed = "--out, --quiet";
  for (const std::string& name : figure.flags) allowed += ", --" + name;
  fail(ExitCode::kUsage, "--{}: the figure '{}' does not take it; allowed: {}", flag, figure.name, allowed);
}

/// "4,5": two different dimensions.
std::array<int, 2> parse_axes(const std::string& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const char* allowed = "two different dimensions counted from 0, such as 4,5";
  std::array<int, 2> axes = {parse_number<int>("axes", text.substr(0, comma), allowed),
                             parse_number<int>("axes", text.substr(std::min(comma + 1, text.size())), allowed)};
  if (std::min(axes[0], axes[1]) < 0 || std::max(axes[0], axes[1]) >= kMostDims || axes[0] == axes[1])
    fail(ExitCode::kUsage, "--axes: found '{}'; allowed: {}, below {}", text, allowed, kMostDims);
  return axes;
}

template <class T>
T parse_within(const std::string& key, const std::string& text, T least, T most) {
  const std::string allowed = fmt::format("an integer from {} to {}", least, most);
  const T value = parse_number<T>(key, text, allowed.c_str());
  if (value < least || value > most) fail(ExitCode::kUsage, "--{}: found '{}'; allowed: {}", key, text, allowed);
  return value;
}

void apply_key(FigureRequest& request, const std::string& key, const std::string& value) {
  if (key == "run") {
    request.run = value;
  } else if (key == "replicate") {
    request.replicate = parse_number<std::uint32_t>(key, value, "an integer from 0 to 2^32 - 1");
  } else if (key == "replicates") {
    request.replicates = parse_within<std::int64_t>(key, value, 1, kMostKept);
  } else if (key == "dims") {
    request.dims = parse_within(key, value, 1, kMostDims);
  } else if (key == "axes") {
    request.axes = parse_axes(value);
  } else if (key == "side-by-side") {
    request.side_by_side = true;
  } else if (key == "exposure") {
    request.exposure = parse_number<double>(key, value, "a number of stops");
    if (!(std::fabs(*request.exposure) <= 64)) fail(ExitCode::kUsage, "--exposure: from -64 to 64, found {}", value);
  } else if (key != "wrap" && key != "clamp") {
    apply_flag(request.spec, key, value);
  }
}

FigureRequest parse_request(const FigureArguments& a, const FigureInfo& figure) {
  FigureRequest request;
  request.name = a.name;
  request.threads = a.threads;
  request.quiet = a.quiet;
  request.spec.precision.clear();
  if (a.threads != 0 && !takes(figure, "threads")) refuse("threads", figure);
  if (!a.files.empty() && !takes(figure, "points")) refuse("points", figure);
  for (const auto& [key, value] : a.keys) {
    if (!takes(figure, key)) refuse(key, figure);
    apply_key(request, key, value);
  }
  const bool wrap = a.keys.contains("wrap"), clamp = a.keys.contains("clamp");
  if ((wrap || clamp) && a.files.empty())
    fail(ExitCode::kUsage, "--{}: is about the points of --points FILE", wrap ? "wrap" : "clamp");
  for (const std::string& file : a.files)
    request.spec.samplers.push_back((wrap ? "file-wrap:" : clamp ? "file-clamp:" : "file:") + file);
  if (request.spec.samples.counts.size() > 1 && !figure.several_counts)
    fail(ExitCode::kUsage, "--samples: one N at a time");
  return request;
}

}  // namespace

std::string sampler_label(const std::string& sampler) {
  const std::string file = std::filesystem::path(point_file_of(sampler)).filename().string();
  return file.empty() ? sampler : sampler.substr(0, sampler.find(':') + 1) + file;
}

std::vector<FigureInfo> figure_catalogue() {
  return {
      {"veach",
       "plates and lights by each estimator at equal N",
       "Veach & Guibas, Optimally Combining Sampling Techniques for Monte Carlo Rendering, SIGGRAPH 1995, fig. 2",
       {"scene", "estimators", "samplers", "samples", "resolution", "seed", "replicate", "exposure", "threads"},
       draw_pictures_figure},
      {"points",
       "the first N points of each sampler in the unit square",
       "Shirley, Discrepancy as a Quality Measure for Sample Distributions, Eurographics 1991",
       {"samplers", "points", "wrap", "clamp", "samples", "axes", "seed", "replicate"},
       draw_points_figure},
      {"glossy",
       "a glossy reflection by each sampler at equal N, with a part magnified",
       "Cook, Porter & Carpenter, Distributed Ray Tracing, SIGGRAPH 1984",
       {"scene", "estimators", "samplers", "samples", "resolution", "seed", "replicate", "exposure", "threads"},
       draw_pictures_figure},
      {"convergence",
       "RMSE against N of a run folder, with intervals, rates and slope guides",
       "docs/columns.md",
       {"run", "scene", "estimators", "samplers", "precision"},
       draw_convergence_figure},
      {"work-precision",
       "RMSE against the CPU time of an integral, of a run folder with timings",
       "docs/timing.md",
       {"run", "scene", "estimators", "samplers", "precision"},
       draw_work_precision_figure},
      {"rates",
       "rates between neighbouring N of a run folder, with intervals and what theory promises",
       "docs/rates.md",
       {"run", "scene", "estimators", "samplers", "precision"},
       draw_rates_figure},
      {"discrepancy",
       "discrepancies of each sampler's points against N, with intervals, slopes and slope guides",
       "Shirley, Discrepancy as a Quality Measure for Sample Distributions, Eurographics 1991",
       {"samplers", "points", "wrap", "clamp", "samples", "dims", "measures", "replicates", "seed", "threads"},
       draw_discrepancy_figure,
       true},
      {"spectrum",
       "the power spectrum of each sampler's points as a picture",
       "Ulichney, Dithering with Blue Noise, Proc. IEEE 76(1), 1988",
       {"samplers", "points", "wrap", "clamp", "samples", "measures", "replicates", "seed", "threads"},
       draw_spectrum_figure},
      {"radial-spectrum",
       "mean power of each sampler's points at each frequency; also anisotropy",
       "Ulichney, Dithering with Blue Noise, Proc. IEEE 76(1), 1988",
       {"samplers", "points", "wrap", "clamp", "samples", "measures", "replicates", "seed", "side-by-side", "threads"},
       draw_radial_spectrum_figure},
      {"pcf",
       "pair correlation of each sampler's points against distance",
       "Stoyan, Kendall & Mecke, Stochastic Geometry and its Applications, 1995, section 4.5",
       {"samplers", "points", "wrap", "clamp", "samples", "dims", "measures", "replicates", "seed", "side-by-side",
        "threads"},
       draw_pair_correlation_figure},
  };
}

int figure_command(const FigureArguments& a, const Catalogue& catalogue) {
  const InterruptGuard guard;
  const std::vector<FigureInfo> figures = figure_catalogue();
  const FigureInfo& figure = find_figure(figures, a.name);
  const FigureRequest request = parse_request(a, figure);
  const std::string out = a.out.empty() ? a.name + ".png" : a.out;
  const bool svg = out.ends_with(".svg");
  if (!svg && !out.ends_with(".png")) fail(ExitCode::kUsage, "--out: '{}' must end in .png or .svg", out);
  AtomicFile file(out);  // before the work: a folder that is not there is told at once
  const Canvas canvas = figure.draw(request, catalogue);
  file.write(svg ? svg_text(canvas) : encode_png(rasterize(canvas, kPixelsPerPoint), 72.0 * kPixelsPerPoint));
  file.commit();
  if (!a.quiet) message("wrote {}\n", out);
  return static_cast<int>(ExitCode::kDone);
}

}  // namespace halfslope
