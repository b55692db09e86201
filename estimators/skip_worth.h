// What a skip is worth: how many times as fast a pass of light and BSDF samples is with it. The plan says these
// numbers, and benchmarks/skips_benchmark.cpp measures them beside one another; each stands well below what was
// measured (docs/performance.md).
#pragma once

namespace halfslope {

/// One channel instead of three.
inline constexpr double kWorthOneChannel = 1.1;
/// No choice among lights, of which there is one.
inline constexpr double kWorthNoLightChoice = 1.05;
/// No shadow rays past one shape.
inline constexpr double kWorthNoShadowRay = 1.03;
/// No densities of techniques that the estimator does not use: two instead of five.
inline constexpr double kWorthNoUnusedTechniques = 1.03;
/// Three heuristics from one pass instead of a pass each.
inline constexpr double kWorthSharedPass = 2;

}  // namespace halfslope
