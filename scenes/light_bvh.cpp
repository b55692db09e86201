#include "scenes/light_bvh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace halfslope {
namespace {

using Vec3 = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;
constexpr double kPi = std::numbers::pi;

/// What a node bounds. Angles are in radians: θ_o of the normals about the axis, θ_e of emission about a normal.
struct Bounds {
  Box box;
  Vec3 axis = Vec3::UnitZ();
  double normals = 0, emission = 0, power = 0;
  bool two_sided = false;
};

/// Widens a's cone of normals to the least that holds b's too (Conty Estevez and Kulla, algorithm 1).
void merge_cones(Bounds& a, const Bounds& b) {
  if (a.normals >= kPi) return;
  const bool first_wider = a.normals >= b.normals;
  const Vec3 wide = first_wider ? a.axis : b.axis, narrow = first_wider ? b.axis : a.axis;
  const double wide_angle = std::max(a.normals, b.normals), narrow_angle = std::min(a.normals, b.normals);
  const Vec3 across = wide.cross(narrow);
  const double between = std::atan2(across.norm(), wide.dot(narrow));
  a.axis = wide, a.normals = wide_angle;
  if (std::min(between + narrow_angle, kPi) <= wide_angle) return;
  a.normals = std::min(0.5 * (wide_angle + between + narrow_angle), kPi);
  if (across.norm() > 0) {
    a.axis = (Eigen::AngleAxisd(a.normals - wide_angle, across.normalized()) * wide).normalized();
  } else {
    a.normals = kPi;
  }
}

/// Lights of no power emit nothing that a bound must hold, but for where they are.
Bounds united(const Bounds& a, const Bounds& b) {
  Bounds both = a.power > 0 || b.power == 0 ? a : b;
  both.box = a.box.merged(b.box);
  both.power = a.power + b.power;
  if (a.power == 0 || b.power == 0) return both;
  both.two_sided = a.two_sided || b.two_sided;
  both.emission = std::max(a.emission, b.emission);
  merge_cones(both, b);
  return both;
}

/// The surface area orientation heuristic's measure of one side (ibid., eq. 1 and 2); a box without area still counts
/// by its length.
double measure(const Bounds& b) {
  const Vec3 size = b.box.sizes();
  const double area = size.x() * size.y() + size.y() * size.z() + size.z() * size.x() + 1e-3 * size.squaredNorm();
  const double o = b.normals, w = std::min(o + b.emission, kPi);
  const double cone = 2 * kPi * (1 - std::cos(o)) +
                      0.5 * kPi * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
  return b.power * area * cone;
}

struct Item {
  std::int32_t leaf;
  Bounds bounds;
  Vec3 middle;
};

constexpr std::size_t kBuckets = 12, kMany = 1024;
constexpr int kHeuristicDepth = 32;  ///< below it nodes are halved by number, so that 2³¹ leaves need 64 levels at most

/// Where `items` are best cut, reordering them: by the heuristic over buckets of the axis, or into halves.
std::size_t cut(std::span<Item> items, int depth) {
  Box middles;
  for (const Item& item : items) middles.extend(item.middle);
  Eigen::Index longest;
  middles.sizes().maxCoeff(&longest);
  const auto halves = [&] {
    const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
    std::nth_element(items.begin(), middle, items.end(),
                     [&](const Item& a, const Item& b) { return a.middle[longest] < b.middle[longest]; });
    return items.size() / 2;
  };
  if (!(middles.sizes()[longest] > 0) || depth >= kHeuristicDepth) return halves();
  double best = std::numeric_limits<double>::infinity();
  Eigen::Index best_axis = longest;
  std::size_t best_bucket = 0;
  const auto bucket_of = [&](const Item& item, Eigen::Index axis) {
    const double along = (item.middle[axis] - middles.min()[axis]) / middles.sizes()[axis];
    return std::min(static_cast<std::size_t>(along * static_cast<double>(kBuckets)), kBuckets - 1);
  };
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    // Of many lights the longest axis is as good as the best, and a third of the work.
    if (!(middles.sizes()[axis] > 0) || (items.size() > kMany && axis != longest)) continue;
    struct Bucket {
      Bounds bounds;
      bool any = false;
      void add(const Bounds& b) {
        bounds = any ? united(bounds, b) : b;
        any = true;
      }
    };
    std::array<Bucket, kBuckets> buckets;
    for (const Item& item : items) buckets[bucket_of(item, axis)].add(item.bounds);
    std::array<double, kBuckets> above = {};  // of all buckets after k
    Bucket sum;
    for (std::size_t k = kBuckets - 1; k > 0; --k) {
      if (buckets[k].any) sum.add(buckets[k].bounds);
      above[k - 1] = sum.any ? measure(sum.bounds) : std::numeric_limits<double>::infinity();
    }
    const double thinness = middles.sizes()[longest] / middles.sizes()[axis];  // long thin halves cost more
    sum = {};
    for (std::size_t k = 0; k + 1 < kBuckets; ++k) {
      if (buckets[k].any) sum.add(buckets[k].bounds);
      if (!sum.any) continue;
      const double cost = thinness * (measure(sum.bounds) + above[k]);
      if (cost < best) best = cost, best_axis = axis, best_bucket = k;
    }
  }
  if (!(best < std::numeric_limits<double>::infinity())) return halves();
  const auto after =
      std::partition(items.begin(), items.end(), [&](const Item& i) { return bucket_of(i, best_axis) <= best_bucket; });
  return static_cast<std::size_t>(after - items.begin());
}

template <class T>
struct Builder {
  std::vector<LightBvhNode<T>>& nodes;
  std::vector<std::uint64_t>& trails;
  int deepest = 0;

  Bounds build(std::span<Item> items, int depth, std::uint64_t trail) {
    deepest = std::max(deepest, depth);
    const std::size_t index = nodes.size();
    nodes.emplace_back();
    Bounds bounds = items.front().bounds;
    nodes[index].leaf = -1;
    if (items.size() == 1) {
      nodes[index].leaf = items.front().leaf;
      trails[static_cast<std::size_t>(items.front().leaf)] = trail;
    } else {
      const std::size_t middle = cut(items, depth);
      bounds = build(items.first(middle), depth + 1, trail);
      const auto right = static_cast<std::int32_t>(nodes.size());
      bounds = united(bounds, build(items.subspan(middle), depth + 1, trail | std::uint64_t{1} << depth));
      nodes[index].right = right;
    }
    write(bounds, nodes[index]);
    return bounds;
  }

  static void write(const Bounds& bounds, LightBvhNode<T>& node) {
    const Vec3 center = bounds.box.center();
    double squares = 0;
    for (int k = 0; k < 3; ++k) {
      node.center[k] = static_cast<T>(center[k]);
      node.axis[k] = static_cast<T>(bounds.axis[k]);
      // The corner farthest from the rounded centre, and a rounding more.
      const double far = std::max(bounds.box.max()[k] - static_cast<double>(node.center[k]),
                                  static_cast<double>(node.center[k]) - bounds.box.min()[k]);
      squares += far * far;
    }
    node.radius_squared = static_cast<T>(squares * (1 + 2 * static_cast<double>(std::numeric_limits<T>::epsilon())));
    node.cos_normals = static_cast<T>(std::cos(bounds.normals));
    node.sin_normals = static_cast<T>(std::sin(bounds.normals));
    node.cos_emission = static_cast<T>(std::cos(bounds.emission));
    node.power = static_cast<T>(bounds.power);
    node.two_sided = bounds.two_sided ? 1 : 0;
  }
};

Bounds bounds_of(const LightLeaf& leaf) {
  Bounds bounds;
  bounds.box =
      Box(Vec3(leaf.lower[0], leaf.lower[1], leaf.lower[2]), Vec3(leaf.upper[0], leaf.upper[1], leaf.upper[2]));
  bounds.axis = Vec3(leaf.axis[0], leaf.axis[1], leaf.axis[2]);
  bounds.normals = std::acos(std::clamp(leaf.cos_normals, -1.0, 1.0));
  bounds.emission = std::acos(std::clamp(leaf.cos_emission, -1.0, 1.0));
  bounds.power = leaf.power;
  bounds.two_sided = leaf.two_sided;
  return bounds;
}

}  // namespace

template <class T>
LightBvh<T>::LightBvh(std::span<const LightLeaf> leaves) : trails_(leaves.size()) {
  std::vector<Item> items;
  double power = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto leaf = static_cast<std::int32_t>(i);
    everywhere_.push_back(leaves[i].everywhere ? 1 : 0);
    if (leaves[i].everywhere) {
      placeless_.push_back(leaf);
      continue;
    }
    const Bounds bounds = bounds_of(leaves[i]);
    power = std::max(power, bounds.power);
    items.push_back({leaf, bounds, bounds.box.center()});
  }
  // Only shares matter: whatever the unit of power, none leaves the range of T.
  for (Item& item : items) item.bounds.power = power > 0 ? item.bounds.power / power : 0;
  if (!items.empty()) {
    nodes_.reserve(2 * items.size());
    Builder<T> builder{nodes_, trails_};
    builder.build(items, 0, 0);
    depth_ = builder.deepest;
  }
  data_.nodes = nodes_.empty() ? nullptr : nodes_.data();
  data_.trails = trails_.data(), data_.everywhere = everywhere_.data(), data_.placeless = placeless_.data();
  data_.leaf_count = static_cast<std::int32_t>(leaves.size());
  data_.placeless_count = static_cast<std::int32_t>(placeless_.size());
}

template class LightBvh<float>;
template class LightBvh<double>;

}  // namespace halfslope
