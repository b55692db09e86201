#include "analysis/star_bounds.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/analysis/critical_grid.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The first `count` Sobol' points of at most 4 dimensions, with the direction numbers of S. Joe and F. Y. Kuo (2008).
Columns joe_kuo(std::uint32_t count, std::size_t dims) {
  struct Polynomial {
    std::uint32_t degree, coefficients;
    std::vector<std::uint32_t> m;
  };
  const std::vector<Polynomial> polynomials = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}};
  Columns columns(dims);
  for (std::size_t k = 0; k < dims; ++k) {
    std::vector<std::uint32_t> v(32);
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
      if (k == 0) {
        v[bit] = 1u << (31 - bit);
        continue;
      }
      const auto& [s, a, m] = polynomials[k - 1];
      if (bit < s) {
        v[bit] = m[bit] << (31 - bit);
        continue;
      }
      v[bit] = v[bit - s] ^ (v[bit - s] >> s);
      for (std::uint32_t j = 1; j < s; ++j) v[bit] ^= (a >> (s - 1 - j) & 1) != 0 ? v[bit - j] : 0;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t x = 0;
      for (std::uint32_t bit = 0; bit < 32; ++bit) x ^= (i >> bit & 1) != 0 ? v[bit] : 0;
      columns[k].push_back(x * 0x1p-32);
    }
  }
  return columns;
}

double exact(const Columns& points) {
  const StarBounds found = star_bounds(view(points));
  EXPECT_TRUE(found.exact);
  EXPECT_EQ(found.lower, found.upper);
  EXPECT_EQ(star_method(found), "exact");
  return found.lower;
}

// Every box looked at, and by the algorithm of Dobkin, Eppstein and Mitchell (jakobbossek/dandy).
TEST(StarBounds, OfHaltonAndSobolPoints) {
  EXPECT_NEAR(exact(halton(0, 10, 3)), 0.3466666666666667, 1e-12);
  EXPECT_NEAR(exact(halton(0, 16, 3)), 0.275, 1e-12);
  EXPECT_NEAR(exact(halton(0, 32, 4)), 0.23146825396825393, 1e-12);
  EXPECT_NEAR(exact(halton(0, 64, 4)), 0.1362500000000001, 1e-12);
  EXPECT_NEAR(exact(joe_kuo(8, 3)), 0.3828125, 1e-12);
  EXPECT_NEAR(exact(joe_kuo(16, 3)), 0.2177734375, 1e-12);
  EXPECT_NEAR(exact(joe_kuo(32, 3)), 0.1298828125, 1e-12);
  EXPECT_NEAR(exact(joe_kuo(32, 4)), 0.1683349609375, 1e-12);
  EXPECT_NEAR(exact(joe_kuo(1024, 2)), 0.004299163818359375, 1e-12);
}

// One point (x, …, x): the closed box up to it, the open one that leaves it out. They are equal where 1 − xᵈ = x.
TEST(StarBounds, OfOnePoint) {
  for (std::size_t dims = 1; dims <= 32; ++dims) {
    const auto d = static_cast<double>(dims);
    for (const double x : {0.0, 0.25, 0.7, 0.9, 1.0}) {
      EXPECT_NEAR(exact(Columns(dims, {x})), std::max(x, 1 - std::pow(x, d)), 1e-14) << dims << ' ' << x;
    }
  }
  EXPECT_NEAR(exact(Columns(3, {0.6823278038280193})), 0.6823278038280193, 1e-14);
  EXPECT_NEAR(exact(Columns(4, {0.7244919590005157})), 0.7244919590005157, 1e-12);
  EXPECT_NEAR(exact(Columns(5, {0.7548776662466927})), 0.7548776662466927, 1e-12);
}

// Centred grid of kᵈ points: the open box that leaves out all of the last layer in each dimension.
TEST(StarBounds, OfGrids) {
  for (const auto& [k, dims] : {std::pair(4, 3), {3, 4}, {2, 5}, {2, 7}}) {
    Columns points(static_cast<std::size_t>(dims));
    for (int i = 0; i < static_cast<int>(std::lround(std::pow(k, dims))); ++i) {
      int rest = i;
      for (auto& column : points) column.push_back((rest % k + 0.5) / k), rest /= k;
    }
    EXPECT_NEAR(exact(points), 1 - std::pow(1 - 0.5 / k, dims), 1e-14) << k << ' ' << dims;
  }
}

// The data's own list, where it is there.
TEST(StarBounds, OfTheListedPoints) {
  std::ifstream file(HALFSLOPE_SOURCE_DIR "/../shared/data/discrepancy.json");
  if (!file) GTEST_SKIP() << "no ../shared/data/discrepancy.json";
  int checked = 0;
  for (const auto& entry : nlohmann::json::parse(file)) {
    if (entry["measure"] != "star (Linf)") continue;
    const std::string name = entry["name"];
    std::smatch match;
    Columns points;
    if (std::regex_search(name, match, std::regex("^(halton|sobol) d=(\\d+) N=(\\d+)"))) {
      const auto dims = static_cast<std::size_t>(std::stoi(match[2]));
      const auto count = static_cast<std::uint32_t>(std::stoi(match[3]));
      points = match[1] == "halton" ? halton(0, count, dims) : joe_kuo(count, dims);
    } else if (std::regex_search(name, match, std::regex("^Hammersley2D base2 N=2\\^(\\d+)"))) {
      points = hammersley(std::stoi(match[1]));
    } else if (std::regex_search(name, match, std::regex("^1D midpoint grid n=(\\d+)"))) {
      const int n = std::stoi(match[1]);
      points.resize(1);
      for (int i = 0; i < n; ++i) points[0].push_back((i + 0.5) / n);
    } else {
      ASSERT_TRUE(entry["points"].is_array()) << name;
      points = columns_of(entry["points"].get<std::vector<std::vector<double>>>());
    }
    EXPECT_NEAR(exact(points), entry["value"].get<double>(), entry["tolerance"].get<double>()) << name;
    ++checked;
  }
  EXPECT_GE(checked, 30);
}

TEST(StarBounds, BracketWhatTheyCannotReach) {
  std::mt19937_64 random(1);
  for (std::size_t dims = 3; dims <= 6; ++dims) {
    for (const std::uint64_t grid : {0, 0, 7}) {
      const Columns points = random_points(150, dims, random, grid);
      const double star = exact(points);
      double upper = 1;
      for (const std::uint64_t work : {1000, 10000, 100000, 400000}) {
        const StarBounds found = star_bounds(view(points), work);
        EXPECT_LE(found.lower, star) << dims << ' ' << work;
        EXPECT_GE(found.upper, star) << dims << ' ' << work;
        EXPECT_LE(found.upper, 1);
        EXPECT_GT(found.lower, 0.3 * star);
        EXPECT_EQ(found.exact, found.lower == found.upper);
        EXPECT_TRUE(found.exact || star_method(found).starts_with("bounds: threshold accepting"));
        upper = std::min(upper, found.upper);
      }
      EXPECT_LT(upper, 1) << dims;
    }
  }
}

TEST(StarBounds, BeyondReachTheyAreUseful) {
  const Columns points = halton(0, 1024, 9);
  const StarBounds found = star_bounds(view(points), std::uint64_t{1} << 26);
  EXPECT_FALSE(found.exact);
  EXPECT_EQ(star_method(found), "bounds: threshold accepting, branch and bound");
  EXPECT_LT(found.upper, 0.5);
  // A box of the first dimensions is one of all.
  EXPECT_GE(found.upper, exact(halton(0, 1024, 2)));
}

TEST(StarBounds, InManyDimensionsOnlyTheLower) {
  std::mt19937_64 random(2);
  const StarBounds found = star_bounds(view(random_points(20, 40, random)), std::uint64_t{1} << 22);
  EXPECT_FALSE(found.exact);
  EXPECT_EQ(found.upper, 1);
  EXPECT_GT(found.lower, 0.5);
  EXPECT_EQ(star_method(found), "bounds: threshold accepting");
}

TEST(StarBounds, DoNotDependOnTheOrderOfPointsOrDimensions) {
  std::mt19937_64 random(3);
  for (const std::size_t dims : {3, 5, 8}) {
    Columns points = random_points(120, dims, random, dims == 5 ? 20 : 0);
    const double star = exact(points);
    for (int trial = 0; trial < 4; ++trial) {
      std::shuffle(points.begin(), points.end(), random);
      EXPECT_NEAR(exact(points), star, 1e-14);
      const std::uint64_t seed = random();
      for (auto& column : points) std::shuffle(column.begin(), column.end(), std::mt19937_64(seed));  // alike in all
      EXPECT_NEAR(exact(points), star, 1e-14);
    }
  }
}

// A box of the first dimensions is one of all, as wide as can be in the others.
TEST(StarBounds, MoreDimensionsAreNotLess) {
  std::mt19937_64 random(4);
  const Columns all = random_points(200, 7, random);
  double before = 0;
  for (std::size_t dims = 1; dims <= 7; ++dims) {
    const double star = exact(Columns(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(dims)));
    EXPECT_GE(star, before - 1e-14) << dims;
    before = star;
  }
}

TEST(StarBounds, TheSamePointsGiveTheSameBits) {
  const Columns points = halton(0, 400, 7);
  const StarBounds first = star_bounds(view(points), 3000000), again = star_bounds(view(points), 3000000);
  EXPECT_FALSE(first.exact);
  EXPECT_EQ(first.lower, again.lower);
  EXPECT_EQ(first.upper, again.upper);
}

TEST(StarBounds, RefuseWhatDoesNotFit) {
  EXPECT_THAT(star_refusal(std::size_t{1} << 20, 4), IsEmpty());
  EXPECT_THAT(star_refusal(std::size_t{1} << 20, 5), HasSubstr("1 GB"));
  EXPECT_THAT(star_refusal(std::size_t{1} << 23, 2), IsEmpty());
  EXPECT_THAT(star_refusal(std::size_t{1} << 25, 1), HasSubstr("16777216 coordinates"));
}

// J. H. Halton, S. K. Zaremba, "The extreme and L2 discrepancies of some plane sets", Monatsh. Math. 73, 1969.
TEST(LongStarDiscrepancy, OfAMillionHammersleyPoints) {
  for (int m = 17; m <= 20; ++m) {
    const double n = std::ldexp(1.0, m);
    EXPECT_NEAR(n * star_discrepancy(view(hammersley(m))), m / 3.0 + 13 / 9.0 - (m % 2 == 0 ? 4 : -4) / (9 * n), 1e-9)
        << m;
  }
}

}  // namespace
}  // namespace halfslope
