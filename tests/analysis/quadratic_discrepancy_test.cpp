#include "analysis/quadratic_discrepancy.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "core/kernel_library.h"
#include "tests/analysis/quadratic_definitions.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;

// The parts of D² are below 20 in five dimensions (mixture's 15/8 to the 5th is the largest of its mean squares), and
// 64 bits of each are right, so D² is to 4e-18 or so, and D to that over 2 D.
TEST(QuadraticDiscrepancy, IsItsDefinition) {
  std::mt19937_64 random(1);
  for (const Definition& definition : definitions()) {
    for (std::size_t dims = 1; dims <= 5; ++dims) {
      for (const std::size_t count : {1, 2, 3, 7, 16, 40}) {
        for (const std::uint64_t grid : {0, 1, 2, 5, 9}) {
          const Columns points = random_points(count, dims, random, grid);
          const Real exact = std::sqrt(squared(definition, points));
          const double tolerance = 1e-15 * static_cast<double>(exact) + 5e-18 / static_cast<double>(exact);
          EXPECT_NEAR(definition.measure(view(points)), static_cast<double>(exact), tolerance)
              << definition.name << " d=" << dims << " N=" << count << " grid " << grid;
          EXPECT_NEAR(quadratic_discrepancy_by_pairs(view(points), definition.kernel), static_cast<double>(exact),
                      tolerance)
              << "by pairs: " << definition.name << " d=" << dims << " N=" << count << " grid " << grid;
        }
      }
    }
  }
}

Columns in_thirds(std::size_t count, std::size_t dims) {  // no coordinate but 0 is a multiple of 2⁻⁵³
  Columns columns = halton(0, count, dims);
  for (auto& column : columns)
    for (double& x : column) x /= 3;
  return columns;
}

// The integers of the plane and the squares of the line against pairs of binary64, where the parts of D² cancel to 10⁻⁸
// of themselves.
TEST(QuadraticDiscrepancy, ShortWaysAgreeWithPairs) {
  for (const Columns& points : {sobol(0, 4096), sobol(1, 3000), halton(0, 3000), in_thirds(1500, 2), hammersley(12),
                                halton(7, 2000, 1), in_thirds(1000, 1)}) {
    for (const Definition& definition : definitions()) {
      const double pairs = quadratic_discrepancy_by_pairs(view(points), definition.kernel);
      EXPECT_NEAR(definition.measure(view(points)) / pairs, 1, 1e-15)
          << definition.name << ' ' << points.size() << ' ' << points[0].size();
    }
  }
}

// In more dimensions: N points, each twice, have the discrepancy of N, and so have they after a shift of the order. The
// order of all sums changes, and nothing else.
TEST(QuadraticDiscrepancy, TwiceEachPointIsTheSameInMoreDimensions) {
  for (Columns points : {halton(0, 700, 3), halton(0, 700, 6), in_thirds(500, 4)}) {
    Columns twice = points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      twice[k].insert(twice[k].end(), points[k].begin(), points[k].end());
      std::rotate(twice[k].begin(), twice[k].begin() + 123, twice[k].end());
    }
    for (const Definition& definition : definitions()) {
      EXPECT_NEAR(definition.measure(view(twice)) / definition.measure(view(points)), 1, 5e-16)
          << definition.name << ' ' << points.size();
    }
  }
}

TEST(QuadraticDiscrepancy, InManyDimensions) {
  std::mt19937_64 random(2);
  for (const std::size_t dims : {30, 200, 512, 1024}) {
    const Columns points = random_points(5, dims, random);
    for (const Definition& definition : definitions()) {
      if (&definition.kernel == &kExtremeL2 && dims > kExtremeDims) continue;
      const Real exact = std::sqrt(squared(definition, points));
      EXPECT_NEAR(definition.measure(view(points)) / static_cast<double>(exact), 1, 1e-14)
          << definition.name << ' ' << dims;
    }
  }
}

// Coordinates of which binary64 has more places than a fixed point.
TEST(QuadraticDiscrepancy, OfTinyCoordinates) {
  for (const std::size_t dims : {1, 2, 3}) {
    const Columns points(dims, {0.0, 0x1p-1074, 1e-300, 0x1p-70, 1e-20, 0x1p-62, 3e-18, 1e-5, 1 - 0x1p-53, 1.0});
    for (const Definition& definition : definitions()) {
      const Real exact = std::sqrt(squared(definition, points));
      EXPECT_NEAR(definition.measure(view(points)) / static_cast<double>(exact), 1, 1e-15)
          << definition.name << ' ' << dims;
    }
  }
}

// AVX2 and AVX-512 give the same bits; the baseline, whose fused operations are not, differs by a unit in the last
// place of D at most.
TEST(QuadraticDiscrepancy, DoesNotDependOnTheInstructionSet) {
  const char* asked = std::getenv("HALFSLOPE_ISA");
  const std::optional<std::string> before = asked ? std::optional<std::string>(asked) : std::nullopt;
  for (const Columns& points : {halton(0, 777, 3), halton(3, 600, 5), in_thirds(300, 3)}) {
    for (const Definition& definition : definitions()) {
      std::map<std::string, double> values;
      for (const Isa isa : supported_isas()) {
        setenv("HALFSLOPE_ISA", to_string(isa).c_str(), 1);
        const double value = definition.measure(view(points));
        const auto [known, is_new] = values.emplace(isa_class(isa), value);
        EXPECT_EQ(known->second, value) << definition.name << ' ' << to_string(isa);
        EXPECT_NEAR(value / values.begin()->second, 1, 3e-16) << definition.name << ' ' << to_string(isa);
      }
    }
  }
  before ? setenv("HALFSLOPE_ISA", before->c_str(), 1) : unsetenv("HALFSLOPE_ISA");
}

TEST(QuadraticDiscrepancy, RefusesWhatWouldTakeTooLong) {
  EXPECT_EQ(quadratic_discrepancy_refusal(1 << 20, 1), "");
  EXPECT_EQ(quadratic_discrepancy_refusal(1 << 20, 2), "");
  EXPECT_EQ(quadratic_discrepancy_refusal(1 << 18, 4), "");
  EXPECT_THAT(quadratic_discrepancy_refusal(1 << 20, 4), HasSubstr("2.2e+12 kernels"));  // 4 · 2⁴⁰ / 2
  EXPECT_THAT(quadratic_discrepancy_refusal((std::size_t{1} << 26) + 1, 2), HasSubstr("2^26"));
  EXPECT_THAT(quadratic_discrepancy_refusal(std::size_t{1} << 50, 1), HasSubstr("9007199.3 GB"));
}

}  // namespace
}  // namespace halfslope
