#include "experiments/render.h"

#include <tbb/parallel_for.h>

#include "core/error.h"
#include "estimators/pass_evaluator.h"
#include "experiments/command_flags.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"
#include "experiments/plan.h"
#include "experiments/progress.h"

namespace halfslope {
namespace {

template <class T>
void render_rows(const IntegralSource& source, const RenderSettings& s, const Catalogue& catalogue,
                 std::vector<double>& image) {
  const Estimator& estimator = s.estimator;
  const auto rounds = s.samples / static_cast<std::uint64_t>(estimator.allocation.round());
  const auto channels = static_cast<std::size_t>(source.channels());
  Progress progress(s.label, static_cast<double>(s.samples) * source.pixels(), s.quiet);
  with_threads(s.threads, [&](int) {
    tbb::parallel_for(0, source.height(), [&](int y) {
      PassEvaluator<T> evaluator(catalogue.samplers.make(s.sampler), source.techniques(), estimator.allocation,
                                 {estimator.heuristic}, {rounds}, source.channels());
      for (int x = 0; x < source.width() && !interrupted(); ++x) {
        const int p = y * source.width() + x;
        const PixelIntegral pixel = source.pixel(p);
        if (pixel.integral) {
          evaluator.run(*pixel.integral, stream_key(s.seed, s.sampler, "run"), static_cast<std::uint32_t>(p),
                        s.replicate);
        }
        for (std::size_t c = 0; c < channels; ++c) {
          image[static_cast<std::size_t>(p) * channels + c] =
              pixel.constant[c] + (pixel.integral ? evaluator.estimates(0, 0, static_cast<int>(c))[0] : 0.0);
        }
        progress.advance(static_cast<double>(s.samples));
      }
    });
  });
  if (interrupted()) fail(ExitCode::kInterrupted, "interrupted; nothing was written");
  progress.finish();
}

}  // namespace

Estimator check_render(const IntegralSource& source, const std::string& name, const RenderSettings& s,
                       const Catalogue& catalogue, const RenderFlags& flags) {
  const Estimator estimator = flag(flags.estimator, [&] {
    if (!name.empty()) return catalogue.estimators.parse(name, source);
    // Both techniques of a rendered scene; what an integrand has.
    return catalogue.estimators.parse(source.techniques().size() > 1 ? "balance" : source.techniques().front().name,
                                      source.techniques());
  });
  const auto sampler = make_sampler(catalogue, s.sampler, flags.sampler);
  check_replicate(sampler->info(), s.replicate);
  const Layout layout = estimator.allocation.layout(source.techniques());
  if (layout.dims() > sampler->info().max_dims) {
    fail(ExitCode::kUsage, "{}: '{}' has {} dimensions; '{}' on scene '{}' takes {}", flags.sampler, s.sampler,
         sampler->info().max_dims, estimator.name, s.label, layout.dims());
  }
  if (const std::string problem = illegal_samples(estimator, *sampler, layout, s.samples); !problem.empty())
    fail(ExitCode::kUsage, "--samples: {}", problem);
  return estimator;
}

std::vector<double> render_replicate(const IntegralSource& source, const RenderSettings& settings,
                                     const Catalogue& catalogue) {
  std::vector<double> image(static_cast<std::size_t>(source.pixels()) * static_cast<std::size_t>(source.channels()));
  settings.precision == Precision::kF32 ? render_rows<float>(source, settings, catalogue, image)
                                        : render_rows<double>(source, settings, catalogue, image);
  return image;
}

}  // namespace halfslope
