#include "analysis/t_value.h"

#include <gmock/gmock.h>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;

GeneratorMatrices matrices(std::uint32_t base, int dims, int digits) {
  GeneratorMatrices result = {base, dims, digits, {}};
  result.entries.resize(static_cast<std::size_t>(dims * digits * digits));
  return result;
}
std::uint32_t& entry(GeneratorMatrices& m, int dim, int row, int column) {
  return m.entries[static_cast<std::size_t>((dim * m.digits + row) * m.digits + column)];
}

/// S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", 2008: degree,
/// coefficients and first numbers of dimensions 2 … 6.
GeneratorMatrices sobol_matrices(int dims, int digits) {
  struct Line {
    int degree;
    std::uint32_t coefficients;
    std::vector<std::uint32_t> first;
  };
  const std::vector<Line> lines = {
      {1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}};
  GeneratorMatrices result = matrices(2, dims, digits);
  for (int dim = 0; dim < dims; ++dim) {
    std::vector<std::uint32_t> odd;  // direction number k is odd[k] / 2^(k+1)
    for (int k = 0; k < digits; ++k) {
      if (dim == 0) {
        odd.push_back(1);
        continue;
      }
      const Line& line = lines[static_cast<std::size_t>(dim - 1)];
      if (k < line.degree) {
        odd.push_back(line.first[static_cast<std::size_t>(k)]);
        continue;
      }
      const auto back = [&odd, k](int j) { return odd[static_cast<std::size_t>(k - j)]; };
      std::uint32_t next = back(line.degree) ^ (back(line.degree) << line.degree);
      for (int j = 1; j < line.degree; ++j)
        if ((line.coefficients >> (line.degree - 1 - j)) & 1) next ^= back(j) << j;
      odd.push_back(next);
    }
    for (int row = 0; row < digits; ++row)
      for (int column = row; column < digits; ++column)
        entry(result, dim, row, column) = (odd[static_cast<std::size_t>(column)] >> (column - row)) & 1;
  }
  return result;
}

/// Powers of the Pascal matrix: H. Faure, "Discrépance de suites associées à un système de numération", 1982.
GeneratorMatrices faure_matrices(std::uint32_t base, int dims, int digits) {
  GeneratorMatrices result = matrices(base, dims, digits);
  for (int dim = 0; dim < dims; ++dim) {
    for (int column = 0; column < digits; ++column) {
      for (int row = 0; row <= column; ++row) {
        std::uint64_t value = 1;
        for (int k = 0; k < row; ++k)
          value = value * static_cast<std::uint64_t>(column - k) / static_cast<std::uint64_t>(k + 1);
        for (int k = row; k < column; ++k) value = value * static_cast<std::uint64_t>(dim) % base;
        entry(result, dim, row, column) = static_cast<std::uint32_t>(value % base);
      }
    }
  }
  return result;
}

/// The first base^m points, rounded down.
Columns net(const GeneratorMatrices& from, int m) {
  std::uint64_t count = 1;
  for (int k = 0; k < m; ++k) count *= from.base;
  Columns columns(static_cast<std::size_t>(from.dims));
  for (int dim = 0; dim < from.dims; ++dim) {
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint64_t digits = 0, power = 1;
      for (int row = 0; row < from.digits; ++row, power *= from.base) {
        std::uint64_t digit = 0, rest = i;
        for (int column = 0; column < m; ++column, rest /= from.base)
          digit += from.entry(dim, row, column) * (rest % from.base);
        digits = digits * from.base + digit % from.base;
      }
      __extension__ using Wide = unsigned __int128;
      columns[static_cast<std::size_t>(dim)].push_back(static_cast<double>((Wide{digits} << 53) / power) * 0x1p-53);
    }
  }
  return columns;
}

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
