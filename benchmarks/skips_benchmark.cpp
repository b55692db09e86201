// What a scene doesn't need, left out: pairs of light and BSDF samples a second with and without each skip, taken in
// turns in one run, beside what the plan claims for it (estimators/skip_worth.h).
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimators/direct_lighting.h"
#include "estimators/estimator.h"
#include "estimators/pass_evaluator.h"
#include "estimators/skip_worth.h"
#include "samplers/catalogue.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kPairs = 2048;

Primitive flat(const Vec3& center, const Vec3& half_u, const Vec3& half_v, const Rgb& reflectance) {
  Primitive primitive;
  primitive.shape = Flat{center, half_u, half_v, half_u.cross(half_v).normalized()};
  primitive.bsdf.reflectance = reflectance;
  return primitive;
}

Primitive lamp(const Vec3& center, double radius, const Rgb& radiance) {
  Primitive primitive;
  primitive.shape = Sphere{center, radius};
  primitive.bsdf.reflectance = Rgb::Zero();
  primitive.emits = true;
  primitive.radiance = radiance;
  return primitive;
}

/// A glossy floor seen at its middle, under what is added to it.
Scene floor_under(std::vector<Primitive> others, const Rgb& reflectance = Rgb::Constant(0.5)) {
  Primitive floor = flat(Vec3::Zero(), 5 * Vec3::UnitX(), 5 * Vec3::UnitY(), reflectance);
  floor.bsdf.kind = BsdfKind::kRoughConductor;
  floor.bsdf.alpha = 0.2;
  others.insert(others.begin(), floor);
  Scene scene;
  scene.primitives = std::move(others);
  scene.sensor.kind = Sensor::Kind::kRays;
  scene.sensor.rays = {{Vec3(0, -1, 1), Vec3(0, 1, -1).normalized()}};
  return scene;
}

/// Evaluates estimators in one pass over the scene's one pixel.
class Pass {
 public:
  Pass(const Scene& scene, const std::vector<std::string>& estimators)
      : source_(scene, 1, 1), pixel_(source_.pixel(0)) {
    std::vector<Heuristic> heuristics;
    Allocation allocation;
    for (const auto& name : estimators) {
      const Estimator estimator = parse_estimator(name, source_.techniques());
      heuristics.push_back(estimator.heuristic);
      allocation = estimator.allocation;
    }
    evaluator_ = std::make_unique<PassEvaluator<float>>(SamplerCatalogue::built_in().make("independent"),
                                                        source_.techniques(), allocation, heuristics,
                                                        std::vector<std::uint64_t>{kPairs}, source_.channels());
  }
  void run() {
    evaluator_->run(*pixel_.integral, stream_key(1, "independent", "run"), 0, 0);
    benchmark::DoNotOptimize(evaluator_->estimates(0, 0, 0));
  }

 private:
  DirectLighting source_;
  PixelIntegral pixel_;
  std::unique_ptr<PassEvaluator<float>> evaluator_;
};

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// `with` and `without` do the same pairs of samples.
void compare(benchmark::State& state, const std::function<void()>& with, const std::function<void()>& without,
             double claim) {
  with(), without();
  double time_with = 0, time_without = 0;
  for (auto _ : state) {
    const double a = seconds(with), b = seconds(without);
    time_with += a;
    time_without += b;
    state.SetIterationTime(a + b);
  }
  const double pairs = static_cast<double>(state.iterations()) * static_cast<double>(kPairs) * kLanes;
  state.counters["with"] = pairs / time_with;
  state.counters["without"] = pairs / time_without;
  state.counters["ratio"] = time_without / time_with;
  state.counters["claimed"] = claim;
}

const Rgb kWhite = Rgb::Ones();
const Vec3 kAbove(0, 0.5, 2);

void one_channel(benchmark::State& state) {
  Pass grey(floor_under({lamp(kAbove, 0.5, kWhite)}), {"balance"});
  Pass coloured(floor_under({lamp(kAbove, 0.5, Rgb(1, 0.9, 0.8))}), {"balance"});
  compare(
      state, [&] { grey.run(); }, [&] { coloured.run(); }, kWorthOneChannel);
}

void no_light_choice(benchmark::State& state) {
  Pass one(floor_under({lamp(kAbove, 0.5, kWhite)}), {"balance"});
  // The other is below the floor, so that nothing but the choice is added.
  Pass two(floor_under({lamp(kAbove, 0.5, kWhite), lamp({0, 0, -3}, 0.5, kWhite)}), {"balance"});
  compare(
      state, [&] { one.run(); }, [&] { two.run(); }, kWorthNoLightChoice);
}

void no_shadow_ray(benchmark::State& state) {
  Pass clear(floor_under({lamp(kAbove, 0.5, kWhite)}), {"balance"});
  // Between the point and the light, and too small to hide much of it.
  const Primitive between = flat({0.1, 0.3, 1}, 0.01 * Vec3::UnitX(), 0.01 * Vec3::UnitY(), Rgb::Zero());
  Pass shaded(floor_under({lamp(kAbove, 0.5, kWhite), between}), {"balance"});
  compare(
      state, [&] { clear.run(); }, [&] { shaded.run(); }, kWorthNoShadowRay);
}

/// The same samples with the densities of two techniques, and of all five.
void no_unused_techniques(benchmark::State& state) {
  const DirectLighting source(floor_under({lamp(kAbove, 0.5, kWhite)}), 1, 1);
  const PixelIntegral pixel = source.pixel(0);
  const auto sampler = SamplerCatalogue::built_in().make("independent");
  constexpr int kBlock = 32;
  const Layout layout = {{2, 2}};
  sampler->prepare({kPairs, &layout, stream_key(1, "independent", "run"), 0, 0, false});
  PointBlock points;
  points.reset(4, kBlock, false);
  TermBlock<float> terms;
  const std::vector<int> two = {0, 1}, five = {0, 1, 2, 3, 4};
  const auto draw = [&](const std::vector<int>& set) {
    for (std::uint64_t begin = 0; begin < kPairs; begin += kBlock) {
      sampler->fill(begin, points);
      terms.reset(2, 1, static_cast<int>(set.size()), kBlock);
      pixel.integral->sample({0, 0, 0, set}, points, terms);
      pixel.integral->sample({1, 2, 1, set}, points, terms);
      benchmark::DoNotOptimize(terms.data());
    }
  };
  compare(
      state, [&] { draw(two); }, [&] { draw(five); }, kWorthNoUnusedTechniques);
}

void shared_pass(benchmark::State& state) {
  const Scene scene = floor_under({lamp(kAbove, 0.5, kWhite)});
  Pass together(scene, {"average", "balance", "power"}), average(scene, {"average"}), balance(scene, {"balance"}),
      power(scene, {"power"});
  compare(
      state, [&] { together.run(); },
      [&] {
        average.run();
        balance.run();
        power.run();
      },
      kWorthSharedPass);
}

BENCHMARK(one_channel)->UseManualTime();
BENCHMARK(no_light_choice)->UseManualTime();
BENCHMARK(no_shadow_ray)->UseManualTime();
BENCHMARK(no_unused_techniques)->UseManualTime();
BENCHMARK(shared_pass)->UseManualTime();

}  // namespace
}  // namespace halfslope

BENCHMARK_MAIN();
