// The exact star discrepancy against looking at every box, O(N²), in one run: the counter `every_box` of the first is
// how many times as long the other takes. Timed only where both agree. Then sizes where nobody waits for every box.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "analysis/discrepancy.h"
#include "analysis/ranks.h"
#include "analysis/star_bounds.h"

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

double inverse(std::uint64_t base, std::uint64_t index) {
  double value = 0, digit = 1;
  for (; index > 0; index /= base) value += static_cast<double>(index % base) * (digit /= static_cast<double>(base));
  return value;
}

/// Two-dimensional points of three kinds, 2²⁰ of them: less than 6 s on one core each is the floor.
void star_of_a_million(benchmark::State& state, const std::string& kind) {
  constexpr std::size_t kCount = 1 << 20;
  Points points = random_points(kCount);
  for (std::size_t i = 0; i < kCount && kind != "random"; ++i) {
    points.x[i] = kind == "hammersley" ? static_cast<double>(i) / kCount : inverse(3, i);
    points.y[i] = inverse(2, i);
  }
  double star = 0;
  for (auto _ : state) star = star_discrepancy(points.view());
  state.counters["N*star"] = star * kCount;
}
BENCHMARK_CAPTURE(star_of_a_million, hammersley, "hammersley")->Name("star/2^20/hammersley")->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(star_of_a_million, halton, "halton")->Name("star/2^20/halton")->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(star_of_a_million, random, "random")->Name("star/2^20/random")->Unit(benchmark::kSecond);

/// Of the processor: on a busy machine the clock on the wall says little about a slope.
template <class Body>
double processor_seconds(Body body) {
  const std::clock_t start = std::clock();
  body();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Time against N of Halton points, a least-squares line through logarithms: the counter `slope` is that of the time,
/// `promised` what it may be: of N log² N in two dimensions over these N, and of N^(d/2 + 1) in more.
void star_cost(benchmark::State& state) {
  constexpr std::uint64_t kPrimes[] = {2, 3, 5, 7, 11};
  const auto dims = static_cast<std::size_t>(state.range(0));
  const auto from = static_cast<std::size_t>(state.range(1)), to = static_cast<std::size_t>(state.range(2));
  double slope = 0, promised = 0;
  for (auto _ : state) {
    std::vector<double> log_count, log_time, log_promise;
    for (std::size_t count = from; count <= to; count *= 2) {
      std::vector<std::vector<double>> columns(dims);
      for (std::size_t k = 0; k < dims; ++k) {
        for (std::size_t i = 0; i < count; ++i) columns[k].push_back(inverse(kPrimes[k], i));
      }
      const PointSet points(std::vector<std::span<const double>>(columns.begin(), columns.end()));
      double least = std::numeric_limits<double>::infinity();
      for (int trial = 0; trial < 3; ++trial) {
        StarBounds found;
        least = std::min(least, processor_seconds([&] { found = star_bounds(points); }));
        if (!found.exact) state.SkipWithError("not exact");
      }
      const double n = static_cast<double>(count), log_n = std::log(n);
      log_count.push_back(log_n), log_time.push_back(std::log(least));
      log_promise.push_back(dims == 2 ? log_n + 2 * std::log(log_n) : (static_cast<double>(dims) / 2 + 1) * log_n);
    }
    const auto slope_of = [&](const std::vector<double>& y) {
      const auto n = static_cast<double>(y.size());
      const double mean_x = std::accumulate(log_count.begin(), log_count.end(), 0.0) / n;
      const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
      double xy = 0, xx = 0;
      for (std::size_t i = 0; i < y.size(); ++i) {
        xy += (log_count[i] - mean_x) * (y[i] - mean_y), xx += (log_count[i] - mean_x) * (log_count[i] - mean_x);
      }
      return xy / xx;
    };
    slope = slope_of(log_time), promised = slope_of(log_promise);
  }
  state.counters["slope"] = slope, state.counters["promised"] = promised;
}
BENCHMARK(star_cost)
    ->Name("star/cost")
    ->ArgNames({"dims", "from", "to"})
    ->Args({2, 1 << 10, 1 << 16})
    ->Args({3, 256, 4096})
    ->Args({4, 128, 1024})
    ->Args({5, 64, 512})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

/// In many dimensions: time of what is exact, and how far apart the bounds are of what is not.
void star_of_many_dims(benchmark::State& state) {
  const auto dims = static_cast<std::size_t>(state.range(0)), count = static_cast<std::size_t>(state.range(1));
  std::mt19937_64 random(count);
  std::vector<std::vector<double>> columns(dims, std::vector<double>(count));
  for (auto& column : columns) {
    for (double& x : column) x = static_cast<double>(random() >> 11) * 0x1p-53;
  }
  const PointSet points(std::vector<std::span<const double>>(columns.begin(), columns.end()));
  StarBounds found;
  for (auto _ : state) found = star_bounds(points);
  state.counters["lower"] = found.lower, state.counters["upper/lower"] = found.upper / found.lower;
}
BENCHMARK(star_of_many_dims)
    ->Name("star/dims")
    ->ArgNames({"dims", "N"})
    ->ArgsProduct({{3, 4, 6, 8, 10}, {64, 256, 1024, 4096}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halfslope

BENCHMARK_MAIN();
