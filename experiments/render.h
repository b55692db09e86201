// One replicate of one estimator at one N, as a picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/estimator.h"
#include "experiments/catalogue.h"
#include "experiments/spec.h"

namespace halfslope {

struct RenderSettings {
  Estimator estimator;
  std::string sampler;
  std::uint64_t samples = 64, seed = 1;
  std::uint32_t replicate = 0;
  Precision precision = Precision::kF32;
  int threads = 0;  ///< 0: every core; the picture does not depend on it
  bool quiet = false;
  std::string label;  ///< of the progress
};

/// How a command spells the flags that errors name.
struct RenderFlags {
  const char* estimator = "--estimator";
  const char* sampler = "--sampler";
};

/// The estimator of that name on the scene (empty: `balance`, or an integrand's only technique), after checking that
/// the settings' sampler has its dimensions and its N is legal. Throws Error(kUsage) that begins with the flag at
/// fault.
Estimator check_render(const IntegralSource& source, const std::string& estimator, const RenderSettings& settings,
                       const Catalogue& catalogue, const RenderFlags& flags = {});

/// The estimates of every pixel: width × height × channels, rows from the top. The settings must have been checked.
/// Throws Error(kInterrupted) where a signal came meanwhile (experiments/interrupt.h).
std::vector<double> render_replicate(const IntegralSource& source, const RenderSettings& settings,
                                     const Catalogue& catalogue);

}  // namespace halfslope
