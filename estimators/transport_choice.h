// Which light is sampled, inside a kernel: uniformly, by power, by a light BVH, or as one of all surfaces.
#pragma once

#include "estimators/transport_surface.h"
#include "estimators/transport_techniques.h"

namespace halfslope::kernel {

/// Where light is received: the point, and the normal on the side that scatters.
template <class F>
struct ReceiverPoint {
  Vec<F> position, normal;
};

/// The number of the interval that `word` lies in, `count` where it is above all; `last` ascends.
inline std::int32_t interval_of(const std::uint32_t* last, std::int32_t count, std::uint32_t word) {
  std::int32_t low = 0, high = count;
  while (low < high) {
    const std::int32_t middle = (low + high) / 2;
    if (word > last[middle]) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

template <class T>
inline const LightTable<T>& table_of(const TransportScene<T>& scene, LightChoice choice) {
  return choice == LightChoice::kSurface ? scene.surface : choice == LightChoice::kPower ? scene.power : scene.uniform;
}

/// The element that each lane's `words` choose, and how likely it was: 0 where they choose none. `words` may be null
/// where there is one to choose.
template <class F>
inline F choose_light(const TransportScene<scalar_t<F>>& scene, LightChoice choice, const std::uint32_t* words,
                      const ReceiverPoint<F>& receiver, std::int32_t* element) {
  using T = scalar_t<F>;
  alignas(64) T probability[kLanes];
  if (!words) {
    for (int l = 0; l < kWidth<F>; ++l) element[l] = 0;
    return F(T(1));
  }
  if (choice == LightChoice::kBvh) {
    alignas(64) T p[6][kLanes];
    store(p[0], receiver.position.x), store(p[1], receiver.position.y), store(p[2], receiver.position.z);
    store(p[3], receiver.normal.x), store(p[4], receiver.normal.y), store(p[5], receiver.normal.z);
    for (int l = 0; l < kWidth<F>; ++l) {
      const T position[3] = {p[0][l], p[1][l], p[2][l]}, normal[3] = {p[3][l], p[4][l], p[5][l]};
      const auto chosen = choose_light_leaf(scene.bvh, position, normal, words[l], !scene.transmits);
      element[l] = chosen.leaf;
      probability[l] = chosen.probability;
    }
    return load<F>(probability);
  }
  const LightTable<T>& table = table_of(scene, choice);
  for (int l = 0; l < kWidth<F>; ++l) {
    const std::int32_t found = interval_of(table.last, scene.light_count, words[l]);
    element[l] = found < scene.light_count ? found : 0;
    probability[l] = found < scene.light_count ? table.probability[found] : T(0);
  }
  return load<F>(probability);
}

/// How likely choose_light was to give each lane's element.
template <class F>
inline F light_probability(const TransportScene<scalar_t<F>>& scene, LightChoice choice, const std::int32_t* element,
                           const ReceiverPoint<F>& receiver) {
  using T = scalar_t<F>;
  if (scene.light_count == 1 && choice != LightChoice::kSurface) return F(T(1));
  if (choice != LightChoice::kBvh) return gather<F>(table_of(scene, choice).probability, element);
  alignas(64) T probability[kLanes], p[6][kLanes];
  store(p[0], receiver.position.x), store(p[1], receiver.position.y), store(p[2], receiver.position.z);
  store(p[3], receiver.normal.x), store(p[4], receiver.normal.y), store(p[5], receiver.normal.z);
  for (int l = 0; l < kWidth<F>; ++l) {
    const T position[3] = {p[0][l], p[1][l], p[2][l]}, normal[3] = {p[3][l], p[4][l], p[5][l]};
    probability[l] = light_leaf_probability(scene.bvh, element[l], position, normal, !scene.transmits);
  }
  return load<F>(probability);
}

}  // namespace halfslope::kernel
