// The quadratic discrepancies. `l2-star/against-plain-loop`: in the counter `plain_loop`, how many times as long
// Warnock's formula takes as a double loop over all pairs in binary64. Floor: that loop does 4 operations a pair of
// which one addition waits for the last, so about 4 cycles a pair; the integers in O(N log N) touch 32 bytes for each
// of log₂ N bits and point, and 6 products of 128 bits a point: about 150 cycles a point at N = 2¹⁴, 400 times less.
// Then each measure at growing N with the slope of log time against log N: about 1 (and a logarithm) in the plane, 2
// above; of the t-value of a plane net, which takes N (log N)², 1.19.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "analysis/quadratic_discrepancy.h"
#include "analysis/t_value.h"

namespace halfslope {
namespace {

using Columns = std::vector<std::vector<double>>;

Columns random_points(std::size_t count, std::size_t dims) {
  std::mt19937_64 random(count);
  Columns columns(dims, std::vector<double>(count));
  for (auto& column : columns)
    for (double& x : column) x = static_cast<double>(random() >> 11) * 0x1p-53;
  return columns;
}

PointSet view(const Columns& columns) {
  return PointSet(std::vector<std::span<const double>>(columns.begin(), columns.end()));
}

double plain_loop(const Columns& points) {
  const auto &x = points[0], &y = points[1];
  const auto n = static_cast<double>(x.size());
  double singles = 0, pairs = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    singles += (1 - x[i] * x[i]) * (1 - y[i] * y[i]);
    for (std::size_t j = 0; j < x.size(); ++j) pairs += (1 - std::max(x[i], x[j])) * (1 - std::max(y[i], y[j]));
  }
  return std::sqrt(1.0 / 9 - singles / (2 * n) + pairs / (n * n));
}

/// Of this thread on a processor: others may be about.
template <class Body>
double seconds(Body body) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
  };
  const double start = now();
  body();
  return now() - start;
}

void l2_star_against_plain_loop(benchmark::State& state) {
  const Columns points = random_points(static_cast<std::size_t>(state.range(0)), 2);
  double plain = 0;
  double plain_seconds = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 3; ++trial)
    plain_seconds = std::min(plain_seconds, seconds([&] { plain = plain_loop(points); }));
  if (!(std::abs(l2_star_discrepancy(view(points)) / plain - 1) <= 1e-5)) {
    state.SkipWithError("the two do not agree");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(l2_star_discrepancy(view(points)));
  state.SetItemsProcessed(state.iterations() * state.range(0));
  // Google Benchmark divides what is marked so by the run's seconds a call.
  state.counters["plain_loop"] = benchmark::Counter(plain_seconds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(l2_star_against_plain_loop)
    ->Name("l2-star/against-plain-loop")
    ->Arg(1024)
    ->Arg(16384)
    ->Unit(benchmark::kMicrosecond);

/// Times at the Ns of the arguments' range, and their slope.
template <double (*kMeasure)(const PointSet&), Columns (*kPoints)(std::size_t, std::size_t) = random_points>
void cost(benchmark::State& state) {
  const auto dims = static_cast<std::size_t>(state.range(0));
  const int least = static_cast<int>(state.range(1)), most = static_cast<int>(state.range(2));
  std::vector<double> best(static_cast<std::size_t>(most - least + 1), std::numeric_limits<double>::infinity());
  for (auto _ : state) {
    for (int m = least; m <= most; ++m) {
      const Columns points = kPoints(std::size_t{1} << m, dims);
      double& fastest = best[static_cast<std::size_t>(m - least)];
      fastest = std::min(fastest, seconds([&] { benchmark::DoNotOptimize(kMeasure(view(points))); }));
    }
  }
  double mean_m = (least + most) / 2.0, products = 0, squares = 0;
  for (int m = least; m <= most; ++m) {
    products += (m - mean_m) * std::log2(best[static_cast<std::size_t>(m - least)]);
    squares += (m - mean_m) * (m - mean_m);
  }
  state.counters["slope"] = products / squares;
  state.counters["ns_per_point"] = best.back() * 1e9 / std::ldexp(1.0, most);
}

void costs(benchmark::internal::Benchmark* b) {
  b->Args({1, 12, 18})->Args({2, 12, 18})->Args({4, 11, 14})->Iterations(3)->Unit(benchmark::kMillisecond);
}
BENCHMARK_TEMPLATE(cost, l2_star_discrepancy)->Name("cost/l2-star")->Apply(costs);
BENCHMARK_TEMPLATE(cost, centered_l2_discrepancy)->Name("cost/centered-l2")->Apply(costs);
BENCHMARK_TEMPLATE(cost, wraparound_l2_discrepancy)->Name("cost/wraparound-l2")->Apply(costs);
BENCHMARK_TEMPLATE(cost, mixture_l2_discrepancy)->Name("cost/mixture-l2")->Apply(costs);
BENCHMARK_TEMPLATE(cost, symmetric_l2_discrepancy)->Name("cost/symmetric-l2")->Apply(costs);
BENCHMARK_TEMPLATE(cost, extreme_l2_discrepancy)->Name("cost/extreme-l2")->Apply(costs);
BENCHMARK_TEMPLATE(cost, periodic_l2_discrepancy)->Name("cost/periodic-l2")->Apply(costs);
BENCHMARK_TEMPLATE(cost, diaphony)->Name("cost/diaphony")->Apply(costs);

/// Hammersley's net, of which all shapes of intervals must be counted: random points are done with the first.
Columns net(std::size_t count, std::size_t /*dims*/) {
  Columns columns(2, std::vector<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    columns[0][i] = static_cast<double>(i) / static_cast<double>(count);
    double digit = 0.5;
    for (std::size_t rest = i; rest > 0; rest /= 2, digit /= 2) columns[1][i] += static_cast<double>(rest % 2) * digit;
  }
  return columns;
}
double counted_t_value(const PointSet& points) { return t_value(points, 2); }
BENCHMARK_TEMPLATE(cost, counted_t_value, net)
    ->Name("cost/t-value")
    ->Args({2, 12, 18})
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halfslope

BENCHMARK_MAIN();
