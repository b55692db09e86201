#include "samplers/sobol_sequence.h"

#include <bit>
#include <boost/random/detail/sobol_table.hpp>
#include <cstddef>

#include "core/assertion.h"

namespace halfslope {
namespace {

using Table = boost::random::detail::qrng_tables::sobol;
constexpr int kDigits = 32;

std::uint32_t reversed(std::uint32_t word) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result |= (word >> bit & 1u) << (31 - bit);
  return result;
}

}  // namespace

int sobol_dims() { return static_cast<int>(Table::max_dimension); }

// Number k is m_k / 2^(k+1) with m_k odd, so that digit k is the last it can touch. In dimension 0 all m_k are 1. In
// the others the first m_k, as many as the polynomial x^q + a_1 x^(q−1) + … + a_(q−1) x + 1 has degrees, are the
// table's, and the rest follow from
//   m_k = m_(k−q) ⊕ 2^q m_(k−q) ⊕ 2^(q−1) a_(q−1) m_(k−q+1) ⊕ … ⊕ 2 a_1 m_(k−1)
// (P. Bratley & B. L. Fox, "Algorithm 659", 1988, section 2). The polynomial's bit j is the coefficient of x^j.
std::array<std::uint32_t, 32> sobol_directions(int dim) {
  assert_equal(0 <= dim && dim < sobol_dims(), true, "sobol_directions: a dimension of the table");
  std::array<std::uint32_t, kDigits> m;
  m.fill(1);
  if (dim > 0) {
    const auto row = static_cast<std::size_t>(dim - 1);
    const std::uint32_t polynomial = Table::polynomial(row);
    const auto degree = static_cast<std::size_t>(std::bit_width(polynomial)) - 1;
    for (std::size_t k = 0; k < degree; ++k) m[k] = Table::minit(row, k);
    for (std::size_t k = degree; k < m.size(); ++k) {
      m[k] = m[k - degree];
      for (std::size_t j = 0; j < degree; ++j) {
        if (polynomial >> j & 1u) m[k] ^= m[k - degree + j] << (degree - j);
      }
    }
  }
  for (std::size_t k = 0; k < m.size(); ++k) m[k] <<= 31 - k;
  return m;
}

std::optional<GeneratorMatrices> sobol_matrices(int dims, int digits) {
  if (dims < 1 || dims > sobol_dims() || digits < 1 || digits > kDigits) return std::nullopt;
  GeneratorMatrices matrices = {2, dims, digits, {}};
  for (int dim = 0; dim < dims; ++dim) {
    const auto directions = sobol_directions(dim);
    for (int row = 0; row < digits; ++row) {
      for (int column = 0; column < digits; ++column) {
        matrices.entries.push_back(directions[static_cast<std::size_t>(column)] >> (31 - row) & 1u);
      }
    }
  }
  return matrices;
}

void SobolSequence::reserve(int dims) {
  while (steps_.size() < static_cast<std::size_t>(dims)) {
    auto steps = sobol_directions(static_cast<int>(steps_.size()));
    for (std::size_t c = 0; c < steps.size(); ++c) {
      if (first_ == FirstDigit::kBottom) steps[c] = reversed(steps[c]);
      if (c > 0) steps[c] ^= steps[c - 1];
    }
    steps_.push_back(steps);
  }
}

std::uint32_t SobolSequence::at(int dim, std::uint64_t index) const {
  const auto& steps = steps_[static_cast<std::size_t>(dim)];
  std::uint32_t point = 0;
  // The steps that lead to index from 0 in Gray order: those at the changes between neighbouring bits.
  for (std::uint64_t changes = index ^ (index >> 1); changes > 0; changes &= changes - 1) {
    point ^= steps[static_cast<std::size_t>(std::countr_zero(changes))];
  }
  return point;
}

}  // namespace halfslope
