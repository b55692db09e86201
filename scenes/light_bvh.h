// A tree of lights, from which one is chosen for a receiver: likelier the more it can send there.
//
// Each node bounds where its lights are, where they point to and what they emit; a choice goes down from the root, at
// each node to one child in proportion to the children's importance (A. Conty Estevez and C. Kulla, "Importance
// Sampling of Many Lights with Adaptive Tree Splitting", 2018, without the splitting; M. Pharr, W. Jakob and G.
// Humphreys, "Physically Based Rendering", 4th ed., 2023, §12.6.3). Lights without a place are chosen beside the tree.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace halfslope {

/// A light as the tree sees it.
struct LightLeaf {
  double lower[3], upper[3];   ///< a box that holds it
  double axis[3] = {0, 0, 1};  ///< unit length: the middle of its normals
  double cos_normals = -1;     ///< cosine of the largest angle θ_o ≤ π between the axis and a normal
  double cos_emission = 0;     ///< of the largest angle θ_e ≤ π/2 to a normal under which it emits
  double power = 0;            ///< finite, ≥ 0
  bool two_sided = false;      ///< it emits about −axis too
  bool everywhere = false;     ///< it has no place: an environment, a directional light; box and axis do not matter
};

/// Children of node i are i + 1 and `right`.
template <class T>
struct LightBvhNode {
  T center[3], half[3];  ///< of the box
  T axis[3];
  T cos_normals, sin_normals, cos_emission;
  T power;
  T radius_squared;  ///< of the sphere around the box
  std::int32_t right;
  std::int32_t leaf;  ///< −1 of an inner node
  std::int32_t two_sided;
};

/// What kernels read.
template <class T>
struct LightBvhData {
  const LightBvhNode<T>* nodes;    ///< null: no light has a place
  const std::uint64_t* trails;     ///< one a leaf: bit k says whether the way to it turns right at depth k
  const std::uint8_t* everywhere;  ///< one a leaf
  const std::int32_t* placeless;   ///< the leaves that are
  std::int32_t leaf_count, placeless_count;
};

template <class T>
struct ChosenLeaf {
  std::int32_t leaf;
  T probability;
};

namespace light_bvh {

/// cos(max(0, a − b)) of angles in [0, π] from their sines and cosines.
template <class T>
inline T cos_less(T sin_a, T cos_a, T sin_b, T cos_b) {
  return cos_a > cos_b ? T(1) : cos_a * cos_b + sin_a * sin_b;
}
template <class T>
inline T sin_less(T sin_a, T cos_a, T sin_b, T cos_b) {
  return cos_a > cos_b ? T(0) : sin_a * cos_b - cos_a * sin_b;
}
template <class T>
inline T sine_of(T cosine) {
  return std::sqrt(std::fmax(T(0), (T(1) - cosine) * (T(1) + cosine)));
}

/// Power times a bound of the cosines at both ends over the squared distance, as Conty Estevez and Kulla's eq. 3; 0
/// only where nothing can arrive, by more than roundings. The distance is not taken below the box's radius.
template <class T>
inline T importance(const LightBvhNode<T>& node, const T* position, const T* normal, bool one_sided) {
  constexpr T kSlack = T(1e-5);  // of cosines: their roundings must not take a light away
  T way[3], squared = 0;
  for (int k = 0; k < 3; ++k) {
    way[k] = position[k] - node.center[k];
    squared += way[k] * way[k];
  }
  const T distance = std::sqrt(squared);
  const bool inside = !(squared > node.radius_squared);
  // Of the cone in which the box lies, θ_b.
  const T sin_box = inside ? T(0) : std::sqrt(node.radius_squared / squared),
          cos_box = inside ? T(-1) : sine_of(sin_box);
  const T inverse = squared > T(0) ? T(1) / distance : T(0);
  T cos_axis = 0, cos_receiver = 0;
  for (int k = 0; k < 3; ++k) {
    cos_axis += node.axis[k] * way[k] * inverse;
    cos_receiver -= normal[k] * way[k] * inverse;
  }
  if (node.two_sided) cos_axis = std::fabs(cos_axis);
  const T sin_axis = sine_of(cos_axis);
  const T cos_normal = cos_less(sin_axis, cos_axis, node.sin_normals, node.cos_normals);
  const T sin_normal = sin_less(sin_axis, cos_axis, node.sin_normals, node.cos_normals);
  const T cos_light = cos_less(sin_normal, cos_normal, sin_box, cos_box);
  if (cos_light < node.cos_emission - kSlack) return T(0);
  T result = node.power * std::fmax(cos_light, kSlack) / std::fmax(squared, node.radius_squared);
  if (normal[0] != T(0) || normal[1] != T(0) || normal[2] != T(0)) {
    if (!one_sided) cos_receiver = std::fabs(cos_receiver);
    const T cos_most = cos_less(sine_of(cos_receiver), cos_receiver, sin_box, cos_box);
    if (cos_most < -kSlack) return T(0);
    result *= std::fmax(cos_most, kSlack);
  }
  return result;
}

/// The probability of a node's left child: by importance; where neither can send anything, by power; or ½.
template <class T>
inline T left_probability(const LightBvhNode<T>* nodes, std::int32_t node, const T* position, const T* normal,
                          bool one_sided) {
  const LightBvhNode<T>&left = nodes[node + 1], &right = nodes[nodes[node].right];
  const T a = importance(left, position, normal, one_sided), b = importance(right, position, normal, one_sided);
  const T all = a + b;
  if (all > T(0) && std::isfinite(all)) return a / all;
  const T power = left.power + right.power;
  return power > T(0) ? left.power / power : T(0.5);
}

/// Of the group of lights with a place, beside which each light without one counts as much.
template <class T>
inline T placed_probability(const LightBvhData<T>& bvh) {
  return bvh.nodes ? T(1) / static_cast<T>(1 + bvh.placeless_count) : T(0);
}

}  // namespace light_bvh

/// The leaf that `word` chooses for a receiver at `position`, and how likely it was: the fraction word/2³² is used up
/// and rescaled at each node. `normal` is unit length, or 0 where there is none. Light is taken to be received from
/// both sides unless `one_sided`. At least one leaf.
template <class T>
inline ChosenLeaf<T> choose_light_leaf(const LightBvhData<T>& bvh, const T* position, const T* normal,
                                       std::uint32_t word, bool one_sided = false) {
  double u = static_cast<double>(word) * 0x1p-32;
  constexpr double kLast = 1 - 0x1p-53;
  const T placed = light_bvh::placed_probability(bvh);
  if (!(u < static_cast<double>(placed))) {
    const T rest = (T(1) - placed) / static_cast<T>(bvh.placeless_count);
    const double share = (u - static_cast<double>(placed)) / (1 - static_cast<double>(placed));
    const auto k = static_cast<std::int32_t>(share * bvh.placeless_count);
    return {bvh.placeless[k < bvh.placeless_count ? k : bvh.placeless_count - 1], rest};
  }
  u /= static_cast<double>(placed);
  T probability = placed;
  std::int32_t node = 0;
  while (bvh.nodes[node].leaf < 0) {
    const T left = light_bvh::left_probability(bvh.nodes, node, position, normal, one_sided);
    const auto split = static_cast<double>(left);
    u = std::fmin(u, kLast);
    if (u < split) {
      u /= split;
      probability *= left;
      ++node;
    } else {
      u = (u - split) / (1 - split);
      probability *= T(1) - left;
      node = bvh.nodes[node].right;
    }
  }
  return {bvh.nodes[node].leaf, probability};
}

/// How likely choose_light_leaf is to choose this leaf: to the bit what it returns then.
template <class T>
inline T light_leaf_probability(const LightBvhData<T>& bvh, std::int32_t leaf, const T* position, const T* normal,
                                bool one_sided = false) {
  const T placed = light_bvh::placed_probability(bvh);
  if (bvh.everywhere[leaf]) return (T(1) - placed) / static_cast<T>(bvh.placeless_count);
  T probability = placed;
  std::int32_t node = 0;
  for (std::uint64_t trail = bvh.trails[leaf]; bvh.nodes[node].leaf < 0; trail >>= 1) {
    const T left = light_bvh::left_probability(bvh.nodes, node, position, normal, one_sided);
    const bool right = trail & 1;
    probability *= right ? T(1) - left : left;
    node = right ? bvh.nodes[node].right : node + 1;
  }
  return probability;
}

/// The tree of these lights, its arrays, made in time n log n and of depth at most 64.
template <class T>
class LightBvh {
 public:
  explicit LightBvh(std::span<const LightLeaf> leaves);
  LightBvh(const LightBvh&) = delete;
  LightBvh& operator=(const LightBvh&) = delete;

  const LightBvhData<T>& data() const { return data_; }
  int depth() const { return depth_; }

 private:
  std::vector<LightBvhNode<T>> nodes_;
  std::vector<std::uint64_t> trails_;
  std::vector<std::uint8_t> everywhere_;
  std::vector<std::int32_t> placeless_;
  LightBvhData<T> data_ = {};
  int depth_ = 0;
};

extern template class LightBvh<float>;
extern template class LightBvh<double>;

}  // namespace halfslope
