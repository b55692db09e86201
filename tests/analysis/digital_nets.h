// Digital nets by their generator matrices.
#pragma once

#include <cstdint>
#include <vector>

#include "core/generator_matrices.h"
#include "tests/analysis/point_sets.h"

namespace halfslope {

inline GeneratorMatrices matrices(std::uint32_t base, int dims, int digits) {
  GeneratorMatrices result = {base, dims, digits, {}};
  result.entries.resize(static_cast<std::size_t>(dims * digits * digits));
  return result;
}
inline std::uint32_t& entry(GeneratorMatrices& m, int dim, int row, int column) {
  return m.entries[static_cast<std::size_t>((dim * m.digits + row) * m.digits + column)];
}

/// S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", 2008: degree,
/// coefficients and first numbers of dimensions 2 … 6.
inline GeneratorMatrices sobol_matrices(int dims, int digits) {
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
inline GeneratorMatrices faure_matrices(std::uint32_t base, int dims, int digits) {
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
inline Columns net(const GeneratorMatrices& from, int m) {
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

}  // namespace halfslope
