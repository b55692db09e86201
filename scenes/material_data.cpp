#include "scenes/material_data.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/bsdf.h"
#include "scenes/fresnel.h"
#include "scenes/gauss_legendre.h"
#include "scenes/rough_transmittance.h"

namespace halfslope {
namespace {

constexpr double kLeastAlpha = 1e-4;

/// Rec. 709 luminance.
double luminance(const Rgb& colour) { return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]; }

/// Of the specular part among all; neither all nor none where both reflect, in numbers of T as well.
double specular_share(const Rgb& specular, const Rgb& diffuse) {
  const double s = luminance(specular), d = luminance(diffuse);
  if (!(s > 0)) return 0;
  return d > 0 ? std::clamp(s / (s + d), 0x1p-20, 1 - 0x1p-20) : 1;
}

/// ∫ 2 c F dc: the share of diffuse light that a smooth surface sends back.
double diffuse_reflectance(double ior) {
  // In c = s² the root at the critical angle's cosine, or at 0 near index 1, is smooth.
  const double critical = ior < 1 ? std::sqrt((1 - ior) * (1 + ior)) : 0;
  double sum = critical * critical;
  for (const auto& node : gauss_legendre<64>()) {
    const double c = critical + (1 - critical) * node.x * node.x;
    sum += node.weight * (1 - critical) * 2 * node.x * 2 * c * fresnel_dielectric(c, ior).reflected;
  }
  return sum;
}

/// Of what the ground sends up, the share that a rough coat sends back: by its microfacets seen from below, but no more
/// than leaves it what light from above brings, (1 − R)/n²: where reflection at the critical angle is smeared over, the
/// first gives up to 5e-4 more, and a white ground under it would shine.
double rough_internal_reflectance(Distribution distribution, double alpha, double ior) {
  return std::min(rough_diffuse_reflectance(distribution, alpha, 1 / ior),
                  1 - (1 - rough_diffuse_reflectance(distribution, alpha, ior)) / (ior * ior));
}

/// What the coat sends back down, again and again: ρ(1 − R)/(1 − ρR), or ρ(1 − R)/(1 − R) where the ground's colour is
/// not to grow more saturated by it; and 1/n² for radiance on its way out.
void fill_ground(const Bsdf& bsdf, double internal, MaterialData<double>& data) {
  const double n2 = bsdf.ior * bsdf.ior;
  data.diffuse_divisor = bsdf.nonlinear ? n2 : n2 * (1 - internal);
  data.diffuse_tint = bsdf.nonlinear ? n2 * internal : 0;
}

void copy(const Rgb& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }

MaterialData<double> in_double(const Bsdf& bsdf) {
  MaterialData<double> data;
  data.kind = bsdf.kind;
  data.distribution = bsdf.distribution;
  copy(bsdf.reflectance, data.reflectance);
  copy(bsdf.specular, data.specular);
  copy(bsdf.transmittance, data.transmittance);
  if (!bsdf.unit_fresnel) copy(bsdf.eta, data.eta), copy(bsdf.k, data.k);
  data.alpha_u = std::max(bsdf.alpha, kLeastAlpha);
  data.alpha_v = std::max(bsdf.alpha_v.value_or(bsdf.alpha), kLeastAlpha);
  data.exponent = bsdf.exponent;
  data.ior = bsdf.ior;
  switch (bsdf.kind) {
    case BsdfKind::kPhong:
      data.specular_share = specular_share(bsdf.specular, bsdf.reflectance);
      break;
    case BsdfKind::kPlastic:
      data.specular_share = specular_share(bsdf.specular, bsdf.reflectance);
      fill_ground(bsdf, diffuse_reflectance(1 / bsdf.ior), data);
      break;
    case BsdfKind::kRoughPlastic:
      if (!(bsdf.ior >= 1)) {
        fail(ExitCode::kBadInput, "roughplastic: int_ior is {} of ext_ior; it must not be the smaller", bsdf.ior);
      }
      data.specular_share = specular_share(bsdf.specular, bsdf.reflectance);
      fill_ground(bsdf, rough_internal_reflectance(bsdf.distribution, data.alpha_u, bsdf.ior), data);
      fit_rough_transmittance(bsdf.distribution, data.alpha_u, bsdf.ior, data);
      break;
    case BsdfKind::kRoughDielectric:
      if (bsdf.ior == 1) data.kind = BsdfKind::kDielectric;
      break;
    default:
      break;
  }
  return data;
}

template <class T, std::size_t N>
void round(const double (&from)[N], T (&to)[N]) {
  for (std::size_t i = 0; i < N; ++i) to[i] = static_cast<T>(from[i]);
}

}  // namespace

template <class T>
MaterialData<T> material_data(const Bsdf& bsdf) {
  const MaterialData<double> exact = in_double(bsdf);
  MaterialData<T> data;
  data.kind = exact.kind;
  data.distribution = exact.distribution;
  round(exact.reflectance, data.reflectance);
  round(exact.specular, data.specular);
  round(exact.transmittance, data.transmittance);
  round(exact.eta, data.eta);
  round(exact.k, data.k);
  round(exact.transmittance_terms, data.transmittance_terms);
  const auto field = [&](T MaterialData<T>::*to, double MaterialData<double>::*from) {
    data.*to = static_cast<T>(exact.*from);
  };
  using D = MaterialData<double>;
  using M = MaterialData<T>;
  field(&M::alpha_u, &D::alpha_u);
  field(&M::alpha_v, &D::alpha_v);
  field(&M::exponent, &D::exponent);
  field(&M::ior, &D::ior);
  field(&M::specular_share, &D::specular_share);
  field(&M::diffuse_divisor, &D::diffuse_divisor);
  field(&M::diffuse_tint, &D::diffuse_tint);
  field(&M::transmittance_inverse_width, &D::transmittance_inverse_width);
  field(&M::transmittance_scale, &D::transmittance_scale);
  return data;
}

template MaterialData<float> material_data<float>(const Bsdf&);
template MaterialData<double> material_data<double>(const Bsdf&);

}  // namespace halfslope
