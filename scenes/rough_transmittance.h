// How much of the light that meets a rough dielectric surface does not come back.
//
// T(θ) = 1 − R(θ), R the directional albedo of reflection by its microfacets: what a rough plastic lets through to its
// ground (Mitsuba's roughplastic). As a function of c = cos θ it bends at the scale of α from grazing incidence; so it
// is a polynomial in log(1 + c/α), through the values at Chebyshev's nodes: within 2e-5 where c and α are 0.01 or more
// and the distribution is GGX, 2e-4 where it is Beckmann's; within 1e-3 everywhere.
#pragma once

#include "core/packet.h"
#include "scenes/bsdf_kind.h"
#include "scenes/material_data.h"

namespace halfslope {

/// T of each lane's material.
template <class F>
class RoughTransmittance {
 public:
  using T = scalar_t<F>;
  template <class Get>
  explicit RoughTransmittance(const Get& get)
      : inverse_width_(get(&MaterialData<T>::transmittance_inverse_width)),
        scale_(get(&MaterialData<T>::transmittance_scale)) {
    get(&MaterialData<T>::transmittance_terms, terms_);
  }

  /// For a cosine in [0, 1]; in [0, 1]. By Clenshaw's recurrence.
  F operator()(const F& cos_theta) const {
    const F one(T(1)), zero(T(0)), two(T(2));
    const F x = max(min(fma(log(fma(cos_theta, inverse_width_, one)), scale_, -one), one), -one), x2 = two * x;
    F b1 = zero, b2 = zero;
    for (int i = kTransmittanceTerms - 1; i > 0; --i) {
      const F b = fma(x2, b1, terms_[i] - b2);
      b2 = b1;
      b1 = b;
    }
    return max(min(fma(x, b1, terms_[0] - b2), one), zero);
  }

 private:
  F inverse_width_, scale_, terms_[kTransmittanceTerms];
};

/// R(θ) of a surface of roughness `alpha` at `cos_theta` in (0, 1], by quadrature. `ior` > 0 is the far side's index
/// over the near side's: within 5e-6 for ior >= 1, 5e-3 below, where F has a kink.
double rough_reflectance(Distribution distribution, double alpha, double ior, double cos_theta);

/// ∫ 2 c R dc: the share of diffuse light that comes back; within 5e-4.
double rough_diffuse_reflectance(Distribution distribution, double alpha, double ior);

/// Fills the fields transmittance_*, for ior >= 1.
void fit_rough_transmittance(Distribution distribution, double alpha, double ior, MaterialData<double>& data);

}  // namespace halfslope
