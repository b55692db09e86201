// A rendered scene as integrals: direct light reflected at the point each pixel sees.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/pixel_data.h"
#include "scenes/scene.h"

namespace halfslope {

/// The pixels of a rendered scene under the techniques `light` (a light chosen uniformly, then a point uniform on its
/// area) and `bsdf` (the BSDF's own density), both with densities in solid angle.
class DirectLighting final : public IntegralSource {
 public:
  /// Throws Error(kBadInput) for a scene without an emitter.
  DirectLighting(Scene scene, int width, int height);

  int width() const override { return width_; }
  int height() const override { return height_; }
  int channels() const override { return channels_; }
  std::span<const Technique> techniques() const override { return techniques_; }
  PixelIntegral pixel(int index) const override;
  std::vector<std::string> regions() const override;
  int region(int pixel) const override;
  std::vector<std::string> skips() const override;
  std::string fingerprint() const override;

 private:
  Hit hit(int pixel) const;
  bool sees_constant(const Hit& hit) const;

  Scene scene_;
  int width_, height_, channels_;
  std::vector<int> lights_;  ///< indices of the emitting primitives
  std::vector<Technique> techniques_;
};

}  // namespace halfslope
