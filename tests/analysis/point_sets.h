// Point sets with known discrepancies.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "analysis/discrepancy.h"

namespace halfslope {

using Columns = std::vector<std::vector<double>>;  ///< one a dimension

inline PointSet view(const Columns& columns) {
  return PointSet(std::vector<std::span<const double>>(columns.begin(), columns.end()));
}

inline Columns columns_of(const std::vector<std::vector<double>>& points) {
  Columns columns(points.front().size());
  for (const auto& point : points) {
    for (std::size_t k = 0; k < point.size(); ++k) columns[k].push_back(point[k]);
  }
  return columns;
}

inline double inverse(std::uint64_t base, std::uint64_t index) {
  std::uint64_t digits = 0, power = 1;  // the digits reversed, over base^their number
  for (; index > 0; index /= base, power *= base) digits = digits * base + index % base;
  return static_cast<double>(digits) / static_cast<double>(power);
}

/// (i/N, φ₂(i)), N = 2^m.
inline Columns hammersley(int m) {
  const std::uint64_t n = std::uint64_t{1} << m;
  Columns columns(2);
  for (std::uint64_t i = 0; i < n; ++i) {
    columns[0].push_back(static_cast<double>(i) / static_cast<double>(n));
    columns[1].push_back(inverse(2, i));
  }
  return columns;
}

/// Radical inverses of begin … end − 1 in the first `dims` primes.
inline Columns halton(std::uint64_t begin, std::uint64_t end, std::size_t dims = 2) {
  Columns columns;
  for (std::uint64_t base = 2; columns.size() < dims; ++base) {
    bool prime = true;
    for (std::uint64_t k = 2; k * k <= base; ++k) prime = prime && base % k != 0;
    if (!prime) continue;
    auto& column = columns.emplace_back();
    for (std::uint64_t i = begin; i < end; ++i) column.push_back(inverse(base, i));
  }
  return columns;
}

/// The first two dimensions of Sobol' points begin … end − 1: van der Corput's, and the binary Pascal matrix, whose
/// direction numbers follow v_(k+1) = v_k ⊕ v_k/2.
inline Columns sobol(std::uint64_t begin, std::uint64_t end) {
  Columns columns(2);
  for (std::uint64_t i = begin; i < end; ++i) {
    std::uint32_t bits = 0, direction = 0x80000000;
    for (std::uint64_t rest = i; rest > 0; rest /= 2, direction ^= direction >> 1)
      if (rest % 2 == 1) bits ^= direction;
    columns[0].push_back(inverse(2, i));
    columns[1].push_back(bits * 0x1p-32);
  }
  return columns;
}

/// `count` uniform points; of few different coordinates where `grid` is not 0, so that many are equal, and some 0 or 1.
inline Columns random_points(std::size_t count, std::size_t dims, std::mt19937_64& random, std::uint64_t grid = 0) {
  Columns columns(dims, std::vector<double>(count));
  for (auto& column : columns) {
    for (double& x : column) {
      x = grid == 0 ? static_cast<double>(random() >> 11) * 0x1p-53
                    : static_cast<double>(random() % (grid + 1)) / static_cast<double>(grid);
    }
  }
  return columns;
}

}  // namespace halfslope
