#include "scenes/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/kernel_library.h"
#include "scenes/embree_shapes.h"
#include "scenes/packet_triangles.h"

namespace halfslope {
namespace {

static_assert(RayPacket::kLanes == 16 && offsetof(RayPacket, active) == sizeof(RTCRayHit16));
static_assert(offsetof(RayPacket, tnear) == offsetof(RTCRayHit16, ray.tnear));
static_assert(offsetof(RayPacket, dz) == offsetof(RTCRayHit16, ray.dir_z));
static_assert(offsetof(RayPacket, tfar) == offsetof(RTCRayHit16, ray.tfar));
static_assert(offsetof(RayPacket, mask) == offsetof(RTCRayHit16, ray.mask));
static_assert(offsetof(RayPacket, u) == offsetof(RTCRayHit16, hit.u));
static_assert(offsetof(RayPacket, triangle) == offsetof(RTCRayHit16, hit.primID));
static_assert(offsetof(RayPacket, primitive) == offsetof(RTCRayHit16, hit.geomID));

/// Embree leaves out what lies beyond 1.8e18, without a word.
constexpr double kReach = 1e18;

const char* device_configuration() {
  // No number of threads: it would bind the whole process while the device lives. The hierarchy is the same for any.
  return active_isa() == Isa::kBaseline ? "isa=sse2,set_affinity=0" : "isa=avx2,set_affinity=0";
}

}  // namespace

struct EmbreeScene::Impl {
  /// The three corners of a mesh's triangle, side by side: reading them again after a hit waits for memory once.
  using Triangle = std::array<float, 9>;

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  using UserShapes = std::variant<std::monostate, UserShape<Sphere>, UserShape<Flat>, UserShape<Cylinder>>;
  std::vector<UserShapes> shapes;             ///< a mesh is empty here
  double margin = 0;                          ///< of their boxes
  std::vector<std::vector<Triangle>> meshes;  ///< of each primitive; empty where it is no mesh
  std::string error;
  float extent = 0;  ///< the longest side of the scene's box
  /// Whether rays may be taken through the hierarchy together. By AVX2 a ray then meets what it meets alone; by SSE2,
  /// one in a million does not.
  bool together = active_isa() != Isa::kBaseline;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  static void on_error(void* impl, RTCError, const char* text) {
    auto& error = static_cast<Impl*>(impl)->error;
    if (error.empty()) error = text && *text ? text : "no reason given";
  }

  void check(std::string_view what) const {
    if (!error.empty()) fail(ExitCode::kBadInput, "Embree, {}: {}", what, error);
  }

  void add(const std::shared_ptr<const Mesh>& mesh, unsigned id);
  template <class Shape>
  void add(const Shape& shape, unsigned id);
  void attach(RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
  /// The corners of the triangles that a packet met. All are asked for before the first is read: they may be far away.
  void gather(const RayPacket& packet, PacketTriangles& triangles) const {
    std::array<const Triangle*, RayPacket::kLanes> met = {};
    for (std::size_t i = 0; i < RayPacket::kLanes; ++i) {
      if (packet.primitive[i] < 0) continue;
      const std::vector<Triangle>& mesh = meshes[static_cast<std::size_t>(packet.primitive[i])];
      if (mesh.empty()) continue;
      met[i] = &mesh[static_cast<std::size_t>(packet.triangle[i])];
      __builtin_prefetch(met[i]);
      triangles.present[i] = -1;
    }
    for (std::size_t i = 0; i < RayPacket::kLanes; ++i) {
      if (!met[i]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        triangles.x[k][i] = static_cast<double>((*met[i])[3 * k]);
        triangles.y[k][i] = static_cast<double>((*met[i])[3 * k + 1]);
        triangles.z[k][i] = static_cast<double>((*met[i])[3 * k + 2]);
      }
    }
  }
};

void EmbreeScene::Impl::add(const std::shared_ptr<const Mesh>& mesh, unsigned id) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto copy = [&](RTCBufferType type, RTCFormat format, const auto& values) {
    void* memory = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(values[0]), values.size());
    check("a mesh");
    std::memcpy(memory, values.data(), values.size() * sizeof(values[0]));
  };
  copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh->positions);
  copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh->triangles);
  attach(geometry, id);
  meshes[id].reserve(mesh->triangles.size());
  for (const auto& [i, j, k] : mesh->triangles) {
    const Mesh::Point &p = mesh->positions[i], &q = mesh->positions[j], &r = mesh->positions[k];
    meshes[id].push_back({p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2]});
  }
}

template <class Shape>
void EmbreeScene::Impl::add(const Shape& shape, unsigned id) {
  shapes[id] = UserShape<Shape>{shape, margin};
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  set_callbacks(geometry, std::get<UserShape<Shape>>(shapes[id]));
  attach(geometry, id);
}

EmbreeScene::EmbreeScene(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  double largest = scene.sensor.origin.cwiseAbs().maxCoeff();
  for (const Ray& ray : scene.sensor.rays) largest = std::max(largest, ray.origin.cwiseAbs().maxCoeff());
  for (const Primitive& primitive : scene.primitives) {
    const double reach = middle(primitive).cwiseAbs().maxCoeff() + extent(primitive);
    if (!(reach < kReach))
      fail(ExitCode::kBadInput, "shape '{}' reaches {} from the origin, allowed: less than {}", primitive.id, reach,
           kReach);
    largest = std::max(largest, reach);
  }
  // Boxes of shapes that are no mesh are met in binary32 without the robust mode's care: a ray from x misses by 2⁻²³ x.
  impl_->margin = 4 * 0x1p-23 * largest;
  impl_->device = rtcNewDevice(device_configuration());
  if (!impl_->device)
    fail(ExitCode::kBadInput, "Embree, a device: error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
  rtcSetDeviceErrorFunction(impl_->device, Impl::on_error, impl_.get());
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  impl_->shapes.resize(scene.primitives.size());
  impl_->meshes.resize(scene.primitives.size());
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    std::visit([&](const auto& shape) { impl_->add(shape, static_cast<unsigned>(i)); }, scene.primitives[i].shape);
  }
  rtcCommitScene(impl_->scene);
  impl_->check("a scene");
  RTCBounds box;
  rtcGetSceneBounds(impl_->scene, &box);
  impl_->extent = std::max({box.upper_x - box.lower_x, box.upper_y - box.lower_y, box.upper_z - box.lower_z});
}

EmbreeScene::~EmbreeScene() = default;

namespace {

/// Makes a packet ready for Embree, which looks at tnear ≤ tfar rather than at the mask it is given, and stops the
/// program at a ray that is not finite. Puts the intervals of lanes that are not traced back in the end.
class Traced {
 public:
  explicit Traced(RayPacket& packet) : packet_(packet) {
    // Without branches, so that it is done several lanes at a time.
    for (std::size_t i = 0; i < RayPacket::kLanes; ++i) {
      const auto near = [](float x) { return static_cast<int>(std::abs(x) < static_cast<float>(kReach)); };
      const int traced = static_cast<int>(packet.active[i] != 0) & near(packet.ox[i]) & near(packet.oy[i]) &
                         near(packet.oz[i]) & near(packet.dx[i]) & near(packet.dy[i]) & near(packet.dz[i]) &
                         static_cast<int>(packet.tnear[i] >= 0) & static_cast<int>(packet.tnear[i] <= packet.tfar[i]);
      mask_[i] = traced ? -1 : 0;
      tnear_[i] = packet.tnear[i];
      tfar_[i] = packet.tfar[i];
      packet.tnear[i] = traced ? packet.tnear[i] : 1;
      packet.tfar[i] = traced ? packet.tfar[i] : -1;
      packet.time[i] = 0;
      packet.mask[i] = ~std::uint32_t{0};
      packet.flags[i] = 0;
    }
  }
  Traced(const Traced&) = delete;
  Traced& operator=(const Traced&) = delete;
  ~Traced() {
    for (std::size_t i = 0; i < RayPacket::kLanes; ++i) {
      packet_.tnear[i] = tnear_[i];
      packet_.tfar[i] = mask_[i] ? packet_.tfar[i] : tfar_[i];
    }
  }

  const int* mask() const { return mask_.data(); }

  /// Whether the rays go much the same way from much the same place: Embree then takes them through the hierarchy
  /// together, which is faster by half, and slower by as much where it is not so.
  bool go_together(float extent) const {
    const auto first = static_cast<std::size_t>(std::find(mask_.begin(), mask_.end(), -1) - mask_.begin());
    if (first == mask_.size()) return false;
    const auto near = [&](const float* values, float distance) {
      int far = 0;
      for (std::size_t i = 0; i < RayPacket::kLanes; ++i)
        far += mask_[i] & static_cast<int>(std::abs(values[i] - values[first]) > distance);
      return far == 0;
    };
    return near(packet_.dx, kTurn) && near(packet_.dy, kTurn) && near(packet_.dz, kTurn) &&
           near(packet_.ox, 0.01F * extent) && near(packet_.oy, 0.01F * extent) && near(packet_.oz, 0.01F * extent);
  }

 private:
  static constexpr float kTurn = 0.03F;
  RayPacket& packet_;
  alignas(64) std::array<std::int32_t, RayPacket::kLanes> mask_;
  std::array<float, RayPacket::kLanes> tnear_, tfar_;
};

}  // namespace

void EmbreeScene::first(RayPacket& packet) const {
  const Traced traced(packet);
  std::fill_n(packet.primitive, RayPacket::kLanes, -1);
  std::fill_n(packet.triangle, RayPacket::kLanes, 0);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (impl_->together && traced.go_together(impl_->extent)) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(traced.mask(), impl_->scene, &context, reinterpret_cast<RTCRayHit16*>(&packet));
  PacketTriangles triangles;
  impl_->gather(packet, triangles);
  meet_triangles(triangles, packet);
}

void EmbreeScene::occluded(RayPacket& packet) const {
  const Traced traced(packet);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (impl_->together && traced.go_together(impl_->extent)) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(traced.mask(), impl_->scene, &context, reinterpret_cast<RTCRay16*>(&packet));
}

void EmbreeScene::first_of(const void* scene, RayPacket* packet) {
  static_cast<const EmbreeScene*>(scene)->first(*packet);
}

void EmbreeScene::occluded_of(const void* scene, RayPacket* packet) {
  static_cast<const EmbreeScene*>(scene)->occluded(*packet);
}

EmbreeScene::Found EmbreeScene::first(const Ray& ray) const {
  RTCRayHit hit = {};
  const auto set = [](float& x, float& y, float& z, const Vec3& v) {
    x = static_cast<float>(v.x());
    y = static_cast<float>(v.y());
    z = static_cast<float>(v.z());
  };
  set(hit.ray.org_x, hit.ray.org_y, hit.ray.org_z, ray.origin);
  set(hit.ray.dir_x, hit.ray.dir_y, hit.ray.dir_z, ray.direction);
  hit.ray.tfar = std::numeric_limits<float>::infinity();
  hit.ray.mask = ~std::uint32_t{0};
  hit.hit.geomID = hit.hit.primID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {static_cast<std::int32_t>(hit.hit.geomID), static_cast<std::int32_t>(hit.hit.primID),
          static_cast<double>(hit.ray.tfar), static_cast<double>(hit.hit.u), static_cast<double>(hit.hit.v)};
}

}  // namespace halfslope
