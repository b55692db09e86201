// Distances of points on the unit torus, in 32-bit fixed point.
#pragma once

#include <cstdint>

namespace halfslope {

struct TorusPoint {
  std::uint32_t x, y;
};

/// 2⁶⁴ times the squared distance, exactly: differences of high words wrap around as the torus does, and each is at
/// most 2³¹.
inline std::uint64_t squared_distance(TorusPoint a, TorusPoint b) {
  const auto dx = std::int64_t{static_cast<std::int32_t>(a.x - b.x)};
  const auto dy = std::int64_t{static_cast<std::int32_t>(a.y - b.y)};
  return static_cast<std::uint64_t>(dx * dx) + static_cast<std::uint64_t>(dy * dy);
}

}  // namespace halfslope
