// Owen-scrambled Halton points (A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995), kLanes
// replicates at a time.
//
// Nested scrambling permutes the digit a_k of index i by a permutation that belongs to the node (k, a_0 … a_{k−1}) of
// the tree of digits. Here a node's permutation is a ↦ g + h·a (mod b) with g uniform on 0 … b−1 and h uniform on 1 …
// b−1, independent between nodes. For prime b any two digits go to a uniform pair of distinct digits, which is all that
// the variance of a scrambled point set depends on (J. Matoušek, "On the L2-discrepancy for anchored boxes", 1998, §2;
// A. B. Owen, "Variance with alternative scramblings of digital nets", 2003), so it equals full nested scrambling's.
//
// The infinite tail needs no digits at all. Write j for an index and t for its number of digits. On the path of zeros
// that leaves j, the digits g of the nodes (t, j), (t+1, j), … are independent and uniform, that is, they are the
// base-b digits of one uniform number U(j). So the point is x_j = (first t digits) + b^−t U(j), and for an index i = j
// + a·b^k with top digit a at place k ≥ t, the first k digits of x_i are those of x_j, and its digit k is g + h·a (mod
// b), where g is the digit k of x_j. Each point thus costs one step from its parent j and two hashes, whatever the
// depth.
#include <algorithm>
#include <array>

#include "core/point_block.h"
#include "samplers/kernel_functions.h"
#include "samplers/keyed_hash.h"

namespace halfslope::kernel {
namespace {

// (digits + (u + ½)/2³²) / b^{k+1} strictly inside its interval of length b^−(k+1), cut to 53 bits too: the half keeps
// it 2⁻³³ / b^{k+1} from the interval's ends, which up to b^{k+1} = 2¹⁸ is 4 · 2⁻⁵³, and the two roundings (of
// 1/b^{k+1} and of the product) and the cut move it by less than 2.5 · 2⁻⁵³. Beyond 2¹⁸, u gives up its lowest bits
// instead.
struct Level {
  double width;    // b^{k+1}
  double inverse;  // 1 / b^{k+1}
  int drop;        // low bits of u that binary64 has no room for
  double scale;    // 2^(drop − 32)
};

inline Level make_level(double width) {
  int drop = 0;
  for (double w = width; w > 0x1p18; w *= 0.5) ++drop;
  double scale = 0x1p-32;
  for (int i = 0; i < drop; ++i) scale *= 2;
  return {width, 1 / width, drop, scale};
}

// x of the points j + a·b^k in all lanes, from those of j; `index` is j + a·b^k.
inline void step(std::uint32_t base, const Level& level, std::uint32_t k, std::uint32_t parent, std::uint32_t a,
                 std::uint32_t index, const std::uint32_t* __restrict keys, const double* __restrict from,
                 double* __restrict to) {
  const double b = base, inverse_b = 1.0 / base;
  const std::uint32_t node = parent * 0x9e3779b1u + k * 0x85ebca77u;
  for (int l = 0; l < kLanes; ++l) {
    // The parent stands clear of all interval ends up to b^{k+1} = 2¹⁸ (see Level), so the product's rounding cannot
    // change its digits; beyond, one point in 2⁵³ / b^{k+1} lies so near an end that it may take its neighbour's digit.
    const auto digits = static_cast<std::int32_t>(from[l] * level.width);
    const auto above = static_cast<std::int32_t>((digits + 0.5) * inverse_b);
    const std::int32_t g = digits - above * static_cast<std::int32_t>(base);
    const std::uint32_t h =
        1 + static_cast<std::uint32_t>(
                (std::uint64_t{keyed_word(node, keys[2 * kLanes + l], keys[3 * kLanes + l])} * (base - 1)) >> 32);
    const auto sum = static_cast<std::int32_t>(static_cast<std::uint32_t>(g) + h * a);
    const auto quotient = static_cast<std::int32_t>((sum + 0.5) * inverse_b);
    const double digit = sum - quotient * b;
    const std::uint32_t u = keyed_word(index, keys[l], keys[kLanes + l]) >> level.drop;
    const double fraction =
        (static_cast<std::int32_t>(u >> 1) * 2.0 + static_cast<std::int32_t>(u & 1) + 0.5) * level.scale;
    to[l] = (above * b + digit + fraction) * level.inverse;
  }
}

inline void origin(const std::uint32_t* __restrict keys, double* __restrict to) {
  for (int l = 0; l < kLanes; ++l) {
    const std::uint32_t u = keyed_word(0, keys[l], keys[kLanes + l]);
    to[l] = (static_cast<std::int32_t>(u >> 1) * 2.0 + static_cast<std::int32_t>(u & 1) + 0.5) * 0x1p-32;
  }
}

}  // namespace

void halton_owen_table(std::uint32_t base, const std::uint32_t* keys, std::uint32_t count, double* out) {
  origin(keys, out);
  std::uint32_t k = 0;
  for (std::uint64_t power = 1; power < count; power *= base, ++k) {
    const Level level = make_level(static_cast<double>(power * base));
    for (std::uint32_t a = 1; a < base; ++a) {
      for (std::uint32_t j = 0; j < power && j + a * power < count; ++j) {
        const auto index = static_cast<std::uint32_t>(j + a * power);
        step(base, level, k, j, a, index, keys, out + std::size_t{j} * kLanes, out + std::size_t{index} * kLanes);
      }
    }
  }
}

void halton_owen(const HaltonDim& dim, const std::uint32_t* indices, int count, std::uint32_t* high,
                 std::uint32_t* low) {
  // Powers of the base above the table, and the constants of each place.
  std::array<Level, 32> levels;
  std::array<std::uint64_t, 33> powers;
  std::uint64_t power = 1;
  for (std::uint32_t k = 0; k < dim.table_digits; ++k) power *= dim.base;
  const std::uint64_t last = *std::max_element(indices, indices + count);
  std::size_t places = 0;
  for (; power <= last; power *= dim.base, ++places) {
    powers[places] = power;
    levels[places] = make_level(static_cast<double>(power * dim.base));
  }
  powers[places] = power;

  for (int s = 0; s < count; ++s) {
    const std::uint32_t i = indices[s];
    alignas(64) double x[kLanes];
    const std::uint64_t tabled = places ? powers[0] : power;
    const double* start = dim.table + static_cast<std::size_t>(i % tabled) * kLanes;
    for (int l = 0; l < kLanes; ++l) x[l] = start[l];
    for (std::size_t p = 0; p < places; ++p) {
      const auto a = static_cast<std::uint32_t>(i / powers[p] % dim.base);
      if (a == 0) continue;
      const auto parent = static_cast<std::uint32_t>(i % powers[p]);
      const auto index = static_cast<std::uint32_t>(parent + a * powers[p]);
      alignas(64) double next[kLanes];
      step(dim.base, levels[p], dim.table_digits + static_cast<std::uint32_t>(p), parent, a, index, dim.keys, x, next);
      for (int l = 0; l < kLanes; ++l) x[l] = next[l];
    }
    std::uint32_t* row = high + s * kLanes;
    // Two steps of 16 bits: conversions from binary64 to unsigned words are slow before AVX-512, to signed ones are
    // not.
    for (int l = 0; l < kLanes; ++l) {
      const double scaled = x[l] * 0x1p16;
      const auto upper = static_cast<std::int32_t>(scaled);
      const auto lower = static_cast<std::int32_t>((scaled - upper) * 0x1p16);
      row[l] = (static_cast<std::uint32_t>(upper) << 16) | static_cast<std::uint32_t>(lower);
    }
    if (low) {
      std::uint32_t* low_row = low + s * kLanes;
      for (int l = 0; l < kLanes; ++l) {
        const double scaled = x[l] * 0x1p16;
        const double rest = (scaled - static_cast<std::int32_t>(scaled)) * 0x1p16;
        low_row[l] =
            static_cast<std::uint32_t>(static_cast<std::int32_t>((rest - static_cast<std::int32_t>(rest)) * 0x1p21));
      }
    }
  }
}

}  // namespace halfslope::kernel
