// Rays a second. EmbreeScene::first, which computes each hit again, against a bare loop of rtcIntersect16 on the same
// rays and a million triangles: at least 0.7 of it. And Embree against trying each of a few triangles, which says up to
// how many that is faster (scenes/intersector.h's kHandful).
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/triangle_packets.h"
#include "scenes/embree_scene.h"
#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

/// n × 2n × 2 triangles on a sphere with bumps.
std::shared_ptr<const Mesh> bumpy_sphere(std::uint32_t n) {
  auto mesh = std::make_shared<Mesh>();
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= 2 * n; ++j) {
      const double theta = std::numbers::pi * (i + 0.5) / (n + 1), phi = std::numbers::pi * j / n;
      const double r = 1 + 0.05 * std::sin(20 * theta) * std::cos(30 * phi);
      mesh->positions.push_back({static_cast<float>(r * std::sin(theta) * std::cos(phi)),
                                 static_cast<float>(r * std::sin(theta) * std::sin(phi)),
                                 static_cast<float>(r * std::cos(theta))});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const std::uint32_t a = i * (2 * n + 1) + j, below = a + 2 * n + 1;
      mesh->triangles.push_back({a, below, a + 1});
      mesh->triangles.push_back({a + 1, below, below + 1});
    }
  }
  return mesh;
}

/// Triangles of about the size of the walls of a box, in [-1, 1]³.
std::shared_ptr<const Mesh> some_triangles(int count) {
  auto mesh = std::make_shared<Mesh>();
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh->positions.size());
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    for (int k = 0; k < 3; ++k)
      mesh->positions.push_back({x + 0.4F * uniform(random), y + 0.4F * uniform(random), z + 0.4F * uniform(random)});
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Scene scene_of(std::shared_ptr<const Mesh> mesh) {
  Scene scene;
  scene.primitives.emplace_back().shape = std::move(mesh);
  return scene;
}

/// From a sphere of radius 2 to places within the unit cube. Together: the rays of a packet leave from one place,
/// within a hundredth of a radian.
std::vector<RayPacket> make_rays(int packets, bool together) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  std::vector<RayPacket> rays(static_cast<std::size_t>(packets));
  for (RayPacket& packet : rays) {
    packet = {};
    Vec3 origin = Vec3::Zero(), target = Vec3::Zero();
    for (int i = 0; i < RayPacket::kLanes; ++i) {
      if (i == 0 || !together) {
        origin = 2 * Vec3(normal(random), normal(random), normal(random)).normalized();
        target = Vec3(uniform(random), uniform(random), uniform(random));
      }
      const Vec3 spread =
          together ? 0.01 * Vec3(uniform(random), uniform(random), uniform(random)) : Vec3(Vec3::Zero());
      const Vec3 direction = (target + spread - origin).normalized();
      packet.ox[i] = static_cast<float>(origin.x());
      packet.oy[i] = static_cast<float>(origin.y());
      packet.oz[i] = static_cast<float>(origin.z());
      packet.dx[i] = static_cast<float>(direction.x());
      packet.dy[i] = static_cast<float>(direction.y());
      packet.dz[i] = static_cast<float>(direction.z());
      packet.tfar[i] = std::numeric_limits<float>::infinity();
      packet.mask[i] = ~std::uint32_t{0};
      packet.primitive[i] = packet.triangle[i] = -1;
      packet.active[i] = -1;
    }
  }
  return rays;
}

/// Traces copies of the same packets over and over; `trace` takes one.
template <class Trace>
void run(benchmark::State& state, const std::vector<RayPacket>& rays, const Trace& trace) {
  std::size_t next = 0;
  RayPacket packet;
  for (auto _ : state) {
    packet = rays[next];
    trace(packet);
    benchmark::DoNotOptimize(packet);
    next = next + 1 < rays.size() ? next + 1 : 0;
  }
  state.SetItemsProcessed(state.iterations() * RayPacket::kLanes);
}

/// Embree and nothing else: its own scene with the robust mode, and rays that are ready for it.
class BareEmbree {
 public:
  BareEmbree(const Mesh& mesh, const char* configuration)
      : device_(rtcNewDevice(configuration)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Mesh::Point),
                                        mesh.positions.size()),
                mesh.positions.data(), mesh.positions.size() * sizeof(Mesh::Point));
    std::memcpy(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()),
        mesh.triangles.data(), mesh.triangles.size() * 12);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  void first(RayPacket& packet, bool together) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (together) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(packet.active, scene_, &context, reinterpret_cast<RTCRayHit16*>(&packet));
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

std::vector<TrianglePlanes> planes_of(const Mesh& mesh) {
  std::vector<TrianglePlanes> planes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 p0 = corner(mesh, t, 0), a = corner(mesh, t, 1) - p0, b = corner(mesh, t, 2) - p0, n = a.cross(b);
    const auto set = [&](float* plane, const Vec3& normal) {
      for (int k = 0; k < 3; ++k) plane[k] = static_cast<float>(normal[k]);
      plane[3] = static_cast<float>(-normal.dot(p0));
    };
    TrianglePlanes& one = planes.emplace_back();
    set(one.plane, n);
    set(one.u, b.cross(n) / n.squaredNorm());
    set(one.v, n.cross(a) / n.squaredNorm());
  }
  return planes;
}

void million(benchmark::State& state, const std::string& how, bool together) {
  static const std::shared_ptr<const Mesh> mesh = bumpy_sphere(500);
  const std::vector<RayPacket> rays = make_rays(20000, together);
  if (how == "ours") {
    const EmbreeScene embree(scene_of(mesh));
    run(state, rays, [&](RayPacket& packet) { embree.first(packet); });
  } else {
    const BareEmbree embree(*mesh, ("threads=1,isa=" + how).c_str());
    run(state, rays, [&](RayPacket& packet) { embree.first(packet, together); });
  }
}

void few(benchmark::State& state, const std::string& how, int count, bool together) {
  const std::shared_ptr<const Mesh> mesh = some_triangles(count);
  const std::vector<RayPacket> rays = make_rays(2000, together);
  if (how == "embree") {
    const EmbreeScene embree(scene_of(mesh));
    run(state, rays, [&](RayPacket& packet) { embree.first(packet); });
  } else {
    const std::vector<TrianglePlanes> planes = planes_of(*mesh);
    run(state, rays, [&](RayPacket& packet) { first_of_triangles(planes.data(), planes.size(), &packet); });
  }
}

void register_all() {
  for (const bool together : {false, true}) {
    const std::string rays = together ? "together/" : "apart/";
    for (const std::string how : {"avx2", "avx512", "ours"}) {
      benchmark::RegisterBenchmark(("million/" + rays + how).c_str(),
                                   [=](benchmark::State& state) { million(state, how, together); });
    }
    for (const int count : {8, 16, 32, 64, 128, 256}) {
      for (const std::string how : {"each", "embree"}) {
        benchmark::RegisterBenchmark(("few/" + rays + std::to_string(count) + "/" + how).c_str(),
                                     [=](benchmark::State& state) { few(state, how, count, together); });
      }
    }
  }
}

}  // namespace
}  // namespace halfslope

int main(int argc, char** argv) {
  halfslope::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
