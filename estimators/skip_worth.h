// What a skip is worth: how many times as fast a pass of light and BSDF samples is with it. The plan says these
// numbers, and benchmarks/skips_benchmark.cpp measures them beside one another; each stands well below what was
// measured (docs/performance.md).
#pragma once

#include <fmt/format.h>

#include <string>

namespace halfslope {

/// One channel instead of three.
inline constexpr double kWorthOneChannel = 1.1;
/// No choice among lights, of which there is one.
inline constexpr double kWorthNoLightChoice = 1.03;
/// No shadow rays, past a single small shape; every further shape adds to it.
inline constexpr double kWorthNoShadowRay = 1.01;
/// No densities of techniques that the estimator does not use: two instead of five.
inline constexpr double kWorthNoUnusedTechniques = 1.03;
/// Three heuristics from one pass instead of a pass each.
inline constexpr double kWorthSharedPass = 2;

/// What a line of the plan says of it.
inline std::string worth(double factor) { return fmt::format(" (at least {} times as fast)", factor); }

}  // namespace halfslope
