// A surface's BSDF as kernels read it.
#pragma once

#include "scenes/bsdf_kind.h"

namespace halfslope {

struct Bsdf;

/// As many polynomial coefficients as a rough interface's transmittance takes (scenes/rough_transmittance.h).
inline constexpr int kTransmittanceTerms = 24;

/// Plain data; T is float or double. Which fields mean something depends on the kind. Colours are those without a
/// texture: a kernel looks up the textures of `reflectance`, `specular` and `transmittance` itself.
template <class T>
struct MaterialData {
  BsdfKind kind = BsdfKind::kDiffuse;
  Distribution distribution = Distribution::kGgx;
  T reflectance[3] = {};       ///< the diffuse albedo, or a conductor's specular_reflectance
  T specular[3] = {};          ///< of a Phong lobe; specular_reflectance of a plastic or dielectric
  T transmittance[3] = {};     ///< specular_transmittance of a dielectric
  T eta[3] = {}, k[3] = {};    ///< of a conductor; F = 1 where eta is 0
  T alpha_u = 1, alpha_v = 1;  ///< roughness along the tangents, at least 1e-4
  T exponent = 0;              ///< of a Phong lobe
  T ior = 1;                   ///< interior over exterior
  T specular_share = 0;        ///< of samples that go to the specular lobe, apart from what Fresnel's factor decides
  T diffuse_divisor = 1;       ///< of a plastic: ρ comes out as ρ / (diffuse_divisor − diffuse_tint ρ), times both
  T diffuse_tint = 0;          ///<   ways' transmittance through the surface
  /// Of a rough plastic: the polynomial of RoughTransmittance and its argument.
  T transmittance_inverse_width = 1, transmittance_scale = 1;
  T transmittance_terms[kTransmittanceTerms] = {};
};

/// With all that can be worked out once, in double. Roughness below 1e-4 counts as that, as in Mitsuba. A rough
/// dielectric whose two sides have one index is the smooth one: light passes straight through. Throws Error(kBadInput)
/// for a rough plastic with ior < 1: its model would give back more light than it gets.
template <class T>
MaterialData<T> material_data(const Bsdf& bsdf);
extern template MaterialData<float> material_data<float>(const Bsdf&);
extern template MaterialData<double> material_data<double>(const Bsdf&);

}  // namespace halfslope
