// Paths a second through the Cornell box to depth 8, points, every term, heuristics and sums: each instruction set
// against the scalar build of the same kernels, every heuristic from one pass against one alone, and how much of a pass
// its points are. What is compared runs in turns, in one run.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "estimators/estimator.h"
#include "estimators/pass_evaluator.h"
#include "estimators/path_transport.h"
#include "samplers/catalogue.h"
#include "scenes/catalogue.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kPaths = 64;  // for each of kLanes replicates
constexpr int kSide = 16;             // pixels
const std::vector<std::string> kEvery = {"path-light", "path-bsdf",    "path-average", "path-balance",
                                         "path-power", "path-maximum", "path-cutoff"};

/// Passes over the pixels of a scene in turn, with the kernels of one instruction set.
template <class T>
class Passes {
 public:
  Passes(Isa isa, const std::string& scene, const std::string& sampler, const std::vector<std::string>& estimators)
      : sampler_(sampler), source_(load_catalogue_scene(scene), kSide, kSide, {8, 0}) {
    setenv("HALFSLOPE_ISA", to_string(isa).c_str(), 1);
    std::vector<Heuristic> heuristics;
    Allocation allocation;
    for (const auto& name : estimators) {
      const Estimator estimator = EstimatorCatalogue::built_in().parse(name, source_);
      heuristics.push_back(estimator.heuristic);
      allocation = estimator.allocation;
    }
    evaluator_ =
        std::make_unique<PassEvaluator<T>>(SamplerCatalogue::built_in().make(sampler), source_.techniques(), allocation,
                                           heuristics, std::vector<std::uint64_t>{kPaths}, source_.channels());
    for (int p = 0; p < source_.pixels(); ++p) {
      if (auto pixel = source_.pixel(p); pixel.integral) pixels_.push_back(std::move(pixel.integral));
    }
    run();  // which loads the kernels, and makes what the scene needs
    unsetenv("HALFSLOPE_ISA");
  }

  void run() {
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      evaluator_->run(*pixels_[p], stream_key(1, sampler_, "run"), static_cast<std::uint32_t>(p), 0);
      benchmark::DoNotOptimize(evaluator_->estimates(0, 0, 0));
    }
  }
  void points() {
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      evaluator_->make_points(stream_key(1, sampler_, "run"), static_cast<std::uint32_t>(p), 0);
    }
  }
  double paths() const { return static_cast<double>(pixels_.size() * kPaths) * kLanes; }

 private:
  std::string sampler_;
  PathTransport source_;
  std::unique_ptr<PassEvaluator<T>> evaluator_;
  std::vector<std::unique_ptr<Integral>> pixels_;
};

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Times {
  double a = 0, b = 0;
};

Times in_turns(benchmark::State& state, const std::function<void()>& a, const std::function<void()>& b) {
  Times times;
  for (auto _ : state) {
    const double of_a = seconds(a), of_b = seconds(b);
    times.a += of_a, times.b += of_b;
    state.SetIterationTime(of_a + of_b);
  }
  return times;
}

template <class T>
void against_scalar(benchmark::State& state, Isa isa, const std::string& scene) {
  Passes<T> packets(isa, scene, "independent", kEvery), scalar(Isa::kScalar, scene, "independent", kEvery);
  const Times times = in_turns(
      state, [&] { packets.run(); }, [&] { scalar.run(); });
  const double paths = static_cast<double>(state.iterations()) * packets.paths();
  state.counters["paths/s"] = paths / times.a;
  state.counters["scalar"] = paths / times.b;
  state.counters["ratio"] = times.b / times.a;
}

/// How much longer every heuristic takes than one.
void every_heuristic(benchmark::State& state, const std::string& scene, const std::string& sampler) {
  Passes<float> every(active_isa(), scene, sampler, kEvery), one(active_isa(), scene, sampler, {"path-power"});
  const Times times = in_turns(
      state, [&] { every.run(); }, [&] { one.run(); });
  state.counters["paths/s"] = static_cast<double>(state.iterations()) * every.paths() / times.a;
  state.counters["ratio"] = times.a / times.b;
}

void points(benchmark::State& state, const std::string& scene, const std::string& sampler) {
  Passes<float> passes(active_isa(), scene, sampler, kEvery);
  const Times times = in_turns(
      state, [&] { passes.run(); }, [&] { passes.points(); });
  state.counters["paths/s"] = static_cast<double>(state.iterations()) * passes.paths() / times.a;
  state.counters["share"] = times.b / times.a;
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime()->MinTime(2);
}

void register_all() {
  for (const Isa isa : supported_isas()) {
    if (isa == Isa::kScalar) continue;
    const std::string name = to_string(isa);
    add("scalar/f32/cornell-box/" + name, [=](auto& state) { against_scalar<float>(state, isa, "cornell-box"); });
    add("scalar/f64/cornell-box/" + name, [=](auto& state) { against_scalar<double>(state, isa, "cornell-box"); });
    add("scalar/f32/glossy-indirect/" + name,
        [=](auto& state) { against_scalar<float>(state, isa, "glossy-indirect"); });
  }
  for (const std::string sampler : {"independent", "sobol-owen", "halton-owen"}) {
    add("every-heuristic/cornell-box/" + sampler, [=](auto& state) { every_heuristic(state, "cornell-box", sampler); });
    add("points/cornell-box/" + sampler, [=](auto& state) { points(state, "cornell-box", sampler); });
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
