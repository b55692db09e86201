// A rendered scene as integrals: direct light reflected at the point each pixel sees.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/local_pixel.h"
#include "estimators/transport_data.h"
#include "scenes/scene.h"

namespace halfslope {

/// Direct light at the point that each pixel's centre shows, through the middle of the lens. The techniques are
///   light          a light chosen uniformly, then a point uniform on its area;
///   bsdf           the BSDF's own density;
///   hemisphere     uniform directions; over the sphere where surfaces let light through;
///   cosine         by the cosine with the normal;
///   surface        uniform over the area of all surfaces; not in scenes with an environment, which it cannot find;
///   light-power, light-bvh
///                  as light, with lights chosen in proportion to their power, or by a tree of lights;
///   light-solid-angle, light-power-solid-angle, light-bvh-solid-angle
///                  as those, with points uniform in solid angle on rectangles, triangles and spheres;
/// all with densities in solid angle. Where only one direction could bring light (delta lobes, delta lights) it is
/// added as a constant. Plain scenes (scenes/scene.h) have kernels of their own for the first five.
class DirectLighting final : public IntegralSource {
 public:
  /// Throws Error(kBadInput) for a scene without light.
  DirectLighting(Scene scene, int width, int height);

  int width() const override { return width_; }
  int height() const override { return height_; }
  bool takes_resolution() const override { return scene_.sensor.kind != Sensor::Kind::kRays; }
  int channels() const override { return channels_; }
  std::span<const Technique> techniques() const override { return techniques_; }
  std::vector<int> reference_techniques() const override { return {0, 1}; }  ///< light and bsdf
  /// Known where the point is diffuse and no light that reaches it can be shaded, if scenes/closed_form.h has each
  /// light's form factor.
  std::optional<Color> closed_form(int pixel) const override;
  PixelIntegral pixel(int index) const override;
  std::vector<std::string> regions() const override;
  int region(int pixel) const override;
  std::vector<std::string> skips() const override;
  std::string fingerprint() const override;

 private:
  Ray ray(int pixel) const { return scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_); }
  Hit hit(int pixel) const;
  bool sees_constant(const Hit& hit) const;
  Color emitted(const Hit& hit) const;
  PixelIntegral general_pixel(int index) const;
  bool splits_regions() const;
  std::vector<std::string> plain_skips() const;
  std::vector<std::string> general_skips() const;

  Scene scene_;
  bool plain_;
  Emitters emitters_;  ///< of a plain scene
  int width_, height_, channels_;
  Intersector intersector_;
  Tracing tracing_;
  LazyTransport transport_;
  std::vector<Technique> techniques_;
  std::vector<TransportTechnique> meanings_;  ///< of techniques_
  std::vector<int> lights_;                   ///< the primitives that emit
};

}  // namespace halfslope
