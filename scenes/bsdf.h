// What surfaces are made of, as data.
#pragma once

#include <memory>
#include <optional>

#include "scenes/bsdf_kind.h"
#include "scenes/texture.h"

namespace halfslope {

/// How a surface scatters light. All kinds but the dielectrics are one-sided: they reflect only where both directions
/// are on the front, unless a Primitive has them on its back as well.
///
/// Of each colour with a texture, the plain colour beside it is the texture's mean.
struct Bsdf {
  BsdfKind kind = BsdfKind::kDiffuse;
  Rgb reflectance = Rgb::Constant(0.5);    ///< the diffuse albedo, or a conductor's specular_reflectance
  double alpha = 0.1;                      ///< roughness, in (0, 1]; along the first tangent where alpha_v is given
  Rgb specular = Rgb::Zero();              ///< of the Phong lobe; specular_reflectance of a plastic or dielectric
  double exponent = 30;                    ///< of the Phong lobe, ≥ 0
  bool unit_fresnel = true;                ///< of a conductor, material "none": F = 1
  Rgb eta = Rgb::Zero(), k = Rgb::Zero();  ///< complex index of refraction per channel, where F is not 1
  std::optional<double> alpha_v = {};      ///< roughness along the second tangent, where it is another
  Distribution distribution = Distribution::kGgx;
  double ior = 1.5;                 ///< of a plastic or dielectric: interior over exterior index, > 0
  Rgb transmittance = Rgb::Ones();  ///< specular_transmittance of a dielectric
  bool nonlinear = false;           ///< of a plastic: interreflections below the surface tint the diffuse part
  double opacity = 1;               ///< of a mask, in [0, 1]: the rest of the light passes straight through
  std::shared_ptr<const Texture> reflectance_texture = {}, specular_texture = {}, transmittance_texture = {},
                                 opacity_texture = {};

  bool textured() const { return reflectance_texture || specular_texture || transmittance_texture || opacity_texture; }
};

/// Whether nothing is scattered.
bool is_black(const Bsdf& bsdf);

}  // namespace halfslope
