#include "analysis/t_value.h"

#include <gmock/gmock.h>

#include "tests/analysis/digital_nets.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;

// From elementary intervals counted one by one, elsewhere.
TEST(TValue, OfSobolPoints) {
  struct Case {
    int dims, m, t;
  };
  for (const auto& [dims, m, t] : std::vector<Case>{{1, 4, 0},
                                                    {1, 8, 0},
                                                    {3, 5, 1},
                                                    {3, 6, 1},
                                                    {3, 7, 1},
                                                    {3, 8, 1},
                                                    {3, 9, 1},
                                                    {4, 4, 2},
                                                    {4, 6, 2},
                                                    {4, 8, 3},
                                                    {5, 8, 3},
                                                    {6, 6, 3},
                                                    {6, 8, 4},
                                                    {6, 10, 4}}) {
    const GeneratorMatrices sobol = sobol_matrices(dims, 16);
    EXPECT_EQ(t_value(sobol, m), t) << dims << ' ' << m;
    EXPECT_EQ(t_value(view(net(sobol, m)), 2), t) << dims << ' ' << m;
  }
}

// A (0, d)-sequence in every prime base of at least d; more dimensions than that are not.
TEST(TValue, OfFaurePointsIsZero) {
  for (const auto& [base, dims, most] : {std::array{2, 2, 12}, {3, 3, 6}, {5, 5, 4}, {7, 7, 3}}) {
    const GeneratorMatrices faure = faure_matrices(static_cast<std::uint32_t>(base), dims, most);
    for (int m = 0; m <= most; ++m) {
      EXPECT_EQ(t_value(faure, m), 0) << base << ' ' << m;
      EXPECT_EQ(t_value(view(net(faure, m)), static_cast<std::uint32_t>(base)), 0) << base << ' ' << m;
    }
  }
}

// Ranks and intervals say the same of any matrices, and a digital shift, which moves whole intervals onto others,
// changes nothing.
TEST(TValue, FromMatricesAndFromPointsAgree) {
  std::mt19937_64 random(3);
  std::array<int, 16> seen = {};
  for (const auto& [base, most] : {std::pair{2, 9}, {3, 5}, {5, 3}}) {
    for (int dims = 1; dims <= 5; ++dims) {
      for (int trial = 0; trial < 12; ++trial) {
        GeneratorMatrices some = matrices(static_cast<std::uint32_t>(base), dims, most);
        for (auto& e : some.entries) e = static_cast<std::uint32_t>(random() % static_cast<std::uint64_t>(base));
        // Half of them upper triangular with a diagonal of ones, which are better.
        for (int dim = 0; dim < dims && trial % 2 == 0; ++dim)
          for (int row = 0; row < most; ++row)
            for (int column = 0; column <= row; ++column) entry(some, dim, row, column) = row == column ? 1 : 0;
        Columns points = net(some, most);
        const int t = t_value(some, most);
        ++seen[static_cast<std::size_t>(t)];
        EXPECT_EQ(t_value(view(points), static_cast<std::uint32_t>(base)), t) << base << ' ' << dims << ' ' << trial;
        if (base != 2) continue;
        for (auto& column : points) {
          const std::uint64_t shift = random() >> 11;
          for (double& x : column) x = static_cast<double>(static_cast<std::uint64_t>(x * 0x1p53) ^ shift) * 0x1p-53;
        }
        EXPECT_EQ(t_value(view(points), 2), t) << "shifted " << dims << ' ' << trial;
      }
    }
  }
  for (int t = 0; t <= 5; ++t) EXPECT_GT(seen[static_cast<std::size_t>(t)], 0) << "no case had t = " << t;
}

TEST(TValue, OfPointsThatAreNoNet) {
  EXPECT_EQ(t_value(view({{0.3}, {0.9}}), 2), 0);                            // one point
  EXPECT_EQ(t_value(view({{0.1, 0.2}, {0.1, 0.9}}), 2), 1);                  // both in the left half
  EXPECT_EQ(t_value(view({{0.1, 0.9, 0.6, 0.3}}), 2), 0);                    // one in each quarter
  EXPECT_EQ(t_value(view({{0.1, 0.9, 0.6, 0.4}, {0, 0, 0.5, 0.5}}), 2), 1);  // [0, ½) × [½, 1) has one, its mirror too
  EXPECT_EQ(t_value(view({{0, 0.5, 0.25, 0.75}, {0, 0.5, 0.75, 0.25}}), 2), 0);
  EXPECT_EQ(t_value(view({{0.0, 1.0}}), 2), 0);  // 1 counts as just below
  // Thirds rounded to nearest, up and down.
  EXPECT_EQ(t_value(view({{0, 1.0 / 3, 2.0 / 3}}), 3), 0);
  EXPECT_EQ(t_value(view({{0, std::nextafter(1.0 / 3, 0.0), std::nextafter(2.0 / 3, 1.0)}}), 3), 0);
}

TEST(TValue, RefusesWhatItCannotCount) {
  EXPECT_EQ(t_value_refusal(1024, 6, 2), "");
  EXPECT_EQ(t_value_refusal(1 << 20, 2, 2), "");
  EXPECT_EQ(t_value_refusal(1, 3, 5), "");
  EXPECT_THAT(t_value_refusal(1000, 2, 2), HasSubstr("1000 is no power of 2"));
  EXPECT_THAT(t_value_refusal(0, 2, 2), HasSubstr("0 is no power of 2"));
  EXPECT_THAT(t_value_refusal(1024, 2, 3), HasSubstr("1024 is no power of 3"));
  EXPECT_THAT(t_value_refusal(1 << 20, 10, 2), HasSubstr("3.2e+13 steps"));  // (30 choose 10) 2²⁰
}

TEST(TValue, OfManyDigitsAndDimensions) {
  // In two dimensions Sobol' points are a (0, 2)-sequence.
  EXPECT_EQ(t_value(sobol_matrices(2, 24), 24), 0);
  EXPECT_EQ(t_value(view(sobol(0, 1 << 16)), 2), 0);
  // A matrix twice: two equal first rows are dependent, so one row is all that is safe.
  GeneratorMatrices twice = matrices(2, 10, 20);
  for (int dim = 0; dim < 10; ++dim)
    for (int row = 0; row < 20; ++row) entry(twice, dim, row, row) = 1;
  EXPECT_EQ(t_value(twice, 20), 19);
}

}  // namespace
}  // namespace halfslope
