// A whole run of the Veach experiment, small: planning, units, journal, tables. One thread against two, in one run.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "experiments/engine.h"

namespace halfslope {
namespace {

void veach_run(benchmark::State& state) {
  const auto out = std::filesystem::temp_directory_path() / "halfslope-engine-benchmark";
  Spec spec;
  apply_flag(spec, "scene", "veach-mis");
  apply_flag(spec, "resolution", "96,64");
  apply_flag(spec, "estimators", "light,bsdf,average,balance,power");
  apply_flag(spec, "samplers", "independent,stratified,n-rooks,halton-owen");
  apply_flag(spec, "samples", "64,256");
  apply_flag(spec, "replicates", "32");
  const Catalogue catalogue = Catalogue::built_in();
  setenv("HALFSLOPE_CACHE", (out / "cache").c_str(), 1);
  RunOptions options = {out / "run", static_cast<int>(state.range(0)), true, true};
  double evaluations = run_experiment(spec, catalogue, options).plan.evaluations();  // fills the reference's cache
  for (auto _ : state) benchmark::DoNotOptimize(run_experiment(spec, catalogue, options).invalid_cells);
  state.SetItemsProcessed(static_cast<std::int64_t>(static_cast<double>(state.iterations()) * evaluations));
  std::filesystem::remove_all(out);
}
BENCHMARK(veach_run)
    ->Name("veach-run/threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MinTime(6);

}  // namespace
}  // namespace halfslope

BENCHMARK_MAIN();
