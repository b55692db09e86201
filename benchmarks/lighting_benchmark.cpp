// Pairs of light and BSDF samples a second on the Veach scene, every heuristic from the same pass: points, both
// techniques, heuristics and sums. Each instruction set against the scalar build of the same kernels, in one run.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "estimators/direct_lighting.h"
#include "estimators/estimator.h"
#include "estimators/pass_evaluator.h"
#include "samplers/catalogue.h"
#include "scenes/catalogue.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kPairs = 512;

template <class T>
void lighting_pairs(benchmark::State& state, const std::string& isa, const std::string& sampler,
                    const std::string& techniques) {
  setenv("HALFSLOPE_ISA", isa.c_str(), 1);
  const DirectLighting source(load_catalogue_scene("veach-mis"), 96, 64);
  std::vector<Heuristic> heuristics;
  Allocation allocation;
  for (const char* name : {"average", "balance", "power"}) {
    const Estimator estimator = parse_estimator(name + ("@" + techniques), source.techniques());
    heuristics.push_back(estimator.heuristic);
    allocation = estimator.allocation;
  }
  if (allocation.techniques.size() == 1) heuristics.resize(1);
  PassEvaluator<T> evaluator(SamplerCatalogue::built_in().make(sampler), source.techniques(), allocation, heuristics,
                             {kPairs}, source.channels());
  // Every 64th pixel that is not constant: all plates, floor and wall in proportion.
  std::vector<std::unique_ptr<Integral>> pixels;
  for (int p = 0; p < source.pixels(); p += 61) {
    if (auto pixel = source.pixel(p); pixel.integral) pixels.push_back(std::move(pixel.integral));
  }
  std::size_t next = 0;
  for (auto _ : state) {
    evaluator.run(*pixels[next], stream_key(1, sampler, "run"), static_cast<std::uint32_t>(next), 0);
    benchmark::DoNotOptimize(evaluator.estimates(0, 0, 0));
    next = (next + 1) % pixels.size();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPairs) * kLanes);
  unsetenv("HALFSLOPE_ISA");
}

void register_all() {
  for (const std::string sampler : {"independent", "stratified", "n-rooks", "halton-owen"}) {
    for (const Isa isa : supported_isas()) {
      const std::string name = to_string(isa);
      benchmark::RegisterBenchmark(("pairs/f32/" + sampler + "/" + name).c_str(), [=](benchmark::State& state) {
        lighting_pairs<float>(state, name, sampler, "light+bsdf");
      });
    }
  }
  for (const Isa isa : supported_isas()) {
    const std::string name = to_string(isa);
    benchmark::RegisterBenchmark(("three/f32/independent/" + name).c_str(), [=](benchmark::State& state) {
      lighting_pairs<float>(state, name, "independent", "light+bsdf+cosine");
    });
    benchmark::RegisterBenchmark(("pairs/f64/independent/" + name).c_str(), [=](benchmark::State& state) {
      lighting_pairs<double>(state, name, "independent", "light+bsdf");
    });
    for (const std::string technique : {"light", "bsdf", "hemisphere", "cosine", "surface"}) {
      benchmark::RegisterBenchmark((technique + "/f32/independent/" + name).c_str(), [=](benchmark::State& state) {
        lighting_pairs<float>(state, name, "independent", technique);
      });
    }
  }
}

}  // namespace
}  // namespace halfslope

int main(int argc, char** argv) {
  halfslope::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
