// What spectra, pair correlations and distances cost on one core.
//
// Floors, for 3.5 GHz and the baseline's two binary64 lanes. Spectrum of 4096 points at 512² frequencies: a product of
// 514 × 4096 and 4096 × 514 numbers is 2.2 Gflop, at 8 flops a cycle 0.08 s (each frequency by itself would be 4096
// sines and cosines: 1.1 billion of both, half of them by symmetry, about 15 s). Pair correlation of 16384 points with
// bins up to 1/2: all 1.3e8 pairs, each half a packet's square root (about 5 cycles) and a count (1 or 2): 0.25 s. With
// bins up to the usual ten mean distances 2 % of that.
//
// The rows slope/… time a measure at several N in one run and fit log seconds against log N; `order` is what the header
// promises (N log N has the slope 1.11 from 2^10 to 2^17, and what leaves the caches adds some). They fail where the
// slope is more than 0.35 above it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analysis/pair_correlation.h"
#include "analysis/spacing.h"
#include "analysis/spectrum.h"

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

/// Of the processor, not of the clock on the wall: the fits are to hold on a machine that has other work too.
template <class Body>
double seconds(Body body) {
  const std::clock_t start = std::clock();
  body();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Each frequency by itself; `by_itself` says how many times as long all would take that way. Timed where both agree.
void spectrum(benchmark::State& state) {
  const Points points = random_points(static_cast<std::size_t>(state.range(0)));
  const int most = static_cast<int>(state.range(1)) / 2;
  const PowerSpectrum spectrum(points.view(), most);
  constexpr int kSample = 32;
  bool agree = true;
  const double sample_seconds = seconds([&] {
    for (int k = 1; k <= kSample; ++k) {
      std::complex<double> sum = 0;
      for (std::size_t j = 0; j < points.x.size(); ++j)
        sum += std::polar(1.0, -2 * std::numbers::pi * (k * points.x[j] - (most - k) * points.y[j]));
      const double power = std::norm(sum) / static_cast<double>(points.x.size());
      agree = agree && std::abs(spectrum.at(k, k - most) - power) <= 1e-9;
    }
  });
  if (!agree) return state.SkipWithError("the two do not agree");
  double elapsed = 0;
  for (auto _ : state)
    elapsed += seconds([&] { benchmark::DoNotOptimize(PowerSpectrum(points.view(), most).at(most, most)); });
  const double all = sample_seconds / kSample * static_cast<double>(state.range(1) * state.range(1)) / 2;
  state.counters["by_itself"] = all / (elapsed / static_cast<double>(state.iterations()));
  state.counters["Gflop/s"] = benchmark::Counter(8e-9 * std::pow(most + 1, 2) * static_cast<double>(state.range(0)),
                                                 benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(spectrum)->Args({4096, 512})->Args({16384, 64})->Args({4096, 1024})->Unit(benchmark::kMillisecond);

void pcf(benchmark::State& state) {
  const Points points = random_points(static_cast<std::size_t>(state.range(0)));
  const DistanceBins bins = {200, state.range(1) == 0 ? usual_most_distance(points.x.size(), 2) : 0.5};
  for (auto _ : state) benchmark::DoNotOptimize(pair_correlation(points.view(), bins));
  state.counters["max"] = bins.most;
}
BENCHMARK(pcf)->Args({16384, 0})->Args({16384, 1})->Unit(benchmark::kMillisecond);

constexpr double kNLogN = 1.11;

using Function = double (*)(const PointSet&);

/// Fits the cost of a measure from 2^`first` to 2^`last` points.
void slope(benchmark::State& state, Function measure, int first, int last, double order) {
  double fitted = 0, largest = 0;
  for (auto _ : state) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
    for (int m = first; m <= last; ++m) {
      const Points points = random_points(std::size_t{1} << m);
      std::vector<double> times;
      for (int trial = 0; trial < 3; ++trial)
        times.push_back(seconds([&] { benchmark::DoNotOptimize(measure(points.view())); }));
      std::sort(times.begin(), times.end());
      largest = times[1];
      const double y = std::log2(largest);
      sx += m, sy += y, sxx += m * m, sxy += m * y, ++n;
    }
    fitted = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  }
  state.counters["slope"] = fitted;
  state.counters["order"] = order;
  state.counters["seconds_at_largest"] = largest;
  if (fitted > order + 0.35) state.SkipWithError("costs more than its order");
}

double usual_pcf(const PointSet& points) {
  return pair_correlation(points, {200, usual_most_distance(points.count(), points.dims())}).back();
}
double pcf_to_half(const PointSet& points) { return pair_correlation(points, {200, 0.5}).back(); }
double spectrum_64(const PointSet& points) { return PowerSpectrum(points, 32).at(1, 1); }

}  // namespace
}  // namespace halfslope

int main(int argc, char** argv) {
  using namespace halfslope;
  const auto fit = [](const char* name, Function measure, int last, double order) {
    benchmark::RegisterBenchmark((std::string("slope/") + name).c_str(), slope, measure, 10, last, order)
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  };
  fit("min-distance", min_distance, 17, kNLogN);
  fit("min-distance-toroidal", min_distance_toroidal, 17, kNLogN);
  fit("mean-nn-distance", mean_nn_distance, 17, kNLogN);
  fit("mean-nn-distance-toroidal", mean_nn_distance_toroidal, 17, kNLogN);
  fit("relative-radius", relative_radius, 17, kNLogN);
  fit("dispersion", dispersion, 17, kNLogN);
  fit("dispersion-toroidal", dispersion_toroidal, 17, kNLogN);
  fit("pcf", usual_pcf, 17, kNLogN);
  fit("pcf:max=0.5", pcf_to_half, 14, 2);
  fit("spectrum", spectrum_64, 17, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
