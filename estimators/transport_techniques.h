// The techniques of direct lighting and of a path's vertices. To add one: its line in each of the two lists here; a way
// to choose a light, in estimators/transport_choice.h; a way to draw a direction, in estimators/point.kernel.cpp.
#pragma once

#include <array>
#include <cstdint>

namespace halfslope {

enum class TransportTechnique : std::uint8_t {
  kLight,
  kBsdf,
  kHemisphere,
  kCosine,
  kSurface,
  kLightPower,
  kLightBvh,
  kLightSolidAngle,
  kLightPowerSolidAngle,
  kLightBvhSolidAngle
};

/// Their names, in the order in which estimators draw them.
inline constexpr std::array kTransportNames = {"light",
                                               "bsdf",
                                               "hemisphere",
                                               "cosine",
                                               "surface",
                                               "light-power",
                                               "light-bvh",
                                               "light-solid-angle",
                                               "light-power-solid-angle",
                                               "light-bvh-solid-angle"};
inline constexpr int kTransportTechniques = static_cast<int>(kTransportNames.size());

/// The ways to choose a light.
enum class LightChoice : std::uint8_t {
  kUniform,
  kPower,
  kBvh,
  kSurface  ///< a point of all surfaces alike, most of which do not emit
};

/// How points on lights are drawn.
struct LightWay {
  LightChoice choice = LightChoice::kUniform;
  bool by_solid_angle = false;
};

/// Whether the technique draws a direction, not a point.
constexpr bool is_directional(TransportTechnique technique) {
  return technique == TransportTechnique::kBsdf || technique == TransportTechnique::kHemisphere ||
         technique == TransportTechnique::kCosine;
}

/// Of a technique that draws points.
constexpr LightWay way_of(TransportTechnique technique) {
  switch (technique) {
    case TransportTechnique::kSurface:
      return {LightChoice::kSurface, false};
    case TransportTechnique::kLightPower:
      return {LightChoice::kPower, false};
    case TransportTechnique::kLightBvh:
      return {LightChoice::kBvh, false};
    case TransportTechnique::kLightSolidAngle:
      return {LightChoice::kUniform, true};
    case TransportTechnique::kLightPowerSolidAngle:
      return {LightChoice::kPower, true};
    case TransportTechnique::kLightBvhSolidAngle:
      return {LightChoice::kBvh, true};
    default:
      return {LightChoice::kUniform, false};
  }
}

}  // namespace halfslope
