#include "experiments/pilot.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "analysis/moments.h"
#include "core/error.h"
#include "core/random.h"
#include "estimators/pass_evaluator.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"
#include "experiments/progress.h"

namespace halfslope {
namespace {

constexpr std::size_t kMostPixels = 64;
constexpr const char* kStandIn = "halton-owen";

// Those of the chosen pixels that are sampled at all: known constants have no error, whatever measures them.
std::vector<std::size_t> sampled_positions(const PlannedScene& scene) {
  std::vector<std::size_t> sampled;
  for (std::size_t p = 0; p < scene.pixels.size(); ++p) {
    if (scene.source->pixel(scene.pixels[p]).integral) sampled.push_back(p);
  }
  return sampled;
}

bool same_points(const PilotPass& a, const PilotPass& b) {
  return a.precision == b.precision && a.sampler == b.sampler && a.allocation == b.allocation && a.samples == b.samples;
}

// Variance and mean square of every (heuristic, N): sums over the channels of one pixel.
struct Spread {
  double variance = 0, square = 0;
};

template <class T>
std::vector<Spread> measure(const PlannedScene& scene, const PilotPass& pass, int pixel,
                            const SamplerCatalogue& samplers) {
  const IntegralSource& source = *scene.source;
  std::vector<Heuristic> heuristics;
  for (const std::size_t e : pass.estimators) heuristics.push_back(scene.estimators[e].heuristic);
  std::vector<std::uint64_t> rounds;
  for (const std::uint64_t n : pass.samples) rounds.push_back(n / static_cast<std::uint64_t>(pass.allocation.round()));
  PassEvaluator<T> evaluator(samplers.make(pass.sampler), source.techniques(), pass.allocation, heuristics, rounds,
                             source.channels());
  const PixelIntegral integral = source.pixel(pixel);
  evaluator.run(*integral.integral, stream_key(0, pass.sampler, "pilot"), static_cast<std::uint32_t>(pixel),
                kFirstPilotReplicate);
  std::vector<Spread> spreads;
  for (std::size_t h = 0; h < heuristics.size(); ++h) {
    for (std::size_t n = 0; n < rounds.size(); ++n) {
      Spread& spread = spreads.emplace_back();
      for (int c = 0; c < source.channels(); ++c) {
        std::vector<double> values(evaluator.estimates(h, n, c), evaluator.estimates(h, n, c) + pass.replicates);
        for (double& value : values) value += integral.constant[static_cast<std::size_t>(c)];
        Moments moments;
        moments.add(std::span<const double>(values));
        spread.variance += moments.variance();
        spread.square += moments.mean * moments.mean;
      }
    }
  }
  return spreads;
}

}  // namespace

double Pilot::evaluations() const {
  double sum = 0;
  for (const PilotPass& pass : passes)
    sum += static_cast<double>(pass.samples.back()) * kLanes * static_cast<double>(pixels);
  return sum;
}

Pilot plan_pilot(const Plan& plan, std::size_t scene, const SamplerCatalogue& samplers) {
  const PlannedScene& planned = plan.scenes[scene];
  Pilot pilot;
  pilot.pixels = std::min(kMostPixels, sampled_positions(planned).size());
  for (const Pass& pass : plan.passes) {
    if (pass.scene != scene) continue;
    PilotPass wanted = {pass.precision, pass.sampler, pass.allocation, pass.estimators, pass.samples, 0, ""};
    const auto sampler = samplers.make(pass.randomised ? pass.sampler : kStandIn);
    const SamplerInfo& info = sampler->info();
    if (!pass.randomised) {
      const Layout layout = pass.allocation.layout(planned.source->techniques());
      if (layout.dims() > info.max_dims ||
          sampler->illegal(pass.samples.back() / static_cast<std::uint64_t>(pass.allocation.round()), layout)) {
        pilot.left_out.push_back(pass.sampler + " is deterministic");
        continue;
      }
      wanted.sampler = kStandIn;
      wanted.in_place_of = pass.sampler;
    }
    wanted.replicates = std::min(kPilotReplicates, info.replicates_of(kPilotReplicates));
    if (wanted.replicates < 2) {
      pilot.left_out.push_back(pass.sampler + " has one replicate");
      continue;
    }
    if (!info.sequence) wanted.samples = {pass.samples.back()};
    pilot.passes.push_back(std::move(wanted));
  }
  // A stand-in for what is measured anyway, or for a second sampler, says nothing new.
  for (std::size_t p = 0; p < pilot.passes.size();) {
    const auto same = [&](const PilotPass& other) {
      return &other != &pilot.passes[p] && same_points(other, pilot.passes[p]) &&
             (other.in_place_of.empty() || &other < &pilot.passes[p]);
    };
    const bool needless = !pilot.passes[p].in_place_of.empty() && std::ranges::any_of(pilot.passes, same);
    needless ? void(pilot.passes.erase(pilot.passes.begin() + static_cast<std::ptrdiff_t>(p))) : void(++p);
  }
  return pilot;
}

std::vector<PilotPixel> choose_pilot_pixels(const PlannedScene& scene, std::span<const double> sizes) {
  const std::vector<std::size_t> sampled = sampled_positions(scene);
  const auto all = static_cast<double>(scene.pixels.size());
  std::vector<PilotPixel> pixels;
  if (sampled.size() <= kMostPixels) {
    for (const std::size_t position : sampled) pixels.push_back({position, 1 / all});
    return pixels;
  }
  double total = 0;
  for (const std::size_t position : sampled) total += sizes[position];
  const bool uniform = !std::isfinite(total) || total <= 0;
  const auto probability = [&](std::size_t position) {
    const double even = 1 / static_cast<double>(sampled.size());
    return uniform ? even : 0.5 * even + 0.5 * sizes[position] / total;
  };
  const std::uint32_t word = random_word(stream_key(0, "pixels", "pilot"), Draw::kHigh, 0, 0, 0, 0);
  const double start = (word + 0.5) * 0x1p-32;
  double sum = 0,
         next = start;  // in steps of 1/64; the last place of the sum may fall short of 1, but start is below it
  for (const std::size_t position : sampled) {
    const double share = probability(position);
    sum += share * kMostPixels;
    int hits = 0;
    for (; next < sum; next += 1) ++hits;
    if (hits > 0) pixels.push_back({position, hits / (static_cast<double>(kMostPixels) * share * all)});
  }
  return pixels;
}

ExpectedError run_pilot(const Plan& plan, std::size_t scene, const Pilot& pilot, std::span<const double> variances,
                        const SamplerCatalogue& samplers, int threads, bool quiet) {
  const PlannedScene& planned = plan.scenes[scene];
  const auto channels = static_cast<std::size_t>(planned.source->channels());
  std::vector<double> sizes(planned.pixels.size());
  for (std::size_t i = 0; i < variances.size(); ++i) sizes[i / channels] += variances[i];
  const std::vector<PilotPixel> chosen = choose_pilot_pixels(planned, sizes);
  const std::size_t pixels = chosen.size();
  ExpectedError smallest;
  if (pixels == 0) return smallest;
  Progress progress(planned.name + ": pilot", pilot.evaluations(), quiet);
  std::atomic<bool> stop = false;
  std::vector<std::vector<Spread>> spreads(pilot.passes.size() * pixels);  // [pass][pixel][heuristic][N]
  with_threads(threads, [&](int) {
    tbb::parallel_for(
        std::size_t{0}, spreads.size(),
        [&](std::size_t index) {
          if (interrupted()) stop = true;
          if (stop) return;
          const PilotPass& pass = pilot.passes[index / pixels];
          const int pixel = planned.pixels[chosen[index % pixels].position];
          spreads[index] = pass.precision == Precision::kF32 ? measure<float>(planned, pass, pixel, samplers)
                                                             : measure<double>(planned, pass, pixel, samplers);
          progress.advance(static_cast<double>(pass.samples.back()) * kLanes);
        },
        tbb::simple_partitioner());
  });
  if (stop) fail(ExitCode::kInterrupted, "interrupted while a pilot ran; run the same command again to go on");
  progress.finish();

  for (std::size_t p = 0; p < pilot.passes.size(); ++p) {
    const PilotPass& pass = pilot.passes[p];
    for (std::size_t cell = 0; cell < pass.estimators.size() * pass.samples.size(); ++cell) {
      Spread sum;  // in the order of pixels, so the bits depend on the plan alone
      for (std::size_t i = 0; i < pixels; ++i) {
        const double weight = chosen[i].weight / static_cast<double>(channels);
        sum.variance += weight * spreads[p * pixels + i][cell].variance;
        sum.square += weight * spreads[p * pixels + i][cell].square;
      }
      ++smallest.cells;
      const double unit = pass.precision == Precision::kF32 ? 0x1p-24 : 0x1p-53, mse = sum.variance;
      const bool measurable = std::isfinite(mse) && mse > 100 * unit * unit * sum.square;
      smallest.without_error += measurable ? 0 : 1;
      if (!measurable || (smallest.mse > 0 && mse >= smallest.mse)) continue;
      smallest.mse = mse;
      smallest.cell = fmt::format("{},{},{},{}", planned.estimators[pass.estimators[cell / pass.samples.size()]].name,
                                  pass.sampler, to_string(pass.precision), pass.samples[cell % pass.samples.size()]);
      if (!pass.in_place_of.empty()) smallest.cell += " for " + pass.in_place_of;
    }
  }
  return smallest;
}

}  // namespace halfslope
