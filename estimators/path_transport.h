// A rendered scene as integrals over paths: all the light that reaches each pixel, to a greatest depth.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/transport_data.h"
#include "scenes/scene.h"

namespace halfslope {

/// How far paths go, in Mitsuba's count of depths: at 1 the eye sees emitters alone, at 2 light that was scattered
/// once.
struct PathOptions {
  int max_depth = 8;  ///< 1 to kMostDepth
  int rr_depth = 0;   ///< Russian roulette decides whether a path of this depth or more goes on; 0: none

  bool operator==(const PathOptions&) const = default;
};
inline constexpr int kMostDepth = 128;

/// The pixels of a scene as integrals over its paths, over the film by its reconstruction filter and over the lens. Its
/// techniques are those of one vertex: the light techniques (a light chosen uniformly, by power or by a light BVH; a
/// point on it by area or by solid angle), and last `bsdf`.
class PathTransport final : public IntegralSource {
 public:
  /// Throws Error(kBadInput) for a scene without light.
  PathTransport(Scene scene, int width, int height, const PathOptions& options);

  int width() const override { return width_; }
  int height() const override { return height_; }
  bool takes_resolution() const override { return scene_.sensor.kind != Sensor::Kind::kRays; }
  int channels() const override { return channels_; }
  std::span<const Technique> techniques() const override { return techniques_; }
  std::vector<int> reference_techniques() const override;
  const PathShape* path() const override { return &shape_; }
  PixelIntegral pixel(int index) const override;
  std::vector<std::string> regions() const override;
  int region(int pixel) const override;
  std::vector<std::string> skips() const override;
  std::string fingerprint() const override;

 private:
  Scene scene_;
  int width_, height_, channels_;
  PathOptions options_;
  Intersector intersector_;
  Tracing tracing_;
  std::vector<Technique> techniques_;
  PathShape shape_;
  PathDims dims_;              ///< of shape_ and the techniques' layouts
  std::vector<float> filter_;  ///< inverse distribution function of the reconstruction filter; empty: none
  bool chooses_;               ///< whether BSDFs draw a number to choose between lobes
  LazyTransport transport_;
};

}  // namespace halfslope
