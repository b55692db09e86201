// points, render and reference.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <variant>

#include "analysis/tone_map.h"
#include "core/coordinates.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/exr.h"
#include "experiments/command_flags.h"
#include "experiments/commands.h"
#include "experiments/images.h"
#include "experiments/interrupt.h"
#include "experiments/message.h"
#include "experiments/reference.h"
#include "experiments/render.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

// Rays given one by one are meant to be exact; pictures are not.
constexpr std::size_t kFewPixels = 64;

constexpr int kDone = static_cast<int>(ExitCode::kDone);

}  // namespace

int points_command(const PointsArguments& a, const Catalogue& catalogue) {
  const Precision precision = parse_precision(a.precision);
  if (a.dims < 1) fail(ExitCode::kUsage, "--dims: at least 1, found {}", a.dims);
  const auto sampler = make_sampler(catalogue, a.sampler, "--sampler");
  check_replicate(sampler->info(), a.replicate);
  if (a.dims > sampler->info().max_dims) {
    fail(ExitCode::kUsage, "--dims: sampler '{}' has at most {} dimensions, found {}", a.sampler,
         sampler->info().max_dims, a.dims);
  }
  const Layout layout = pairs(a.dims);
  check_count(*sampler, a.count, layout, "--count");
  std::vector<std::string> columns;
  for (int d = 0; d < a.dims; ++d) columns.push_back(fmt::format("x{}", d));
  sampler->prepare({a.count, &layout, stream_key(a.seed, a.sampler, "run"), a.pixel, a.replicate, true});
  PointBlock block;
  constexpr std::uint64_t kBlock = 256;
  for (std::uint64_t begin = 0; begin < a.count; begin += kBlock) {
    block.reset(a.dims, static_cast<int>(std::min(kBlock, a.count - begin)), true);
    sampler->fill(begin, block);
    CsvWriter csv(columns);
    for (int s = 0; s < block.samples(); ++s) {
      for (int d = 0; d < a.dims; ++d) {
        const double x = block.coordinate(d, s, 0);
        csv.cell(precision == Precision::kF32
                     ? static_cast<double>(static_cast<std::int32_t>(block.high(d)[s * kLanes] >> 8)) * 0x1p-24
                     : x);
      }
      csv.end_row();
    }
    const std::string text = csv.text();
    const std::size_t from = begin == 0 ? 0 : text.find('\n') + 1;
    if (std::fwrite(text.data() + from, 1, text.size() - from, stdout) != text.size() - from) {
      fail(ExitCode::kIo, "the points could not be written to standard output");
    }
  }
  return kDone;
}

int render_command(const RenderArguments& a, const Catalogue& catalogue) {
  const InterruptGuard guard;
  const Precision precision = parse_precision(a.precision);
  const auto resolution = parse_resolution(a.resolution);
  if (a.max_depth && !is_path_estimator(a.estimator)) {
    fail(ExitCode::kUsage, "--max_depth is for paths: give an --estimator such as path-balance");
  }
  const auto source = is_path_estimator(a.estimator)
                          ? make_path_source(catalogue, a.scene, resolution, {a.max_depth, std::nullopt})
                          : make_source(catalogue, a.scene, resolution);
  RenderSettings settings;
  settings.sampler = a.sampler;
  settings.samples = a.samples;
  settings.seed = a.seed;
  settings.replicate = a.replicate;
  settings.precision = precision;
  settings.threads = a.threads;
  settings.quiet = a.quiet;
  settings.label = a.scene;
  settings.estimator = check_render(*source, a.estimator, settings, catalogue);
  const std::filesystem::path out = a.out.empty() ? path_component(a.scene) + ".exr" : a.out;
  if (out.extension() != ".exr" && out.extension() != ".png") {
    fail(ExitCode::kUsage, "--out: '{}', allowed: a name that ends in .exr or .png", out.string());
  }
  if (a.exposure != 0 && out.extension() == ".exr") {
    fail(ExitCode::kUsage, "--exposure is for a .png; an .exr holds the radiance itself");
  }
  if (!std::isfinite(a.exposure)) fail(ExitCode::kUsage, "--exposure: a finite number, found {}", a.exposure);
  const std::vector<double> values = render_replicate(*source, settings, catalogue);
  if (out.extension() == ".png") {
    write_png(out, tone_mapped_image(values, source->width(), source->height(), source->channels(), a.exposure));
  } else {
    write_exr(out, picture(*source, values));
  }
  if (!a.quiet) message("wrote {}\n", out.string());
  return kDone;
}

int reference_command(const ReferenceArguments& a, const Catalogue& catalogue) {
  const InterruptGuard guard;
  const auto resolution = parse_resolution(a.resolution);
  if (a.max_depth && !a.paths) fail(ExitCode::kUsage, "--max_depth is for paths: give --paths as well");
  const auto source = a.paths ? make_path_source(catalogue, a.scene, resolution, {a.max_depth, 0})
                              : make_source(catalogue, a.scene, resolution);
  std::vector<int> pixels(static_cast<std::size_t>(source->pixels()));
  for (std::size_t p = 0; p < pixels.size(); ++p) pixels[p] = static_cast<int>(p);
  ReferenceGoal goal;
  const bool few = pixels.size() <= kFewPixels;
  goal.samples = a.samples.value_or(few ? 1 << 19 : 8192);
  if (few && !a.samples) goal.most_samples = std::uint64_t{1} << 28;
  if (goal.samples < 4) fail(ExitCode::kUsage, "--samples: at least 4, found {}", goal.samples);
  goal.relative_error = a.relative_error.value_or(few ? 1e-5 : 1e-3);
  goal.most_replicates = a.most_replicates;
  if (!(goal.relative_error > 0))
    fail(ExitCode::kUsage, "--relative-error: a positive number, found {}", goal.relative_error);
  const Reference reference =
      make_reference(*source, a.scene, pixels, goal,
                     {a.threads, a.quiet, a.no_cache ? std::filesystem::path() : default_cache()}, catalogue.samplers);
  if (!a.quiet) message("{}: {}\n", a.scene, reference.origin);
  if (!a.out.empty()) write_exr(a.out, reference_image(*source, reference));
  const auto channels = static_cast<std::size_t>(source->channels());
  if (a.json) {
    nlohmann::ordered_json json = {
        {"scene", a.scene}, {"origin", reference.origin}, {"mean", reference.mean}, {"mean_se", reference.mean_se}};
    for (std::size_t i = 0; i < reference.value.size(); ++i) {
      json["integrals"].push_back({{"pixel", i / channels},
                                   {"channel", i % channels},
                                   {"value", reference.value[i]},
                                   {"se", std::sqrt(reference.variance[i])}});
    }
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (a.out.empty()) {
    CsvWriter csv({"scene", "pixel", "channel", "value", "se"});
    for (std::size_t i = 0; i < reference.value.size(); ++i) {
      csv.row(a.scene, i / channels, i % channels, reference.value[i], std::sqrt(reference.variance[i]));
    }
    fmt::print("{}", csv.text());
  }
  if (const auto pixel = reference.first_nonfinite(source->channels()))
    fail(ExitCode::kCheckFailed, "scene '{}': the reference is not finite, first at pixel {}", a.scene, pixels[*pixel]);
  return kDone;
}

}  // namespace halfslope
