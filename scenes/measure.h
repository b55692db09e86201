// From area to solid angle and back. A patch dA at distance r whose normal makes the angle ψ with the line of sight
// covers dω = |cos ψ| / r² dA, so a density p_A per area is p_ω = p_A r² / |cos ψ| per solid angle (Veach, "Robust
// Monte Carlo Methods for Light Transport Simulation", 1997, eq. 8.10).
//
// r² leaves binary32 at r < 1e-22 and r > 2e19, where the quotients are still ordinary numbers; so no product here
// holds r twice, or two cosines, without a division between.
#pragma once

#include "core/packet.h"

namespace halfslope {

/// p_ω = p_A r² / |cos ψ| in 1/sr, for p_A ≥ 0 in 1/area and r > 0 a length. cos ψ = 0 gives ∞ (0 · ∞ = NaN where
/// p_A = 0): a patch seen edge-on covers no solid angle, so callers mask it.
template <class F>
inline F pdf_solid_angle_from_area(const F& pdf_area, const F& distance, const F& cos_psi) {
  return (pdf_area * distance) * (distance / abs(cos_psi));
}

/// G = c₁ c₂ / r², in 1/area, for cosines c₁ and c₂ at the two ends and r > 0 their distance.
template <class F>
inline F geometry_term(const F& cos_1, const F& cos_2, const F& distance) {
  return (cos_1 / distance) * (cos_2 / distance);
}

/// f G / p_A: what one point drawn by area contributes to an integral over solid angle, f in 1/sr.
template <class F>
inline F area_contribution(const F& f, const F& cos_1, const F& cos_2, const F& distance, const F& pdf_area) {
  return (f * (cos_1 / distance) / pdf_area) * (cos_2 / distance);
}

}  // namespace halfslope
