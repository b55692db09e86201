// Lanes that read entries of their own from an array of structs.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/packet.h"
#include "core/point_block.h"

namespace halfslope {

/// A number of each lane's own: base[index].
template <class F>
inline F gather(const scalar_t<F>* base, const std::int32_t* index) {
  alignas(64) scalar_t<F> lanes[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) lanes[l] = base[index[l]];
  return load<F>(lanes);
}

namespace gather_detail {

/// kCount numbers side by side, as the compiler's own vectors, which it shuffles with what the target has.
template <class T, int kCount>
struct Row {
  using type [[gnu::vector_size(kCount * sizeof(T))]] = T;
};
template <class T, int kCount>
using row_t = typename Row<T, kCount>::type;

template <class T, int kCount, int... kIndex>
inline row_t<T, 2 * kCount> joined(const row_t<T, kCount>& a, const row_t<T, kCount>& b,
                                   std::integer_sequence<int, kIndex...>) {
  return __builtin_shufflevector(a, b, kIndex...);
}

/// The entries of lanes first, first + 4, first + 8 … < kWidth side by side.
template <class T, int kWidth>
inline row_t<T, kWidth> every_fourth(const row_t<T, 4>* quads, int first) {
  if constexpr (kWidth == 4) {
    return quads[first];
  } else {
    constexpr int kHalf = kWidth / 2;
    return joined<T, kHalf>(every_fourth<T, kHalf>(quads, first), every_fourth<T, kHalf>(quads, first + kHalf),
                            std::make_integer_sequence<int, kWidth>{});
  }
}

/// In each four of the lanes: kPairs ? (a₀ a₁ b₀ b₁) : (a₀ b₀ a₁ b₁), from number `kFrom` on.
template <class T, int kWidth, bool kPairs, int kFrom, int... kIndex>
inline row_t<T, kWidth> mixed(const row_t<T, kWidth>& a, const row_t<T, kWidth>& b,
                              std::integer_sequence<int, kIndex...>) {
  constexpr auto from = [](int i) {
    const int four = i & ~3, within = i & 3;
    return kPairs ? four + kFrom + (within & 1) + (within >> 1) * kWidth
                  : four + kFrom + (within >> 1) + (within & 1) * kWidth;
  };
  return __builtin_shufflevector(a, b, from(kIndex)...);
}

/// out[k] is number k of every lane, of quads of numbers one for each lane: squares of 4 × 4 are transposed.
template <class T, int kWidth>
inline void transpose(const row_t<T, 4>* quads, row_t<T, kWidth>* out) {
  constexpr std::make_integer_sequence<int, kWidth> all{};
  const row_t<T, kWidth> a = every_fourth<T, kWidth>(quads, 0), b = every_fourth<T, kWidth>(quads, 1),
                         c = every_fourth<T, kWidth>(quads, 2), d = every_fourth<T, kWidth>(quads, 3);
  const row_t<T, kWidth> low_ab = mixed<T, kWidth, false, 0>(a, b, all), low_cd = mixed<T, kWidth, false, 0>(c, d, all),
                         high_ab = mixed<T, kWidth, false, 2>(a, b, all),
                         high_cd = mixed<T, kWidth, false, 2>(c, d, all);
  out[0] = mixed<T, kWidth, true, 0>(low_ab, low_cd, all);
  out[1] = mixed<T, kWidth, true, 2>(low_ab, low_cd, all);
  out[2] = mixed<T, kWidth, true, 0>(high_ab, high_cd, all);
  out[3] = mixed<T, kWidth, true, 2>(high_ab, high_cd, all);
}

}  // namespace gather_detail

/// Four numbers in a row of each of kWidth entries, which lie `stride` bytes apart: out[k · kLanes + l] is number k of
/// entry index[l].
template <class T, int kWidth>
inline void gather_quads(const void* base, std::size_t stride, const std::int32_t* index, T* out) {
  const auto* bytes = static_cast<const char*>(base);
  if constexpr (kWidth < 4) {
    for (int l = 0; l < kWidth; ++l) {
      T quad[4];
      std::memcpy(quad, bytes + static_cast<std::size_t>(index[l]) * stride, sizeof quad);
      for (int k = 0; k < 4; ++k) out[k * kLanes + l] = quad[k];
    }
  } else {
    using gather_detail::row_t;
    row_t<T, 4> quads[kWidth];
    for (int l = 0; l < kWidth; ++l) {
      std::memcpy(&quads[l], bytes + static_cast<std::size_t>(index[l]) * stride, sizeof quads[l]);
    }
    row_t<T, kWidth> rows[4];
    gather_detail::transpose<T, kWidth>(quads, rows);
    for (int k = 0; k < 4; ++k) std::memcpy(out + k * kLanes, &rows[k], sizeof rows[k]);
  }
}

/// Entries of an array, one for each lane, by their fields. Entries of four numbers or more.
template <class F, class Entry>
class LaneEntries {
 public:
  using T = scalar_t<F>;
  LaneEntries(const Entry* entries, const std::int32_t* index) : entries_(entries), index_(index) {
    std::int32_t other = 0;
    for (int l = 1; l < kWidth<F>; ++l) other |= index[l] ^ index[0];
    same_ = other == 0;
  }

  F operator()(T Entry::*field) const {
    if (same_) return F(entries_[index_[0]].*field);
    alignas(64) T lanes[kLanes];
    for (int l = 0; l < kWidth<F>; ++l) lanes[l] = entries_[index_[l]].*field;
    return load<F>(lanes);
  }

  /// The first kCount numbers of an array.
  template <int kSize, int kCount>
  void operator()(T (Entry::*field)[kSize], F (&out)[kCount]) const {
    static_assert(kCount <= kSize);
    if (same_) {
      for (int k = 0; k < kCount; ++k) out[k] = F((entries_[index_[0]].*field)[k]);
      return;
    }
    if constexpr (kCount == 1) {
      alignas(64) T lanes[kLanes];
      for (int l = 0; l < kWidth<F>; ++l) lanes[l] = (entries_[index_[l]].*field)[0];
      out[0] = load<F>(lanes);
      return;
    }
    const std::size_t begin = offset(field);
    for (int done = 0; done < kCount; done += 4) {
      // The last quad ends with the entry at the latest.
      const std::size_t wanted = begin + static_cast<std::size_t>(done) * sizeof(T);
      const std::size_t from = std::min(wanted, kLastQuad);
      const auto skipped = static_cast<int>((wanted - from) / sizeof(T));
      alignas(64) T quads[4 * kLanes];
      gather_quads<T, kWidth<F>>(reinterpret_cast<const char*>(entries_) + from, sizeof(Entry), index_, quads);
      for (int k = done; k < std::min(kCount, done + 4); ++k) {
        out[k] = load<F>(quads + (k - done + skipped) * kLanes);
      }
    }
  }

  /// Whether all lanes have one entry.
  bool same() const { return same_; }

 private:
  static constexpr std::size_t kLastQuad = sizeof(Entry) / sizeof(T) * sizeof(T) - 4 * sizeof(T);
  template <int kSize>
  std::size_t offset(T (Entry::*field)[kSize]) const {
    return static_cast<std::size_t>(reinterpret_cast<const char*>(&(entries_->*field)) -
                                    reinterpret_cast<const char*>(entries_));
  }

  const Entry* entries_;
  const std::int32_t* index_;
  bool same_;
};

}  // namespace halfslope
