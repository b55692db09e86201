// Direct light at one point, as an integral for the kernels.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/integral.h"
#include "estimators/local_pixel.h"
#include "estimators/seen_point.h"
#include "estimators/transport_data.h"

namespace halfslope {

/// What the integrals of one source share. All outlive them.
struct LightingSource {
  const Scene& scene;
  const LazyTransport& transport;
  const std::vector<Technique>& techniques;
  const std::vector<TransportTechnique>& meanings;  ///< of the techniques
  int channels;
};

/// At a point of any scene, by the transport kernels.
std::unique_ptr<Integral> light_at(const LightingSource& source, const StartPoint<double>& start);

/// At a point of a plain scene: by kernels of its own where the techniques of a call all have them. `start` makes the
/// point for the transport kernels, where it is needed.
std::unique_ptr<Integral> plain_light_at(const LightingSource& source, const Emitters& emitters,
                                         const Receiver& receiver, const Ray& ray, const Tracing& tracing);

}  // namespace halfslope
