// points, render and reference.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <variant>

#include "core/coordinates.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/exr.h"
#include "estimators/pass_evaluator.h"
#include "experiments/commands.h"
#include "experiments/images.h"
#include "experiments/interrupt.h"
#include "experiments/message.h"
#include "experiments/parallel.h"
#include "experiments/progress.h"
#include "experiments/reference.h"

namespace halfslope {
namespace {

// Rays given one by one are meant to be exact; pictures are not.
constexpr std::size_t kFewPixels = 64;

constexpr int kDone = static_cast<int>(ExitCode::kDone);

// An error in a flag's value is an error of usage.
template <class Make>
auto flag(const char* name, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    fail(ExitCode::kUsage, "{}: {}", name, error.what());
  }
}

Catalogue::Resolution parse_resolution(const std::string& text) {
  Spec spec;
  if (!text.empty()) apply_flag(spec, "resolution", text);
  return spec.resolution;
}

Precision parse_precision(const std::string& text) {
  Spec spec;
  apply_flag(spec, "precision", text);
  if (spec.precision.size() != 1) fail(ExitCode::kUsage, "--precision: one of f32, f64 at a time");
  return spec.precision.front();
}

// A file's fault stays the file's (exit 3); an unknown name in a flag is the flag's.
std::unique_ptr<IntegralSource> make_source(const Catalogue& catalogue, const std::string& scene,
                                            const std::string& resolution) {
  const auto size = parse_resolution(resolution);
  if (scene.ends_with(".xml")) return catalogue.make_scene(scene, size);
  return flag("--scene", [&] { return catalogue.make_scene(scene, size); });
}

template <class T>
void render_rows(const IntegralSource& source, const Estimator& estimator, const RenderArguments& a,
                 const Catalogue& catalogue, std::vector<double>& image) {
  const auto rounds = a.samples / static_cast<std::uint64_t>(estimator.allocation.round());
  const auto channels = static_cast<std::size_t>(source.channels());
  Progress progress(a.scene, static_cast<double>(a.samples) * source.pixels(), a.quiet);
  with_threads(a.threads, [&](int) {
    tbb::parallel_for(0, source.height(), [&](int y) {
      PassEvaluator<T> evaluator(catalogue.samplers.make(a.sampler), source.techniques(), estimator.allocation,
                                 {estimator.heuristic}, {rounds}, source.channels());
      for (int x = 0; x < source.width() && !interrupted(); ++x) {
        const int p = y * source.width() + x;
        const PixelIntegral pixel = source.pixel(p);
        if (pixel.integral) {
          evaluator.run(*pixel.integral, stream_key(a.seed, a.sampler, "run"), static_cast<std::uint32_t>(p),
                        a.replicate);
        }
        for (std::size_t c = 0; c < channels; ++c) {
          image[static_cast<std::size_t>(p) * channels + c] =
              pixel.constant[c] + (pixel.integral ? evaluator.estimates(0, 0, static_cast<int>(c))[0] : 0.0);
        }
        progress.advance(static_cast<double>(a.samples));
      }
    });
  });
  if (interrupted()) fail(ExitCode::kInterrupted, "interrupted; nothing was written");
  progress.finish();
}

}  // namespace

int points_command(const PointsArguments& a, const Catalogue& catalogue) {
  const Precision precision = parse_precision(a.precision);
  if (a.dims < 1) fail(ExitCode::kUsage, "--dims: at least 1, found {}", a.dims);
  const auto sampler = flag("--sampler", [&] { return catalogue.samplers.make(a.sampler); });
  if (a.dims > sampler->info().max_dims) {
    fail(ExitCode::kUsage, "--dims: sampler '{}' has at most {} dimensions, found {}", a.sampler,
         sampler->info().max_dims, a.dims);
  }
  // Pairs, and a single dimension last where the number is odd.
  Layout layout;
  layout.groups.assign(static_cast<std::size_t>(a.dims) / 2, 2);
  if (a.dims % 2 == 1) layout.groups.push_back(1);
  if (const auto neighbours = sampler->illegal(a.count, layout)) {
    std::string nearest;
    for (const auto& n : {neighbours->below, neighbours->above}) {
      if (n) nearest += (nearest.empty() ? "" : " and ") + std::to_string(*n);
    }
    fail(ExitCode::kUsage, "--count: sampler '{}' cannot make {} points in {} dimensions; the nearest legal: {}",
         a.sampler, a.count, a.dims, nearest);
  }
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
  const auto source = make_source(catalogue, a.scene, a.resolution);
  const Estimator estimator = flag("--estimator", [&] {
    if (!a.estimator.empty()) return catalogue.estimators.parse(a.estimator, source->techniques());
    // Both techniques of a rendered scene; what an integrand has.
    return catalogue.estimators.parse(source->techniques().size() > 1 ? "balance" : source->techniques().front().name,
                                      source->techniques());
  });
  const auto sampler = flag("--sampler", [&] { return catalogue.samplers.make(a.sampler); });
  const Layout layout = estimator.allocation.layout(source->techniques());
  if (layout.dims() > sampler->info().max_dims) {
    fail(ExitCode::kUsage, "--sampler: '{}' has {} dimensions; '{}' on scene '{}' takes {}", a.sampler,
         sampler->info().max_dims, a.estimator, a.scene, layout.dims());
  }
  if (const std::string problem = illegal_samples(estimator, *sampler, layout, a.samples); !problem.empty())
    fail(ExitCode::kUsage, "--samples: {}", problem);
  const auto channels = static_cast<std::size_t>(source->channels());
  Reference picture;  // one replicate: values without a variance
  picture.value.resize(static_cast<std::size_t>(source->pixels()) * channels);
  precision == Precision::kF32 ? render_rows<float>(*source, estimator, a, catalogue, picture.value)
                               : render_rows<double>(*source, estimator, a, catalogue, picture.value);
  picture.variance.assign(picture.value.size(), 0);
  ExrImage image = reference_image(*source, picture);
  std::erase_if(image.channels, [](const ExrImage::Channel& c) { return c.name.starts_with("variance"); });
  const std::string out = a.out.empty() ? path_component(a.scene) + ".exr" : a.out;
  write_exr(out, image);
  if (!a.quiet) message("wrote {}\n", out);
  return kDone;
}

int reference_command(const ReferenceArguments& a, const Catalogue& catalogue) {
  const InterruptGuard guard;
  const auto source = make_source(catalogue, a.scene, a.resolution);
  std::vector<int> pixels(static_cast<std::size_t>(source->pixels()));
  for (std::size_t p = 0; p < pixels.size(); ++p) pixels[p] = static_cast<int>(p);
  ReferenceGoal goal;
  const bool few = pixels.size() <= kFewPixels;
  goal.samples = a.samples.value_or(few ? 1 << 19 : 8192);
  if (goal.samples < 4) fail(ExitCode::kUsage, "--samples: at least 4, found {}", goal.samples);
  goal.compare_samples = goal.samples / 4;
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
