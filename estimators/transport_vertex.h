// One vertex of a path, inside a kernel: a light and a direction drawn where a ray has met the scene.
#pragma once

#include "core/coordinates.h"
#include "estimators/transport_calls.h"
#include "estimators/transport_lights.h"
#include "estimators/transport_materials.h"

namespace halfslope::kernel {

/// The numbers of one row of points.
template <class T>
class RowNumbers {
 public:
  RowNumbers(const std::uint32_t* const* high, const std::uint32_t* const* low, std::size_t first)
      : high_(high), low_(low), first_(first) {}
  const std::uint32_t* words(int dim) const { return high_[dim] + first_; }
  void load(int dim, T* out) const {
    to_coordinates(words(dim), low_[dim] ? low_[dim] + first_ : nullptr, kLanes, out);
  }

 private:
  const std::uint32_t* const* high_;
  const std::uint32_t* const* low_;
  std::size_t first_;
};

/// What a surface does to a light drawn for it, and where it sends the path.
template <class F, int C>
struct Scattering {
  BsdfValue<F, C> light;
  BsdfSample<F, C> next;
};

/// Opacity o: the surface's own BSDF times o, and with probability 1 − o the way straight on, a delta lobe of weight 1.
template <class F, int C>
inline void scatter(const TransportScene<scalar_t<F>>& scene, const Surface<F>& surface, const mask_t<F>& active,
                    const Vec<F>& to_light, const F& u_lobe, const F& u1, const F& u2, Scattering<F, C>& result) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  for (int c = 0; c < C; ++c) result.light.cosine_bsdf[c] = result.next.weight[c] = zero;
  result.light.pdf = result.next.pdf = zero;
  result.next.wi = {zero, zero, one};
  result.next.eta = one;
  result.next.delta = no_lanes<F>();
  with_bsdfs<F, C>(scene, surface, active, [&](const mask_t<F>& lanes, const auto& bsdf, const auto& materials) {
    F opacity = one, lobe = u_lobe;
    if (scene.masked) {
      opacity = materials.opacity();
      lobe = min(u_lobe / opacity, F(T(1) - std::numeric_limits<T>::epsilon()));
    }
    if constexpr (std::remove_cvref_t<decltype(bsdf)>::kContinuous) {
      const BsdfValue<F, C> value = bsdf.evaluate(surface.wo, to_light);
      for (int c = 0; c < C; ++c) {
        result.light.cosine_bsdf[c] = select(lanes, opacity * value.cosine_bsdf[c], result.light.cosine_bsdf[c]);
      }
      result.light.pdf = select(lanes, opacity * value.pdf, result.light.pdf);
    }
    BsdfSample<F, C> next = bsdf.sample(surface.wo, lobe, u1, u2);
    if (scene.masked) {
      const mask_t<F> through = u_lobe >= opacity;
      next.wi = select_vec(through, -surface.wo, next.wi);
      for (int c = 0; c < C; ++c) next.weight[c] = select(through, one, next.weight[c]);
      next.pdf = select(through, one - opacity, opacity * next.pdf);
      next.eta = select(through, one, next.eta);
      next.delta = next.delta | through;
    }
    result.next.wi = select_vec(lanes, next.wi, result.next.wi);
    for (int c = 0; c < C; ++c) result.next.weight[c] = select(lanes, next.weight[c], result.next.weight[c]);
    result.next.pdf = select(lanes, next.pdf, result.next.pdf);
    result.next.eta = select(lanes, next.eta, result.next.eta);
    result.next.delta = (lanes & next.delta) | (!lanes & result.next.delta);
  });
}

/// The light element under each lane's hit, or beyond the scene; −1 where nothing emits towards the ray. Those lanes'
/// radiance is 0.
template <class F, int C>
inline mask_t<F> emitted(const TransportScene<scalar_t<F>>& scene, const RayRow<scalar_t<F>>& row, int lane,
                         const Surface<F>& surface, std::int32_t* element, F* radiance) {
  using T = scalar_t<F>;
  const F zero(T(0));
  alignas(64) std::int32_t index[kLanes];
  std::int32_t any = 0, any_beyond = 0;
  for (int l = 0; l < kWidth<F>; ++l) {
    const std::int32_t beyond =
        (row.piece[lane + l] < 0) & (row.active[lane + l] != T(0)) & (scene.environment_light >= 0);
    element[l] = beyond ? scene.environment_light : surface.light[l];
    index[l] = element[l] < 0 ? 0 : element[l];
    any |= static_cast<std::int32_t>(element[l] >= 0);
    any_beyond |= beyond;
  }
  for (int c = 0; c < C; ++c) radiance[c] = zero;
  const mask_t<F> seen = lanes_from<F>(element, 0);
  if (!any) return seen;
  F found[C];
  LaneEntries<F, LightElement<T>>(scene.lights, index)(&LightElement<T>::radiance, found);
  for (int c = 0; c < C; ++c) radiance[c] = select(seen, found[c], zero);
  if (any_beyond) {
    F from_beyond[3];
    environment_radiance(*scene.environment, row.direction.template load<F>(lane), from_beyond);
    const mask_t<F> beyond = lanes_with<F>(element, scene.environment_light);
    for (int c = 0; c < C; ++c) radiance[c] = select(beyond, from_beyond[c], radiance[c]);
  }
  return seen;
}

}  // namespace halfslope::kernel
