// What scatters at each lane's surface, inside a kernel: every class of BSDF that some lane needs, in turn.
#pragma once

#include <bit>

#include "core/gather.h"
#include "estimators/transport_surface.h"
#include "scenes/bsdf_classes.h"

namespace halfslope::kernel {

/// scenes/texture.h's texture_value, one lane.
template <class T>
inline void look_up(const TextureData<T>& texture, T u, T v, T* rgb) {
  const T x = texture.to_uv[0] * u + texture.to_uv[1] * v + texture.to_uv[2],
          y = texture.to_uv[3] * u + texture.to_uv[4] * v + texture.to_uv[5];
  if (!texture.bitmap) {
    const bool even = (x - std::floor(x) > T(0.5)) == (y - std::floor(y) > T(0.5));
    for (int c = 0; c < 3; ++c) rgb[c] = even ? texture.color0[c] : texture.color1[c];
    return;
  }
  const auto bounded = [](T t) { return t < T(-1e6) ? T(-1e6) : t > T(1e6) ? T(1e6) : t; };  // NaN stays out below
  const auto wrapped = [&](int i, int size) {
    if (texture.wrap == 2) return i < 0 ? 0 : i >= size ? size - 1 : i;
    const int period = texture.wrap == 1 ? 2 * size : size;
    const int r = ((i % period) + period) % period;
    return r < size ? r : period - 1 - r;
  };
  const auto texel = [&](int column, int row) {
    return texture.rgb +
           3 * (static_cast<std::size_t>(wrapped(row, texture.height)) * static_cast<std::size_t>(texture.width) +
                static_cast<std::size_t>(wrapped(column, texture.width)));
  };
  T across = bounded(x) * static_cast<T>(texture.width), down = bounded(T(1) - y) * static_cast<T>(texture.height);
  if (!(across == across)) across = T(0);
  if (!(down == down)) down = T(0);
  if (texture.nearest) {
    const float* found = texel(static_cast<int>(std::floor(across)), static_cast<int>(std::floor(down)));
    for (int c = 0; c < 3; ++c) rgb[c] = static_cast<T>(found[c]);
    return;
  }
  const T left = std::floor(across - T(0.5)), top = std::floor(down - T(0.5));
  const T a = across - T(0.5) - left, b = down - T(0.5) - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  const float *p00 = texel(column, row), *p10 = texel(column + 1, row), *p01 = texel(column, row + 1),
              *p11 = texel(column + 1, row + 1);
  for (int c = 0; c < 3; ++c) {
    rgb[c] = (T(1) - b) * ((T(1) - a) * static_cast<T>(p00[c]) + a * static_cast<T>(p10[c])) +
             b * ((T(1) - a) * static_cast<T>(p01[c]) + a * static_cast<T>(p11[c]));
  }
}

/// Each lane's material by its fields, as BSDF classes ask (scenes/bsdf_values.h).
template <class F>
class LaneMaterials {
 public:
  using T = scalar_t<F>;
  LaneMaterials(const TransportScene<T>& scene, const Surface<F>& surface, const std::int32_t* index)
      : scene_(scene), surface_(surface), index_(index), entries_(scene.materials, index) {}

  F operator()(T MaterialData<T>::*field) const { return entries_(field); }
  template <int kSize, int kCount>
  void operator()(T (MaterialData<T>::*field)[kSize], F (&out)[kCount]) const {
    entries_(field, out);
    if constexpr (kSize == 3) {
      if (!scene_.material_textures) return;
      const int slot = field == &MaterialData<T>::reflectance     ? 0
                       : field == &MaterialData<T>::specular      ? 1
                       : field == &MaterialData<T>::transmittance ? 2
                                                                  : -1;
      if (slot >= 0) look_up_textures(slot, out);
    }
  }
  /// The share of light that meets the material at all.
  F opacity() const {
    F opacity[1] = {gather<F>(scene_.opacities, index_)};
    if (scene_.material_textures) look_up_textures(3, opacity);
    return opacity[0];
  }

 private:
  /// Replaces the values of lanes whose material has a texture there.
  template <int kCount>
  void look_up_textures(int slot, F (&values)[kCount]) const {
    bool any = false;
    for (int l = 0; l < kWidth<F>; ++l) any |= scene_.material_textures[index_[l]].texture[slot] >= 0;
    if (!any) return;
    alignas(64) T lanes[kCount][kLanes], u[kLanes], v[kLanes];
    for (int c = 0; c < kCount; ++c) store(lanes[c], values[c]);
    store(u, surface_.u);
    store(v, surface_.v);
    for (int l = 0; l < kWidth<F>; ++l) {
      const std::int32_t texture = scene_.material_textures[index_[l]].texture[slot];
      if (texture < 0) continue;
      T rgb[3];
      look_up(scene_.textures[texture], u[l], v[l], rgb);
      for (int c = 0; c < kCount; ++c) lanes[c][l] = rgb[c];
    }
    for (int c = 0; c < kCount; ++c) values[c] = load<F>(lanes[c]);
  }

  const TransportScene<T>& scene_;
  const Surface<F>& surface_;
  const std::int32_t* index_;
  LaneEntries<F, MaterialData<T>> entries_;
};

/// Runs `run(lanes, bsdf, materials)` for each class of BSDF that some lane of `active` has.
template <class F, int C, class Run>
inline void with_bsdfs(const TransportScene<scalar_t<F>>& scene, const Surface<F>& surface, const mask_t<F>& active,
                       Run run) {
  const mask_t<F> scatters = active & lanes_from<F>(surface.material, 0);
  if (!any_lane(scatters)) return;
  alignas(64) std::int32_t index[kLanes];
  for (int l = 0; l < kWidth<F>; ++l) index[l] = surface.material[l] < 0 ? 0 : surface.material[l];
  const auto with_class = [&](std::int32_t now, const mask_t<F>& lanes) {
    const LaneMaterials<F> materials(scene, surface, index);
    with_bsdf_class<F, C>(kind_of_class(now), distribution_of_class(now),
                          [&](auto type) { run(lanes, typename decltype(type)::type(materials), materials); });
  };
  if (scene.only_class >= 0) {
    with_class(scene.only_class, scatters);
    return;
  }
  using T = scalar_t<F>;
  alignas(64) T flags[kLanes];
  store_mask<F>(flags, scatters);
  alignas(64) std::int32_t lane_class[kLanes];
  std::uint32_t present = 0;
  for (int l = 0; l < kWidth<F>; ++l) {
    const std::int32_t of_lane = scene.material_class[index[l]];
    lane_class[l] = flags[l] != T(0) ? of_lane : -1;
    present |= flags[l] != T(0) ? 1u << of_lane : 0u;
  }
  while (present != 0) {
    const int now = std::countr_zero(present);
    present &= present - 1;
    // Lanes of other classes read the material of one that is: sound numbers, which the mask drops.
    std::int32_t some = 0;
    for (int l = 0; l < kWidth<F>; ++l) {
      if (lane_class[l] == now) some = surface.material[l];
    }
    for (int l = 0; l < kWidth<F>; ++l) index[l] = lane_class[l] == now ? surface.material[l] : some;
    with_class(now, lanes_with<F>(lane_class, now));
  }
}

}  // namespace halfslope::kernel
