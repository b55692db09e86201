// The Faure sequence as digits: what its samplers write down or scramble.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/generator_matrices.h"

namespace halfslope {

/// The base of the Faure sequence in `dims` dimensions, 1 ≤ dims ≤ 1024: the least prime that is not below.
std::uint32_t faure_base(int dims);

/// The generator matrices of the first base^digits points: that of dimension j is the j-th power of Pascal's,
/// binom(column, row) j^(column − row) modulo the base. H. Faure, "Discrépance de suites associées à un système de
/// numération (en dimension s)" (1982).
GeneratorMatrices faure_matrices(int dims, int digits);

/// The digits of one coordinate of consecutive points, for indices up to 2³¹.
class FaureDigits {
 public:
  /// Dimension `dim` of `matrices`, which have `digits` of them: base^digits is above 2³¹ or the last index.
  FaureDigits(const GeneratorMatrices& matrices, int dim);
  /// Goes to `index`.
  void seek(std::uint64_t index);
  std::uint64_t index() const { return index_; }
  /// Digit `row` of the coordinate, 0 the first.
  std::uint32_t operator[](std::size_t row) const { return digits_[row]; }
  std::size_t size() const { return digits_.size(); }
  /// To the next index; change(row, before, after) is called for each digit that does.
  ///
  /// Where the index ends in c digits b − 1, its digits 0 to c change, each by 1 modulo b. So a coordinate's digits 0
  /// to c grow by constants, a column of these for each c.
  template <class Change>
  void next(Change change) {
    std::size_t c = 0;
    while (++carry_[c] == base_) carry_[c++] = 0;
    ++index_;
    const std::uint32_t* step = steps_.data() + c * size();
    for (std::size_t row = 0; row <= c; ++row) {
      const std::uint32_t before = digits_[row], sum = before + step[row];
      digits_[row] = sum < base_ ? sum : sum - base_;
      change(row, before, digits_[row]);
    }
  }

 private:
  std::uint32_t base_;
  std::uint64_t index_ = 0;
  std::vector<std::uint32_t> matrix_;          ///< [row][column]
  std::vector<std::uint32_t> steps_;           ///< [c][row]: the sum of columns row to c
  std::vector<std::uint32_t> digits_, carry_;  ///< of the coordinate, of the index
};

}  // namespace halfslope
