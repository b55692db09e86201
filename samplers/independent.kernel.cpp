#include <Random123/philox.h>

#include "core/point_block.h"
#include "samplers/kernel_functions.h"

namespace halfslope::kernel {
namespace {

// Ten rounds of Philox 4×32 over kLanes counters at once, in plain loops: the compiler's vectors match hand-written
// ones here. tests/samplers/independent_test.cpp holds it against Random123's own function.
inline void philox(const WordStream& stream, std::uint32_t tag, std::uint32_t index, std::uint32_t (&c)[4][kLanes]) {
  for (int l = 0; l < kLanes; ++l) {
    c[0][l] = index;
    c[1][l] = stream.replicate + static_cast<std::uint32_t>(l);
    c[2][l] = stream.pixel;
    c[3][l] = tag;
  }
  std::uint32_t k0 = stream.key0, k1 = stream.key1;
  for (int round = 0; round < 10; ++round) {
    for (int l = 0; l < kLanes; ++l) {
      const std::uint64_t p0 = std::uint64_t{PHILOX_M4x32_0} * c[0][l];
      const std::uint64_t p1 = std::uint64_t{PHILOX_M4x32_1} * c[2][l];
      c[0][l] = static_cast<std::uint32_t>(p1 >> 32) ^ c[1][l] ^ k0;
      c[1][l] = static_cast<std::uint32_t>(p1);
      c[2][l] = static_cast<std::uint32_t>(p0 >> 32) ^ c[3][l] ^ k1;
      c[3][l] = static_cast<std::uint32_t>(p0);
    }
    k0 += PHILOX_W32_0;
    k1 += PHILOX_W32_1;
  }
}

}  // namespace

void random_words(const WordStream& stream, std::uint32_t draw, std::uint32_t dim, std::uint32_t begin, int count,
                  int shift, std::uint32_t* out) {
  const std::uint32_t tag = dim | (draw << 28), end = begin + static_cast<std::uint32_t>(count);
  for (std::uint32_t first = begin & ~3u; first < end; first += 4) {
    std::uint32_t words[4][kLanes];
    philox(stream, tag, first / 4, words);
    for (std::uint32_t w = 0; w < 4; ++w) {
      const std::uint32_t index = first + w;
      if (index < begin || index >= end) continue;
      std::uint32_t* row = out + static_cast<std::size_t>(index - begin) * kLanes;
      for (int l = 0; l < kLanes; ++l) row[l] = words[w][l] >> shift;
    }
  }
}

}  // namespace halfslope::kernel
