#include "scenes/rough_transmittance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/fresnel.h"
#include "scenes/gauss_legendre.h"
#include "scenes/microfacet.h"

namespace halfslope {
namespace {

/// Where, along the ray of slopes r (cos φ, sin φ), r in (0, most), a microfacet is met at the critical angle, whose
/// cosine is κ: (x r + z)² = κ² (1 + r²) with x = w_x cos φ, z = w_z.
int critical_slopes(double x, double z, double critical, double most, double (&roots)[2]) {
  if (critical == 0) return 0;
  const double a = (x - critical) * (x + critical), b = x * z, c = (z - critical) * (z + critical);
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0)) return 0;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  int count = 0;
  for (const double r : {q / a, c / q}) {
    if (r > 0 && r < most && x * r + z > 0) roots[count++] = r;
  }
  if (count == 2 && roots[0] > roots[1]) std::swap(roots[0], roots[1]);
  return count;
}

/// ∫ D_w(m) F G₂/G₁ over the microfacets m that reflect w above the horizon. In slopes (p, q) = (m_x, m_y)/m_z that is
/// a disk: (p − tan θ)² + q² < 1/cos²θ. With p = r cos φ, q = r sin φ, r = α tan ψ, GGX's slopes have the density
/// 2 sin ψ cos ψ dψ dφ/(2π), so for both distributions
///   R = 1/π ∫₀^π dφ ∫ dψ 2 sin ψ cos ψ (P/P_GGX) (w_x p + w_z) / ((w_z + L)/2) F G₂/G₁,
/// up to the disk's edge. By Gauss's rule: in φ, its nodes crowd at π/2, where at grazing incidence the visible end and
/// the hidden begin, by a hyperbolic sine; in ψ, at both ends of each piece between the edge, where G₂ may rise
/// steeply, and the critical angle, where F has a root's kink, by 3t² − 2t³.
template <template <class> class Distribution, int kAzimuthNodes, int kSlopeNodes>
double reflectance(double alpha, double ior, double cos_theta) {
  static const auto kAzimuth = gauss_legendre<kAzimuthNodes>();
  static const auto kSlope = gauss_legendre<kSlopeNodes>();
  constexpr double kPi = std::numbers::pi;
  const Distribution<double> distribution(alpha, alpha);
  const Vec<double> w{std::sqrt((1 - cos_theta) * (1 + cos_theta)), 0, cos_theta};
  const double critical = ior < 1 ? std::sqrt((1 - ior) * (1 + ior)) : 0;
  const double half_visible = 0.5 * (w.z + distribution.projected_length(w));
  const double width = cos_theta / (cos_theta + alpha), extent = std::asinh(0.5 * kPi / width);
  double sum = 0;
  for (const auto& azimuth : kAzimuth) {
    const double turn = extent * (2 * azimuth.x - 1), phi = 0.5 * kPi + width * std::sinh(turn);
    const double x = w.x * std::cos(phi), root = std::hypot(x, w.z);
    const double edge = x > 0 ? (x + root) / w.z : w.z / (root - x);
    double slopes[2];
    const int kinks = critical_slopes(x, w.z, critical, edge, slopes);
    double from = 0, inner = 0;
    for (int piece = 0; piece <= kinks; ++piece) {
      const double to = std::atan((piece < kinks ? slopes[piece] : edge) / alpha);
      for (const auto& slope : kSlope) {
        const double t = slope.x, psi = from + (to - from) * t * t * (3 - 2 * t);
        const double tangent = std::tan(psi), r = alpha * tangent;
        const Vec<double> m = normalise(Vec<double>{r * std::cos(phi), r * std::sin(phi), 1}), wi = mirror(w, m);
        if (!(wi.z > 0)) continue;
        double slope_ratio = 1;
        if constexpr (Distribution<double>::kDistribution == halfslope::Distribution::kBeckmann) {
          const double k = tangent * tangent;
          slope_ratio = std::exp(-k) * (1 + k) * (1 + k);
        }
        const MicrofacetReflection<double> reflection = microfacet_reflection(distribution, w, wi);
        inner += slope.weight * (to - from) * 6 * t * (1 - t) * std::sin(2 * psi) * slope_ratio * (x * r + w.z) *
                 reflection.weight * fresnel_dielectric(reflection.cos_microfacet, ior).reflected;
      }
      from = to;
    }
    sum += azimuth.weight * 2 * extent * width * std::cosh(turn) * inner;
  }
  return sum / (kPi * half_visible);
}

}  // namespace

double rough_reflectance(Distribution distribution, double alpha, double ior, double cos_theta) {
  return distribution == Distribution::kGgx ? reflectance<GgxDistribution, 64, 32>(alpha, ior, cos_theta)
                                            : reflectance<BeckmannDistribution, 64, 32>(alpha, ior, cos_theta);
}

double rough_diffuse_reflectance(Distribution distribution, double alpha, double ior) {
  // Half the nodes each way: the mean over directions is as exact.
  const auto towards = distribution == Distribution::kGgx ? reflectance<GgxDistribution, 32, 20>
                                                          : reflectance<BeckmannDistribution, 32, 20>;
  // Both sides of the critical angle, where a smooth surface has its edge, with nodes that crowd there.
  const double critical = ior < 1 ? std::sqrt((1 - ior) * (1 + ior)) : 0;
  double sum = 0;
  for (const auto& node : gauss_legendre<20>()) {
    const double t = node.x, crowded = t * t * (3 - 2 * t), weight = node.weight * 6 * t * (1 - t);
    for (const auto& [from, to] : {std::array{0.0, critical}, std::array{critical, 1.0}}) {
      const double c = from + (to - from) * crowded;
      if (to > from) sum += weight * (to - from) * 2 * c * towards(alpha, ior, c);
    }
  }
  return sum;
}

void fit_rough_transmittance(Distribution distribution, double alpha, double ior, MaterialData<double>& data) {
  constexpr int kTerms = kTransmittanceTerms;
  data.transmittance_inverse_width = 1 / alpha;
  data.transmittance_scale = 2 / std::log1p(1 / alpha);
  std::array<double, kTerms> angles, values;
  for (std::size_t k = 0; k < kTerms; ++k) {
    angles[k] = std::numbers::pi * (static_cast<double>(k) + 0.5) / kTerms;
    const double c = alpha * std::expm1((std::cos(angles[k]) + 1) / data.transmittance_scale);
    values[k] = 1 - rough_reflectance(distribution, alpha, ior, std::clamp(c, 1e-9, 1.0));
  }
  for (int i = 0; i < kTerms; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < kTerms; ++k) sum += values[k] * std::cos(i * angles[k]);
    data.transmittance_terms[i] = sum * (i == 0 ? 1 : 2) / kTerms;
  }
}

}  // namespace halfslope
