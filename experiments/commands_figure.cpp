// figure: draws a page and writes it.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "experiments/commands.h"
#include "experiments/figures.h"
#include "experiments/interrupt.h"
#include "experiments/joined.h"
#include "experiments/message.h"
#include "samplers/file_points.h"

namespace halfslope {
namespace {

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

FigureRequest parse_request(const FigureArguments& a, const FigureInfo& figure) {
  FigureRequest request;
  request.name = a.name;
  request.threads = a.threads;
  request.quiet = a.quiet;
  request.spec.precision.clear();
  if (a.threads != 0 && !takes(figure, "threads")) refuse("threads", figure);
  for (const auto& [key, value] : a.keys) {
    if (!takes(figure, key)) refuse(key, figure);
    if (key == "run") {
      request.run = value;
    } else if (key == "replicate") {
      request.replicate = parse_number<std::uint32_t>(key, value, "an integer from 0 to 2^32 - 1");
    } else if (key == "exposure") {
      request.exposure = parse_number<double>(key, value, "a number of stops");
      if (!(std::fabs(*request.exposure) <= 64)) fail(ExitCode::kUsage, "--exposure: from -64 to 64, found {}", value);
    } else {
      apply_flag(request.spec, key, value);
    }
  }
  if (request.spec.samples.counts.size() > 1) fail(ExitCode::kUsage, "--samples: one N at a time");
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
       {"samplers", "samples", "seed", "replicate"},
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
