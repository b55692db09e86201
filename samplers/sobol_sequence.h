// The Sobol' sequence as integers: what its samplers scramble, shift or leave alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/generator_matrices.h"
#include "samplers/kernels.h"

namespace halfslope {

/// Dimensions there are direction numbers for.
int sobol_dims();

/// The 32 direction numbers of dimension `dim` < sobol_dims(): number k is what bit k of the index exclusive-ors into
/// the point's 32 digits, the first one on top. The table is Boost's: S. Joe & F. Y. Kuo, "Constructing Sobol'
/// sequences with better two-dimensional projections" (2008), its polynomials below 2¹⁶.
std::array<std::uint32_t, 32> sobol_directions(int dim);

/// The generator matrices of the first 2^digits points; nothing beyond 32 digits or sobol_dims().
std::optional<GeneratorMatrices> sobol_matrices(int dims, int digits);

/// Points in natural order: bit k of the index selects direction number k, and index 0 is the origin.
class SobolSequence {
 public:
  /// Where a point's first digit stands in its word.
  enum class FirstDigit { kTop, kBottom };
  explicit SobolSequence(FirstDigit first = FirstDigit::kTop) : first_(first) {}

  /// Ready for `dims` dimensions; costs nothing where it is already.
  void reserve(int dims);
  /// The 32 digits of coordinate `dim` of point `index` < 2³².
  std::uint32_t at(int dim, std::uint64_t index) const;
  /// The coordinates `dim` of points `begin` < 2³¹ and following.
  SobolRun run(int dim, std::uint64_t begin) const {
    return {steps_[static_cast<std::size_t>(dim)].data(), static_cast<std::uint32_t>(begin), at(dim, begin)};
  }

 private:
  FirstDigit first_;
  /// [dim][c]: direction numbers 0 to c exclusive-ored. From an index that ends in c ones to the next one, bits 0 to c
  /// change, and so the point by this.
  std::vector<std::array<std::uint32_t, 32>> steps_;
};

}  // namespace halfslope
