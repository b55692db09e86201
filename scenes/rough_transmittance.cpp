#include "scenes/rough_transmittance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/fresnel.h"
#include "scenes/gauss_legendre.h"
#include "scenes/microfacet.h"

namespace halfslope {
namespace {

/// The integral over (u₁, u₂) of sample_ggx_visible_normal, which serves both distributions: GGX's tail is the longer,
/// so Beckmann's density over it is bounded. The azimuth's half turn is even and periodic: equal steps. Along the
/// other, the integrand ends at the horizon, and at grazing incidence rises steeply from it: the nodes crowd there.
template <template <class> class Distribution>
double reflectance(double alpha, double ior, double cos_theta) {
  constexpr int kAzimuths = 32;
  static const auto kNodes = gauss_legendre<24>();
  const GgxDistribution<double> proposal(alpha, alpha);
  const Distribution<double> distribution(alpha, alpha);
  const Vec<double> w{std::sqrt((1 - cos_theta) * (1 + cos_theta)), 0, cos_theta};
  const double visible = w.z + distribution.projected_length(w), proposed = w.z + proposal.projected_length(w);
  double sum = 0;
  for (int j = 0; j < kAzimuths; ++j) {
    const double u1 = 0.5 * (j + 0.5) / kAzimuths;
    const auto reflected = [&](double u2) { return mirror(w, sample_ggx_visible_normal(alpha, w, u1, u2)); };
    double above = 0, below = 1;
    for (int step = 0; step < 40; ++step) {
      const double middle = (above + below) / 2;
      (reflected(middle).z > 0 ? above : below) = middle;
    }
    for (const auto& node : kNodes) {
      const double left = 1 - node.x, u2 = above * (1 - left * left * left);
      const Vec<double> wi = reflected(u2), h = w + wi;
      if (wi.z <= 0) continue;
      const MicrofacetReflection<double> r = microfacet_reflection(distribution, w, wi);
      const double density = distribution.d(h) / visible / (proposal.d(h) / proposed);
      const double fresnel = fresnel_dielectric(r.cos_microfacet, ior).reflected;
      sum += node.weight * above * 3 * left * left * density * r.weight * fresnel;
    }
  }
  return sum / kAzimuths;
}

}  // namespace

double rough_reflectance(Distribution distribution, double alpha, double ior, double cos_theta) {
  return distribution == Distribution::kGgx ? reflectance<GgxDistribution>(alpha, ior, cos_theta)
                                            : reflectance<BeckmannDistribution>(alpha, ior, cos_theta);
}

double rough_diffuse_reflectance(Distribution distribution, double alpha, double ior) {
  // Both sides of the critical angle, where a smooth surface has its edge.
  const double critical = ior < 1 ? std::sqrt((1 - ior) * (1 + ior)) : 0;
  double sum = 0;
  for (const auto& node : gauss_legendre<24>()) {
    for (const auto& [from, to] : {std::array{0.0, critical}, std::array{critical, 1.0}}) {
      const double c = from + (to - from) * node.x;
      if (to > from) sum += node.weight * (to - from) * 2 * c * rough_reflectance(distribution, alpha, ior, c);
    }
  }
  return sum;
}

void fit_rough_transmittance(Distribution distribution, double alpha, double ior, MaterialData<double>& data) {
  constexpr int kTerms = kTransmittanceTerms;
  data.transmittance_centre = ior < 1 ? std::sqrt((1 - ior) * (1 + ior)) : 0;
  data.transmittance_inverse_width = 1 / alpha;
  const double first = std::asinh(-data.transmittance_centre / alpha),
               last = std::asinh((1 - data.transmittance_centre) / alpha);
  data.transmittance_scale = 2 / (last - first);
  data.transmittance_offset = -(last + first) / (last - first);
  std::array<double, kTerms> angles, values;
  for (std::size_t k = 0; k < kTerms; ++k) {
    angles[k] = std::numbers::pi * (static_cast<double>(k) + 0.5) / kTerms;
    const double argument = (std::cos(angles[k]) - data.transmittance_offset) / data.transmittance_scale;
    const double c = data.transmittance_centre + alpha * std::sinh(argument);
    values[k] = 1 - rough_reflectance(distribution, alpha, ior, std::clamp(c, 1e-9, 1.0));
  }
  for (int i = 0; i < kTerms; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < kTerms; ++k) sum += values[k] * std::cos(i * angles[k]);
    data.transmittance_terms[i] = sum * (i == 0 ? 1 : 2) / kTerms;
  }
}

}  // namespace halfslope
