// Coordinates a second of every sampler, per instruction set, in one run: 1024 points of 5 dimensions in groups of
// 1, 2 and 2, kLanes replicates at a time, prepared anew for each pixel as an experiment does.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "samplers/catalogue.h"

namespace halfslope {
namespace {

constexpr int kCount = 1024, kBlock = 32;

void fill_points(benchmark::State& state, const std::string& isa, const std::string& name, bool low_words) {
  setenv("HALFSLOPE_ISA", isa.c_str(), 1);
  const auto sampler = SamplerCatalogue::built_in().make(name);
  const Layout layout = {{1, 2, 2}};
  PointBlock block;
  std::uint32_t pixel = 0;
  for (auto _ : state) {
    sampler->prepare({kCount, &layout, stream_key(1, name, "run"), pixel++, 0, low_words});
    for (int begin = 0; begin < kCount; begin += kBlock) {
      block.reset(layout.dims(), kBlock, low_words);
      sampler->fill(static_cast<std::uint64_t>(begin), block);
      benchmark::DoNotOptimize(block.high(0));
    }
  }
  state.SetItemsProcessed(state.iterations() * kCount * kLanes * layout.dims());
  unsetenv("HALFSLOPE_ISA");
}

}  // namespace
}  // namespace halfslope

int main(int argc, char** argv) {
  using namespace halfslope;
  std::vector<std::string> samplers = {"padded:halton-owen"};  // of a family, one
  for (const std::string& name : SamplerCatalogue::built_in().names()) {
    if (name.find(':') == std::string::npos) samplers.push_back(name);
  }
  for (const std::string& sampler : samplers) {
    for (const bool f64 : {false, true}) {
      for (const Isa isa : supported_isas()) {
        const std::string name = "coordinates/" + sampler + (f64 ? "/f64/" : "/f32/") + to_string(isa);
        benchmark::RegisterBenchmark(
            name.c_str(), [=](benchmark::State& state) { fill_points(state, to_string(isa), sampler, f64); });
      }
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
