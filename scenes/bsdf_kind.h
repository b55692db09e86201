#pragma once

#include <cstdint>

namespace halfslope {

enum class BsdfKind : std::uint8_t { kDiffuse, kRoughConductor, kPhong };

}  // namespace halfslope
