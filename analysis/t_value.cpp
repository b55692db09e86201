#include "analysis/t_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/assertion.h"

namespace halfslope {
namespace {

/// Independent rows over the integers modulo 2, reduced: a word a row, a bit a column.
class BinaryBasis {
 public:
  using Row = std::uint64_t;
  BinaryBasis(std::uint32_t, int) {}

  static Row row(const GeneratorMatrices& matrices, int dim, int row, int columns) {
    Row word = 0;
    for (int c = 0; c < columns; ++c) word |= Row{matrices.entry(dim, row, c)} << c;
    return word;
  }
  /// Whether the row is independent of those that are in; then it is in too.
  bool insert(Row row) {
    for (const Row& other : rows_) row = std::min(row, row ^ other);
    if (row == 0) return false;
    rows_.push_back(row);
    return true;
  }
  void drop_last() { rows_.pop_back(); }

 private:
  std::vector<Row> rows_;
};

/// The same modulo any prime.
class PrimeBasis {
 public:
  using Row = std::vector<std::uint32_t>;
  PrimeBasis(std::uint32_t base, int columns) : base_(base), columns_(static_cast<std::size_t>(columns)) {}

  static Row row(const GeneratorMatrices& matrices, int dim, int row, int columns) {
    Row digits;
    for (int c = 0; c < columns; ++c) digits.push_back(matrices.entry(dim, row, c));
    return digits;
  }
  bool insert(Row row) {
    for (const auto& [pivot, other] : rows_) {
      const std::uint64_t factor = base_ - row[pivot];
      for (std::size_t c = 0; c < columns_; ++c)
        row[c] = static_cast<std::uint32_t>((row[c] + factor * other[c]) % base_);
    }
    const auto lead = std::find_if(row.begin(), row.end(), [](std::uint32_t digit) { return digit != 0; });
    if (lead == row.end()) return false;
    const std::uint64_t inverse = power(*lead, base_ - 2);
    for (std::uint32_t& digit : row) digit = static_cast<std::uint32_t>(digit * inverse % base_);
    rows_.push_back({static_cast<std::size_t>(lead - row.begin()), row});
    return true;
  }
  void drop_last() { rows_.pop_back(); }

 private:
  struct Pivoted {
    std::size_t pivot;
    Row row;
  };
  std::uint64_t power(std::uint64_t x, std::uint64_t exponent) const {
    std::uint64_t result = 1;
    for (; exponent > 0; exponent /= 2, x = x * x % base_)
      if (exponent % 2 == 1) result = result * x % base_;
    return result;
  }

  std::uint64_t base_;
  std::size_t columns_;
  std::vector<Pivoted> rows_;
};

/// The fewest rows, the first few of each matrix, that are dependent.
template <class Basis>
class DependentRows {
 public:
  DependentRows(const GeneratorMatrices& matrices, int m, double most_steps)
      : basis_(matrices.base, m), fewest_(m + 1), steps_left_(most_steps) {
    for (int dim = 0; dim < matrices.dims; ++dim) {
      auto& rows = rows_.emplace_back();
      for (int r = 0; r < m; ++r) rows.push_back(Basis::row(matrices, dim, r, m));
    }
    search(0, 0);
  }
  int fewest() const { return fewest_; }
  /// Whether there are no fewer.
  bool finished() const { return steps_left_ > 0; }

 private:
  void search(std::size_t dim, int taken) {
    if (dim == rows_.size() || --steps_left_ <= 0) return;
    search(dim + 1, taken);
    int own = 0;
    while (taken + own + 1 < fewest_ && finished()) {
      if (!basis_.insert(rows_[dim][static_cast<std::size_t>(own)])) {
        fewest_ = taken + own + 1;
        break;
      }
      ++own;
      search(dim + 1, taken + own);
    }
    for (; own > 0; --own) basis_.drop_last();
  }

  std::vector<std::vector<typename Basis::Row>> rows_;
  Basis basis_;
  int fewest_;
  double steps_left_;
};

template <class Basis>
TValueBounds bounds_by(const GeneratorMatrices& matrices, int m, double most_steps) {
  const DependentRows<Basis> rows(matrices, m, most_steps);
  const int lower = m - (rows.fewest() - 1);
  return {lower, rows.finished() ? lower : m};
}

bool is_prime(std::uint32_t n) {
  for (std::uint32_t k = 2; k <= n / k; ++k)
    if (n % k == 0) return false;
  return n >= 2;
}

/// Points in the elementary intervals.
class Intervals {
 public:
  Intervals(const PointSet& points, std::uint32_t base, int m) : count_(points.count()), m_(m) {
    const auto cells = static_cast<std::uint64_t>(count_);
    for (std::size_t k = 0; k < points.dims(); ++k) {
      auto& cell = finest_.emplace_back();
      for (const double x : points.column(k)) {
        __extension__ using Wide = unsigned __int128;
        const auto after = std::min(static_cast<std::uint64_t>(x * 0x1p53) + 1, std::uint64_t{1} << 53);
        cell.push_back(static_cast<std::uint32_t>((Wide{after} * cells - 1) >> 53));
      }
    }
    cells_.assign(count_, 0), held_.resize(count_);
    powers_.push_back(1);
    for (int k = 0; k < m; ++k) powers_.push_back(powers_.back() * base);
  }

  /// Whether all intervals of volume base^−fineness hold the same number of points.
  bool even(int fineness) { return even(fineness, 0, 1); }

 private:
  // The dimensions from `dim` on share `left` digits; cells_ numbers the intervals in the dimensions before it.
  bool even(int left, std::size_t dim, std::uint64_t intervals) {
    if (dim + 1 == finest_.size() || left == 0) return even_cells(dim, left, intervals);
    const std::vector<std::uint32_t> before = cells_;
    for (int own = 0; own <= left; ++own) {
      const std::uint64_t wide = powers_[static_cast<std::size_t>(own)];
      const auto shrink = static_cast<std::uint32_t>(powers_[static_cast<std::size_t>(m_ - own)]);
      for (std::size_t i = 0; i < count_; ++i)
        cells_[i] = static_cast<std::uint32_t>(before[i] * wide + finest_[dim][i] / shrink);
      if (!even(left - own, dim + 1, intervals * wide)) return false;
    }
    cells_ = before;
    return true;
  }

  // The last dimension takes all that is left. No interval has too many exactly when all have the same.
  bool even_cells(std::size_t dim, int left, std::uint64_t intervals) {
    const std::uint64_t wide = powers_[static_cast<std::size_t>(left)];
    const auto shrink = static_cast<std::uint32_t>(powers_[static_cast<std::size_t>(m_ - left)]);
    intervals *= wide;
    const std::uint64_t share = count_ / intervals;
    std::fill_n(held_.begin(), intervals, 0);
    for (std::size_t i = 0; i < count_; ++i) {
      if (++held_[cells_[i] * wide + finest_[dim][i] / shrink] > share) return false;
    }
    return true;
  }

  std::size_t count_;
  int m_;
  std::vector<std::vector<std::uint32_t>> finest_;  ///< of base^m cells a dimension, the one that each point is in
  std::vector<std::uint32_t> cells_, held_;
  std::vector<std::uint64_t> powers_;
};

}  // namespace

std::optional<int> exponent_of(std::size_t count, std::uint32_t base) {
  int m = 0;
  for (; count % base == 0 && count > 1; count /= base) ++m;
  return count == 1 ? std::optional(m) : std::nullopt;
}

TValueBounds t_value_bounds(const GeneratorMatrices& matrices, int m, double most_steps) {
  assert_equal(is_prime(matrices.base), true, "generator matrices over a field: a prime base");
  assert_equal(m >= 0 && m <= matrices.digits && m <= 64, true, "digits of the index within the matrices'");
  return matrices.base == 2 ? bounds_by<BinaryBasis>(matrices, m, most_steps)
                            : bounds_by<PrimeBasis>(matrices, m, most_steps);
}

int t_value(const GeneratorMatrices& matrices, int m) {
  return t_value_bounds(matrices, m, std::numeric_limits<double>::infinity()).lower;
}

int t_value(const PointSet& points, std::uint32_t base) {
  const std::optional<int> m = exponent_of(points.count(), base);
  assert_equal(m.has_value(), true, "a number of points that is a power of the base");
  Intervals intervals(points, base, *m);
  int fineness = 0;
  while (fineness < *m && intervals.even(fineness + 1)) ++fineness;
  return *m - fineness;
}

std::string t_value_refusal(std::size_t count, std::size_t dims, std::uint32_t base) {
  const std::optional<int> m = exponent_of(count, base);
  if (!m) return fmt::format("it takes base^m points, and {} is no power of {}", count, base);
  // All ways to share 0 … m digits among the dimensions: (m + d choose d).
  double shapes = 1;
  for (std::size_t k = 1; k <= dims; ++k) shapes *= (*m + static_cast<double>(k)) / static_cast<double>(k);
  const double work = shapes * static_cast<double>(count);
  constexpr double kMost = 5e10;
  if (work <= kMost) return "";
  return fmt::format("counting {} points in {:.1e} shapes of intervals may take {:.1e} steps (at most {:.0e})", count,
                     shapes, work, kMost);
}

}  // namespace halfslope
