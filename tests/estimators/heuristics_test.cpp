// Heuristics as templates over every number type of this build, and through the fold of every instruction set.
#include "estimators/heuristics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/estimators/heuristic_ways.h"

namespace halfslope {
namespace {

template <class T>
class Weights : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(Weights, Numbers);

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
          double sum = 0;
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
          const bool first_takes_all = heuristic.kind == HeuristicKind::kMaximum && density > 0;
          for (std::size_t i = 0; i < n; ++i) {
            const double share = first_takes_all ? (i == 0 ? 1 : 0) : 1.0 / static_cast<double>(n);
            for (const T w : weights[i]) ASSERT_NEAR(w, share, ulp) << way.name << name(heuristic);
          }
        }
      }
      if (heuristic.kind == HeuristicKind::kAverage) continue;
      Table<T> two_of_three(3, std::vector<T>(kLanes, T(7)));
      two_of_three[1].assign(kLanes, T(0));
      const Table<T> weights = way.weights(heuristic, two_of_three);
      const bool maximum = heuristic.kind == HeuristicKind::kMaximum;
      EXPECT_EQ(weights[0][0], maximum ? T(1) : T(0.5));
      EXPECT_EQ(weights[1][0], T(0));
      EXPECT_EQ(weights[2][0], maximum ? T(0) : T(0.5));
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
        for (std::size_t n = 2; n <= 5; ++n) {
          for (std::size_t k = 0; k < n; ++k) {
            Table<T> densities(n, std::vector<T>(kLanes, T(2)));
            densities[k].assign(kLanes, bad);
            const Table<T> weights = way.weights(heuristic, densities);
            T sum = 0;
            for (const auto& row : weights) sum += row[0];
            // An infinite density may have its limit, all of the weight.
            const bool limit = std::isinf(bad) && weights[k][0] == T(1) && sum == T(1);
            ASSERT_TRUE(std::isnan(sum) || limit)
                << way.name << ' ' << name(heuristic) << ' ' << bad << " of technique " << k << " of " << n;
          }
        }
      }
    }
  }
}

TYPED_TEST(Weights, InfiniteDensitiesShareWhatThereIs) {
  using T = TypeParam;
  for (const Way<T>& way : every_way<T>()) {
    for (const Heuristic& heuristic : every_heuristic()) {
      if (heuristic.kind == HeuristicKind::kAverage) continue;
      for (std::size_t n = 3; n <= 5; ++n) {
        Table<T> densities(n, std::vector<T>(kLanes, std::numeric_limits<T>::max()));
        densities[1].assign(kLanes, std::numeric_limits<T>::infinity());
        densities[n - 1] = densities[1];
        const Table<T> weights = way.weights(heuristic, densities);
        const bool maximum = heuristic.kind == HeuristicKind::kMaximum;
        for (std::size_t i = 0; i < n; ++i) {
          const bool infinite = i == 1 || i == n - 1;
          const T share = maximum ? T(i == 1 ? 1 : 0) : T(infinite ? 0.5 : 0);
          ASSERT_EQ(weights[i][0], share) << way.name << ' ' << name(heuristic) << ' ' << i << " of " << n;
        }
      }
    }
  }
}

TYPED_TEST(Weights, CutoffGoesFromBalanceToMaximum) {
  using T = TypeParam;
  for (std::size_t n = 2; n <= 5; ++n) {
    Table<T> densities = random_densities<T>(n, 512, 40 + n);
    for (std::size_t p = 0; p < 512; ++p) densities[n - 1][p] += T(1);  // none all zero
    for (const Way<T>& way : every_way<T>()) {
      EXPECT_EQ(way.weights(cutoff(0), densities), way.weights(kBalance, densities)) << way.name;
      EXPECT_EQ(way.weights(cutoff(1), densities), way.weights(kMaximum, densities)) << way.name;  // no two are alike
    }
  }
}

TYPED_TEST(Weights, CutoffDropsWhatIsBelowItsThresholdOnly) {
  using T = TypeParam;
  const Table<T> densities = {std::vector<T>(kLanes, T(4)), std::vector<T>(kLanes, T(4.01)),
                              std::vector<T>(kLanes, T(8)), std::vector<T>(kLanes, T(3.99))};
  for (const Way<T>& way : every_way<T>()) {
    const Table<T> weights = way.weights(cutoff(0.5), densities);
    EXPECT_NEAR(weights[0][0], 4 / 16.01, 1e-6) << way.name;
    EXPECT_NEAR(weights[1][0], 4.01 / 16.01, 1e-6) << way.name;
    EXPECT_NEAR(weights[2][0], 8 / 16.01, 1e-6) << way.name;
    EXPECT_EQ(weights[3][0], T(0)) << way.name;
  }
}

TYPED_TEST(Weights, RoundingDecidesNoTie) {
  // The same densities but for a few ulps, which fall differently at each technique's samples: whoever came by them,
  // the weights must be those of the tie, or their expectations do not sum to 1.
  using T = TypeParam;
  const T one_way = T(1) + 8 * std::numeric_limits<T>::epsilon(), other_way = 1 / one_way;
  for (const Way<T>& way : every_way<T>()) {
    for (std::size_t n = 2; n <= 5; ++n) {
      for (const T off : {other_way, one_way}) {
        Table<T> densities(n, std::vector<T>(kLanes, T(3)));
        densities[n - 1].assign(kLanes, T(3) * off);
        const Table<T> maximum = way.weights(kMaximum, densities), all = way.weights(cutoff(1), densities);
        EXPECT_EQ(maximum[0][0], T(1)) << way.name;
        EXPECT_EQ(maximum[n - 1][0], T(0)) << way.name;
        densities[n - 1].assign(kLanes, T(1.5) * off);
        const Table<T> half = way.weights(cutoff(0.5), densities);
        for (std::size_t i = 0; i < n; ++i) {
          const auto count = static_cast<double>(n);
          EXPECT_NEAR(all[i][0], 1 / count, 1e-5) << way.name;
          EXPECT_NEAR(half[i][0], (i == n - 1 ? 0.5 : 1) / (count - 0.5), 1e-5) << way.name;
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
  double exact;
  double f64, f32;
};
constexpr PowerCase kPowerCases[] = {
    {0x1.5af1d8p+66, 1, 1.0, 8.881784197001252e-16, 4.76837158203125e-07},
    {1, 0x1p-12, 0.999999940395358777322842042277, 8.881784197001252e-16, 9.536e-07},
    {0x1.99999ap-4, 0x1.388p+13, 1.00000002970232260378945281516e-10, 8.881784197001252e-16, 1.3712e-06},
    {0x1.82db34p-77, 0x1.82db34p-77, 0.5, 8.881784197001252e-16, 4.76837158203125e-07},
    {0x1.a0556ap+64, 0x1.158e46p+63, 0.900000006597069465195330799244, 8.881784197001252e-16, 5.184e-07},
    {0x1.3529ba7d19eafp-565, 0x1.cfbe97bba6e07p-564, 0.09999999999999998896826233626, 8.881784197001252e-16, -1},
    {1, 0x1.5af1d8p+66, 9.99999959918246519470261801232e-41, 8.881784197001252e-16, -1},
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
  // F = Σ_i (1/c_i) Σ_j w_i f/p_i with w from c_k p_k (Veach 1997, eq. 9.4), with three samples of technique
  // 0 and two of technique 1.
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
  while (heuristics.size() < 20) heuristics.push_back(power(2));
  for (const Isa isa : supported_isas()) {
    const std::vector<T> found = folded<T>(isa, heuristics, densities, slots, values, counts);
    for (std::size_t h = 0; h < heuristics.size(); ++h) {
      const double tolerance = std::numeric_limits<T>::epsilon() * (20 + 4 * heuristics[h].parameter);
      for (std::size_t p = 0; p < kPoints; ++p) {
        double sum = 0;
        for (std::size_t q = 0; q < slots.size(); ++q) {
          const auto i = static_cast<std::size_t>(slots[q]);
          sum += exact_weight(heuristics[h], scaled, i, p) * values[q][p] / counts[i];
        }
        ASSERT_NEAR(found[h * kPoints + p], sum, tolerance) << to_string(isa) << ' ' << name(heuristics[h]);
      }
    }
  }
}

}  // namespace
}  // namespace halfslope
