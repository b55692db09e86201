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

/// A small number for each pair of them.
constexpr std::int32_t bsdf_class(BsdfKind kind, Distribution distribution) {
  return 2 * static_cast<std::int32_t>(kind) + static_cast<std::int32_t>(distribution);
}
constexpr BsdfKind kind_of_class(std::int32_t bsdf_class) { return static_cast<BsdfKind>(bsdf_class / 2); }
constexpr Distribution distribution_of_class(std::int32_t bsdf_class) {
  return static_cast<Distribution>(bsdf_class % 2);
}

}  // namespace halfslope
