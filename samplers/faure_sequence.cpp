#include "samplers/faure_sequence.h"

#include <algorithm>

#include "core/assertion.h"
#include "samplers/radical_inverse.h"

namespace halfslope {

std::uint32_t faure_base(int dims) {
  assert_equal(1 <= dims && dims <= 1024, true, "faure_base: one to 1024 dimensions");
  return *std::lower_bound(primes().begin(), primes().end(), static_cast<std::uint32_t>(dims));
}

GeneratorMatrices faure_matrices(int dims, int digits) {
  const std::uint32_t base = faure_base(dims);
  const auto size = static_cast<std::size_t>(digits);
  std::vector<std::uint32_t> pascal(size * size);  // [column][row]: binom(column, row)
  for (std::size_t column = 0; column < size; ++column) {
    pascal[column * size] = 1;
    for (std::size_t row = 1; row <= column; ++row) {
      pascal[column * size + row] = (pascal[(column - 1) * size + row - 1] + pascal[(column - 1) * size + row]) % base;
    }
  }
  GeneratorMatrices matrices = {base, dims, digits, {}};
  matrices.entries.resize(static_cast<std::size_t>(dims) * size * size);
  std::uint32_t* entry = matrices.entries.data();
  for (std::uint32_t dim = 0; dim < static_cast<std::uint32_t>(dims); ++dim) {
    for (std::size_t row = 0; row < size; ++row) {
      std::uint32_t power = 1;  // dim^(column − row)
      for (std::size_t column = row; column < size; ++column, power = power * dim % base) {
        entry[row * size + column] = pascal[column * size + row] * power % base;
      }
    }
    entry += size * size;
  }
  return matrices;
}

FaureDigits::FaureDigits(const GeneratorMatrices& matrices, int dim) : base_(matrices.base) {
  const auto size = static_cast<std::size_t>(matrices.digits);
  digits_.resize(size);
  carry_.resize(size);
  steps_.resize(size * size);
  for (int row = 0; row < matrices.digits; ++row) {
    std::uint32_t sum = 0;
    for (int column = 0; column < matrices.digits; ++column) {
      matrix_.push_back(matrices.entry(dim, row, column));
      sum = (sum + matrix_.back()) % base_;
      steps_[static_cast<std::size_t>(column) * size + static_cast<std::size_t>(row)] = sum;
    }
  }
}

void FaureDigits::seek(std::uint64_t index) {
  index_ = index;
  for (std::uint32_t& digit : carry_) {
    digit = static_cast<std::uint32_t>(index % base_);
    index /= base_;
  }
  assert_equal(index, std::uint64_t{0}, "FaureDigits: what is left of the index after its digits");
  for (std::size_t row = 0; row < size(); ++row) {
    std::uint64_t sum = 0;
    for (std::size_t column = row; column < size(); ++column) {
      sum += std::uint64_t{matrix_[row * size() + column]} * carry_[column];
    }
    digits_[row] = static_cast<std::uint32_t>(sum % base_);
  }
}

}  // namespace halfslope
