#include <Random123/philox.h>
#if defined(__SSE2__) && !defined(HALFSLOPE_SCALAR_KERNELS)
#include <immintrin.h>
#endif

#include "core/point_block.h"
#include "samplers/kernel_functions.h"

namespace halfslope::kernel {
namespace {

// Words in 64-bit lanes whose upper halves are never looked at: the processor's 32 × 32 → 64 multiplication reads the
// lower halves only, so a round needs no shuffles at all. The compiler does not find this from plain loops.
#if defined(HALFSLOPE_SCALAR_KERNELS) || !defined(__SSE2__)
struct Lanes {
  std::uint64_t v;
};
constexpr int kLaneWidth = 1;
inline Lanes multiply(Lanes a, std::uint32_t b) { return {std::uint64_t{static_cast<std::uint32_t>(a.v)} * b}; }
inline Lanes upper(Lanes a) { return {a.v >> 32}; }
inline Lanes exclusive_or(Lanes a, Lanes b, std::uint32_t c) { return {a.v ^ b.v ^ c}; }
inline Lanes broadcast(std::uint32_t x) { return {x}; }
#elif defined(__AVX512F__)
struct Lanes {
  __m512i v;
};
constexpr int kLaneWidth = 8;
inline Lanes broadcast(std::uint32_t x) { return {_mm512_set1_epi64(x)}; }
inline Lanes multiply(Lanes a, std::uint32_t b) { return {_mm512_mul_epu32(a.v, broadcast(b).v)}; }
inline Lanes upper(Lanes a) { return {_mm512_srli_epi64(a.v, 32)}; }
inline Lanes exclusive_or(Lanes a, Lanes b, std::uint32_t c) {
  return {_mm512_ternarylogic_epi64(a.v, b.v, broadcast(c).v, 0x96)};
}
#elif defined(__AVX2__)
struct Lanes {
  __m256i v;
};
constexpr int kLaneWidth = 4;
inline Lanes broadcast(std::uint32_t x) { return {_mm256_set1_epi64x(x)}; }
inline Lanes multiply(Lanes a, std::uint32_t b) { return {_mm256_mul_epu32(a.v, broadcast(b).v)}; }
inline Lanes upper(Lanes a) { return {_mm256_srli_epi64(a.v, 32)}; }
inline Lanes exclusive_or(Lanes a, Lanes b, std::uint32_t c) {
  return {_mm256_xor_si256(_mm256_xor_si256(a.v, b.v), broadcast(c).v)};
}
#else
struct Lanes {
  __m128i v;
};
constexpr int kLaneWidth = 2;
inline Lanes broadcast(std::uint32_t x) { return {_mm_set1_epi64x(x)}; }
inline Lanes multiply(Lanes a, std::uint32_t b) { return {_mm_mul_epu32(a.v, broadcast(b).v)}; }
inline Lanes upper(Lanes a) { return {_mm_srli_epi64(a.v, 32)}; }
inline Lanes exclusive_or(Lanes a, Lanes b, std::uint32_t c) {
  return {_mm_xor_si128(_mm_xor_si128(a.v, b.v), broadcast(c).v)};
}
#endif
constexpr int kParts = kLanes / kLaneWidth;

// Ten rounds of Philox 4×32 (Salmon and others 2011) over kLanes counters at once; words[w][l] receives word w of lane
// l in the lower half. tests/samplers/independent_test.cpp holds it against Random123's own function.
inline void philox(const WordStream& stream, std::uint32_t tag, std::uint32_t index,
                   std::uint64_t (&words)[4][kLanes]) {
  alignas(64) std::uint64_t replicates[kLanes];
  for (int l = 0; l < kLanes; ++l) replicates[l] = stream.replicate + static_cast<std::uint32_t>(l);
  Lanes c[4][kParts];
  for (int part = 0; part < kParts; ++part) {
    c[0][part] = broadcast(index);
    __builtin_memcpy(&c[1][part], replicates + part * kLaneWidth, sizeof(Lanes));
    c[2][part] = broadcast(stream.pixel);
    c[3][part] = broadcast(tag);
  }
  std::uint32_t k0 = stream.key0, k1 = stream.key1;
  for (int round = 0; round < 10; ++round) {
    for (int part = 0; part < kParts; ++part) {
      const Lanes p0 = multiply(c[0][part], PHILOX_M4x32_0), p1 = multiply(c[2][part], PHILOX_M4x32_1);
      c[0][part] = exclusive_or(upper(p1), c[1][part], k0);
      c[1][part] = p1;
      c[2][part] = exclusive_or(upper(p0), c[3][part], k1);
      c[3][part] = p0;
    }
    k0 += PHILOX_W32_0;
    k1 += PHILOX_W32_1;
  }
  for (int w = 0; w < 4; ++w) {
    for (int part = 0; part < kParts; ++part)
      __builtin_memcpy(words[w] + part * kLaneWidth, &c[w][part], sizeof(Lanes));
  }
}

}  // namespace

void random_words(const WordStream& stream, std::uint32_t draw, std::uint32_t dim, std::uint32_t begin, int count,
                  int shift, std::uint32_t* out) {
  const std::uint32_t tag = dim | (draw << 28), end = begin + static_cast<std::uint32_t>(count);
  for (std::uint32_t first = begin & ~3u; first < end; first += 4) {
    alignas(64) std::uint64_t words[4][kLanes];
    philox(stream, tag, first / 4, words);
    for (std::uint32_t w = 0; w < 4; ++w) {
      const std::uint32_t index = first + w;
      if (index < begin || index >= end) continue;
      std::uint32_t* row = out + static_cast<std::size_t>(index - begin) * kLanes;
      for (int l = 0; l < kLanes; ++l) row[l] = static_cast<std::uint32_t>(words[w][l]) >> shift;
    }
  }
}

}  // namespace halfslope::kernel
