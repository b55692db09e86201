#pragma once

#include <cstdint>

namespace halfslope {

enum class BsdfKind : std::uint8_t {
  kDiffuse,
  kRoughConductor,
  kPhong,
  kConductor,
  kPlastic,
  kRoughPlastic,
  kDielectric,
  kRoughDielectric
};

/// Microfacet distributions.
enum class Distribution : std::uint8_t { kGgx, kBeckmann };

}  // namespace halfslope
