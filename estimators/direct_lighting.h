// A rendered scene as integrals: direct light reflected at the point each pixel sees.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/local_pixel.h"
#include "scenes/scene.h"

namespace halfslope {

/// The pixels of a rendered scene under the techniques `light` (a light chosen uniformly, then a point uniform on its
/// area), `bsdf` (the BSDF's own density), `hemisphere` (uniform directions), `cosine` (by the cosine with the normal)
/// and `surface` (uniform over the area of all surfaces), all with densities in solid angle.
class DirectLighting final : public IntegralSource {
 public:
  /// Throws Error(kBadInput) for a scene without an emitter.
  DirectLighting(Scene scene, int width, int height);

  int width() const override { return width_; }
  int height() const override { return height_; }
  bool takes_resolution() const override { return scene_.sensor.kind == Sensor::Kind::kPerspective; }
  int channels() const override { return channels_; }
  std::span<const Technique> techniques() const override { return techniques_; }
  std::size_t reference_techniques() const override { return 2; }  ///< light and bsdf
  /// Known where the point is diffuse and no light that reaches it can be shaded, if scenes/closed_form.h has each
  /// light's form factor.
  std::optional<Color> closed_form(int pixel) const override;
  PixelIntegral pixel(int index) const override;
  std::vector<std::string> regions() const override;
  int region(int pixel) const override;
  std::vector<std::string> skips() const override;
  std::string fingerprint() const override;

 private:
  Hit hit(int pixel) const;
  bool sees_constant(const Hit& hit) const;
  Color emitted(const Hit& hit) const;

  Scene scene_;
  Emitters emitters_;
  int width_, height_, channels_;
  std::vector<Technique> techniques_;
};

}  // namespace halfslope
