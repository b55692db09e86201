// The exact star discrepancy against looking at every box, O(N²), in one run: the counter `every_box` of the first is
// how many times as long the other takes. Timed only where both agree. Then L2-star, and sizes where nobody waits for
// every box.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "analysis/discrepancy.h"
#include "analysis/ranks.h"

namespace halfslope {
namespace {

struct Points {
  std::vector<double> x, y;
  PointSet view() const { return PointSet({x, y}); }
};

Points random_points(std::size_t count) {
  std::mt19937_64 random(count);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.x.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
    points.y.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
  }
  return points;
}

/// The best that plain loops do: points in ascending x, counts of all heights raised and compared at each. No two
/// coordinates of the points are equal.
double every_box(const Points& points) {
  const RankedColumn x(points.x), y(points.y);
  const auto n = static_cast<double>(points.x.size());
  std::vector<double> heights = y.values, counts(heights.size() + 1);
  heights.push_back(1);
  double worst = 0;
  const auto look = [&](double width, double sign) {
    double farthest = 0;
    for (std::size_t j = 0; j < heights.size(); ++j)
      farthest = std::max(farthest, sign * (width * n * heights[j] - counts[j]));
    worst = std::max(worst, farthest / n);
  };
  // Open boxes first: at the width of each point, before it is in; `counts` of the points below y_j.
  for (const std::uint32_t point : x.order) {
    look(points.x[point], 1);
    for (std::size_t j = y.rank[point] + 1; j < counts.size(); ++j) ++counts[j];
  }
  look(1, 1);
  std::fill(counts.begin(), counts.end(), 0.0);
  for (const std::uint32_t point : x.order) {
    for (std::size_t j = y.rank[point]; j < counts.size(); ++j) ++counts[j];
    look(points.x[point], -1);
  }
  return worst;
}

template <class Body>
double seconds(Body body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void star_against_every_box(benchmark::State& state) {
  const Points points = random_points(static_cast<std::size_t>(state.range(0)));
  double brute = 0;
  const double brute_seconds = seconds([&] { brute = every_box(points); });
  if (!(std::abs(star_discrepancy(points.view()) - brute) <= 1e-13)) {
    state.SkipWithError("the two do not agree");
    return;
  }
  double exact_seconds = 0;
  for (auto _ : state) exact_seconds += seconds([&] { benchmark::DoNotOptimize(star_discrepancy(points.view())); });
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["every_box"] = brute_seconds / (exact_seconds / static_cast<double>(state.iterations()));
}
BENCHMARK(star_against_every_box)
    ->Name("star/against-every-box")
    ->RangeMultiplier(4)
    ->Range(64, 1 << 16)
    ->Unit(benchmark::kMicrosecond);

template <double (*kMeasure)(const PointSet&)>
void measure(benchmark::State& state) {
  const Points points = random_points(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(kMeasure(points.view()));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK_TEMPLATE(measure, star_discrepancy)->Name("star")->Arg(1 << 18)->Arg(1 << 20)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace halfslope

BENCHMARK_MAIN();
