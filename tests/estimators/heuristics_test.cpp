// Heuristics as templates over every number type of this build, and through the fold of every instruction set.
#include "estimators/heuristics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/point_block.h"
#include "tests/estimators/isa_scope.h"

namespace halfslope {
namespace {

constexpr Heuristic kAverage = {HeuristicKind::kAverage, 0}, kBalance = {HeuristicKind::kBalance, 0};
constexpr double kBetas[] = {0.5, 1, 2, 3, 4, 7.3, 1000};

Heuristic power(double beta) { return {HeuristicKind::kPower, beta}; }

std::vector<Heuristic> every_heuristic() {
  std::vector<Heuristic> all = {kAverage, kBalance};
  for (const double beta : kBetas) all.push_back(power(beta));
  return all;
}

std::string name(const Heuristic& h) {
  if (h.kind != HeuristicKind::kPower) return h.kind == HeuristicKind::kAverage ? "average" : "balance";
  return "power:" + std::to_string(h.parameter);
}

/// [technique][point]; the number of points is a multiple of kLanes.
template <class T>
using Table = std::vector<std::vector<T>>;

/// A way to compute weights: every technique's weight at every point, from every technique's density there.
template <class T>
struct Way {
  std::string name;
  std::function<Table<T>(const Heuristic&, const Table<T>& densities)> weights;
};

template <class F>
Way<scalar_t<F>> by_template(const std::string& type) {
  using T = scalar_t<F>;
  return {type, [](const Heuristic& heuristic, const Table<T>& densities) {
            const int n = static_cast<int>(densities.size());
            Table<T> weights = densities;
            alignas(64) T lanes[64];
            for (std::size_t p = 0; p < densities[0].size(); p += static_cast<std::size_t>(kWidth<F>)) {
              F ratios[8];
              for (std::size_t k = 0; k < densities.size(); ++k) {
                for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) lanes[l] = densities[k][p + l];
                ratios[k] = load<F>(lanes);
              }
              to_ratios(ratios, n);
              for (std::size_t i = 0; i < densities.size(); ++i) {
                store(lanes, weight(heuristic, ratios, n, static_cast<int>(i)));
                for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) weights[i][p + l] = lanes[l];
              }
            }
            return weights;
          }};
}

/// What `fold` makes of a round: `values` and `counts` by technique, slots[q] the technique of slot q, one channel.
template <class T>
std::vector<T> folded(Isa isa, const std::vector<Heuristic>& heuristics, const Table<T>& densities,
                      const std::vector<int>& slots, const Table<T>& values, const std::vector<T>& counts) {
  const std::size_t stride = densities[0].size(), rows = 1 + densities.size();
  AlignedBuffer<T> terms(slots.size() * rows * stride), out(heuristics.size() * stride);
  for (std::size_t q = 0; q < slots.size(); ++q) {
    for (std::size_t p = 0; p < stride; ++p) {
      terms[q * rows * stride + p] = values[q][p];
      for (std::size_t k = 0; k < densities.size(); ++k) terms[(q * rows + 1 + k) * stride + p] = densities[k][p];
    }
  }
  std::vector<T*> outputs;
  for (std::size_t h = 0; h < heuristics.size(); ++h) outputs.push_back(out.data() + h * stride);
  const FoldCall<T> call = {terms.data(),
                            stride,
                            stride,
                            static_cast<int>(slots.size()),
                            1,
                            static_cast<int>(densities.size()),
                            slots.data(),
                            counts.data(),
                            heuristics.data(),
                            static_cast<int>(heuristics.size()),
                            outputs.data()};
  const IsaScope scope(isa);
  const auto& table = kernels<EstimatorKernels>();
  if constexpr (std::is_same_v<T, float>) {
    table.fold_f32(call);
  } else {
    table.fold_f64(call);
  }
  return {out.data(), out.data() + heuristics.size() * stride};
}

template <class T>
Way<T> by_fold(Isa isa) {
  return {"fold " + to_string(isa), [isa](const Heuristic& heuristic, const Table<T>& densities) {
            const std::size_t n = densities.size(), stride = densities[0].size();
            std::vector<int> slots;
            for (std::size_t q = 0; q < n; ++q) slots.push_back(static_cast<int>(q));
            Table<T> weights;
            for (std::size_t i = 0; i < n; ++i) {  // a value of 1 in one slot alone: its weight comes out
              Table<T> values(n, std::vector<T>(stride, T(0)));
              values[i].assign(stride, T(1));
              weights.push_back(folded<T>(isa, {heuristic}, densities, slots, values, std::vector<T>(n, T(1))));
            }
            return weights;
          }};
}

template <class T>
std::vector<Way<T>> every_way() {
  std::vector<Way<T>> ways = {by_template<T>("scalar"), by_template<NativePacket<T>>("packet")};
  for (const Isa isa : supported_isas()) ways.push_back(by_fold<T>(isa));
  return ways;
}

template <class T>
class Weights : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(Weights, Numbers);

/// Densities log-uniform over 1e-30 … 1e30, one in five of them 0.
template <class T>
Table<T> random_densities(std::size_t techniques, std::size_t points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Table<T> densities(techniques, std::vector<T>(points));
  for (std::size_t p = 0; p < points; ++p) {
    for (auto& row : densities) {
      const double exponent = 60 * uniform() - 30;
      row[p] = uniform() < 0.2 ? T(0) : static_cast<T>(std::pow(10, exponent));
    }
  }
  return densities;
}

/// The weight by the definition, in logarithms: no range to leave.
template <class T>
long double exact_weight(const Heuristic& heuristic, const Table<T>& densities, std::size_t i, std::size_t p) {
  const auto n = static_cast<long double>(densities.size());
  if (heuristic.kind == HeuristicKind::kAverage) return 1 / n;
  const long double beta = heuristic.kind == HeuristicKind::kBalance ? 1 : heuristic.parameter;
  bool none = true;
  for (const auto& row : densities) none = none && row[p] == T(0);
  if (none) return 1 / n;
  if (densities[i][p] == T(0)) return 0;
  long double sum = 0;
  const long double own = std::log(static_cast<long double>(densities[i][p]));
  for (const auto& row : densities) {
    if (row[p] != T(0)) sum += std::exp(beta * (std::log(static_cast<long double>(row[p])) - own));
  }
  return 1 / sum;
}

TYPED_TEST(Weights, SumToOneAndFollowTheDefinition) {
  using T = TypeParam;
  const double epsilon = std::numeric_limits<T>::epsilon();
  for (const Way<T>& way : every_way<T>()) {
    for (std::size_t n = 1; n <= 5; ++n) {
      const Table<T> densities = random_densities<T>(n, 2048, 100 + n);
      for (const Heuristic& heuristic : every_heuristic()) {
        if (n == 1 && way.name.starts_with("fold")) continue;  // a lone technique is a single, which has no densities
        const Table<T> weights = way.weights(heuristic, densities);
        // A ratio is off by half an ulp, its power by β times as much, its logarithm times β by as much again.
        const double tolerance = epsilon * (8 + 2 * heuristic.parameter);
        for (std::size_t p = 0; p < 2048; ++p) {
          long double sum = 0;
          for (std::size_t i = 0; i < n; ++i) {
            const T w = weights[i][p];
            ASSERT_GE(w, T(0)) << way.name << ' ' << name(heuristic);
            ASSERT_LE(w, T(1)) << way.name << ' ' << name(heuristic);
            ASSERT_NEAR(w, exact_weight(heuristic, densities, i, p), tolerance) << way.name << ' ' << name(heuristic);
            sum += w;
          }
          ASSERT_NEAR(sum, 1, 4 * epsilon) << way.name << ' ' << name(heuristic) << " of " << n;
        }
      }
    }
  }
}

TYPED_TEST(Weights, AllZeroAndTiesAreShared) {
  using T = TypeParam;
  const double ulp = std::numeric_limits<T>::epsilon();
  for (const Way<T>& way : every_way<T>()) {
    for (const Heuristic& heuristic : every_heuristic()) {
      for (std::size_t n = 2; n <= 5; ++n) {
        for (const T density : {T(0), T(1e-30), T(0.3), T(1e30), std::numeric_limits<T>::max()}) {
          const Table<T> weights = way.weights(heuristic, Table<T>(n, std::vector<T>(kLanes, density)));
          for (const auto& row : weights) {
            for (const T w : row) ASSERT_NEAR(w, 1.0 / static_cast<double>(n), ulp) << way.name << name(heuristic);
          }
        }
      }
      if (heuristic.kind == HeuristicKind::kAverage) continue;
      Table<T> two_of_three(3, std::vector<T>(kLanes, T(7)));
      two_of_three[1].assign(kLanes, T(0));
      const Table<T> weights = way.weights(heuristic, two_of_three);
      EXPECT_EQ(weights[0][0], T(0.5));
      EXPECT_EQ(weights[1][0], T(0));
      EXPECT_EQ(weights[2][0], T(0.5));
    }
  }
}

TYPED_TEST(Weights, GrowWithTheirDensity) {
  using T = TypeParam;
  constexpr std::size_t kPoints = 4096;
  Table<T> densities(3, std::vector<T>(kPoints));
  for (std::size_t p = 0; p < kPoints; ++p) {
    densities[0][p] = p == 0 ? T(0) : static_cast<T>(std::pow(10, -30 + 60 * static_cast<double>(p) / kPoints));
    densities[1][p] = T(0.1);
    densities[2][p] = T(30);
  }
  const T ulps = 1 + 8 * std::numeric_limits<T>::epsilon();
  for (const Way<T>& way : every_way<T>()) {
    for (const Heuristic& heuristic : every_heuristic()) {
      const Table<T> weights = way.weights(heuristic, densities);
      for (std::size_t p = 1; p < kPoints; ++p) {
        ASSERT_GE(weights[0][p] * ulps, weights[0][p - 1]) << way.name << name(heuristic) << densities[0][p];
        ASSERT_LE(weights[1][p], weights[1][p - 1] * ulps) << way.name << name(heuristic) << densities[0][p];
      }
    }
  }
}

TYPED_TEST(Weights, ScaleByPowersOfTwoChangesNoBit) {
  using T = TypeParam;
  const Table<T> densities = random_densities<T>(3, 1024, 9);
  for (const Way<T>& way : every_way<T>()) {
    for (const Heuristic& heuristic : every_heuristic()) {
      const Table<T> weights = way.weights(heuristic, densities);
      for (const int exponent : {-20, -1, 3, 24}) {
        Table<T> scaled = densities;
        for (auto& row : scaled) {
          for (T& density : row) density = std::ldexp(density, exponent);
        }
        ASSERT_EQ(way.weights(heuristic, scaled), weights) << way.name << ' ' << name(heuristic) << ' ' << exponent;
      }
    }
  }
}

TYPED_TEST(Weights, NotANumberIsNeverSwallowed) {
  using T = TypeParam;
  for (const T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity()}) {
    for (const Way<T>& way : every_way<T>()) {
      for (const Heuristic& heuristic : every_heuristic()) {
        if (heuristic.kind == HeuristicKind::kAverage) continue;  // asks no density
        for (std::size_t k = 0; k < 3; ++k) {
          Table<T> densities(3, std::vector<T>(kLanes, T(2)));
          densities[k].assign(kLanes, bad);
          const Table<T> weights = way.weights(heuristic, densities);
          T sum = 0;
          for (const auto& row : weights) sum += row[0];
          ASSERT_TRUE(std::isnan(sum)) << way.name << ' ' << name(heuristic) << ' ' << bad << " of technique " << k;
        }
      }
    }
  }
}

TYPED_TEST(Weights, PowerZeroIsTheAverage) {
  using T = TypeParam;
  const Table<T> densities = random_densities<T>(4, 256, 5);
  for (const Way<T>& way : every_way<T>()) {
    EXPECT_EQ(way.weights(power(0), densities), way.weights(kAverage, densities)) << way.name;
  }
}

// f²/(f² + g²): exact value and accepted relative errors in binary64 and binary32 (negative: the inputs are out of that
// type's range, or the answer is one that it rounds to a subnormal).
struct PowerCase {
  double f, g;
  long double exact;
  double f64, f32;
};
constexpr PowerCase kPowerCases[] = {
    {0x1.5af1d8p+66, 1, 1.0L, 8.881784197001252e-16, 4.76837158203125e-07},
    {1, 0x1p-12, 0.999999940395358777322842042277L, 8.881784197001252e-16, 9.536e-07},
    {0x1.99999ap-4, 0x1.388p+13, 1.00000002970232260378945281516e-10L, 8.881784197001252e-16, 1.3712e-06},
    {0x1.82db34p-77, 0x1.82db34p-77, 0.5L, 8.881784197001252e-16, 4.76837158203125e-07},
    {0x1.a0556ap+64, 0x1.158e46p+63, 0.900000006597069465195330799244L, 8.881784197001252e-16, 5.184e-07},
    {0x1.3529ba7d19eafp-565, 0x1.cfbe97bba6e07p-564, 0.09999999999999998896826233626L, 8.881784197001252e-16, -1},
    {1, 0x1.5af1d8p+66, 9.99999959918246519470261801232e-41L, 8.881784197001252e-16, -1},
};

TYPED_TEST(Weights, PowerHoldsWhereSquaresOverflow) {
  using T = TypeParam;
  for (const Way<T>& way : every_way<T>()) {
    for (const PowerCase& c : kPowerCases) {
      const double accepted = std::is_same_v<T, float> ? c.f32 : c.f64;
      const Table<T> densities = {std::vector<T>(kLanes, static_cast<T>(c.f)),
                                  std::vector<T>(kLanes, static_cast<T>(c.g))};
      const Table<T> weights = way.weights(power(2), densities);
      if (accepted >= 0) {
        EXPECT_NEAR(weights[0][0] / c.exact, 1, accepted) << way.name << ' ' << c.f << ' ' << c.g;
      } else if (c.f >= std::numeric_limits<T>::min()) {  // a subnormal weight: to its last bit
        EXPECT_NEAR(weights[0][0], c.exact, std::numeric_limits<T>::denorm_min()) << way.name;
      }
    }
  }
}

TYPED_TEST(Weights, FoldIsTheMultiSampleEstimator) {
  // F = Σ_i (1/c_i) Σ_j w_i f/p_i with w from c_k p_k, three samples of technique 0 and two of technique 1 (Veach 1997,
  // eq. 9.4); every slot has its own densities, so slots are folded one by one and added here.
  using T = TypeParam;
  constexpr std::size_t kPoints = 64;
  const std::vector<int> slots = {0, 0, 0, 1, 1};
  const std::vector<T> counts = {T(3), T(2)};
  const Table<T> densities = random_densities<T>(2, kPoints, 77);
  Table<T> values(slots.size(), std::vector<T>(kPoints));
  std::mt19937_64 random(3);
  for (auto& row : values) {
    for (T& v : row) v = static_cast<T>(static_cast<double>(random() >> 11) * 0x1p-53);
  }
  Table<T> scaled = densities;
  for (std::size_t k = 0; k < 2; ++k) {
    for (T& density : scaled[k]) density *= counts[k];
  }
  std::vector<Heuristic> heuristics = every_heuristic();
  while (heuristics.size() < static_cast<std::size_t>(kMostHeuristics)) heuristics.push_back(power(2));
  for (const Isa isa : supported_isas()) {
    const std::vector<T> found = folded<T>(isa, heuristics, densities, slots, values, counts);
    for (std::size_t h = 0; h < heuristics.size(); ++h) {
      const double tolerance = std::numeric_limits<T>::epsilon() * (20 + 4 * heuristics[h].parameter);
      for (std::size_t p = 0; p < kPoints; ++p) {
        long double sum = 0;
        for (std::size_t q = 0; q < slots.size(); ++q) {
          const auto i = static_cast<std::size_t>(slots[q]);
          sum += exact_weight(heuristics[h], scaled, i, p) * values[q][p] / static_cast<long double>(counts[i]);
        }
        ASSERT_NEAR(found[h * kPoints + p], sum, tolerance) << to_string(isa) << ' ' << name(heuristics[h]);
      }
    }
  }
}

}  // namespace
}  // namespace halfslope
