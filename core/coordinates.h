// From fixed-point coordinates to the numbers that kernels compute with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace halfslope {

/// high · 2⁻³² + low · 2⁻⁵³: binary32 takes the top 24 bits, binary64 all 53; exact, and never 1. `low` may be null.
template <class T>
inline void to_coordinates(const std::uint32_t* __restrict high, const std::uint32_t* __restrict low, std::size_t count,
                           T* __restrict out) {
  if constexpr (std::is_same_v<T, float>) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<float>(static_cast<std::int32_t>(high[i] >> 8)) * 0x1p-24f;
  } else if (low) {
    for (std::size_t i = 0; i < count; ++i) out[i] = high[i] * 0x1p-32 + low[i] * 0x1p-53;
  } else {
    for (std::size_t i = 0; i < count; ++i) out[i] = high[i] * 0x1p-32;
  }
}

/// ⌊x · choices⌋ for the coordinate x, in integers so that the last choice is never passed.
template <class T>
inline void to_choices(const std::uint32_t* __restrict high, std::uint32_t choices, std::size_t count,
                       T* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<T>(static_cast<std::int32_t>((static_cast<std::uint64_t>(high[i]) * choices) >> 32));
  }
}

}  // namespace halfslope
