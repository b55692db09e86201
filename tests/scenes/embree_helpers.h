// Scenes and rays for the tests of Embree.
#pragma once

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "scenes/mesh_reader.h"
#include "scenes/ray_packet.h"
#include "scenes/scene.h"

namespace halfslope {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class Shape>
void add(Scene& scene, Shape shape) {
  Primitive primitive;
  primitive.shape = std::move(shape);
  primitive.id = "shape" + std::to_string(scene.primitives.size() + 1);
  scene.primitives.push_back(std::move(primitive));
}

/// One of each shape, apart from each other.
inline Scene mixed_scene() {
  Scene scene;
  Eigen::Affine3d move = Eigen::Translation3d(2, 2, 0) * Eigen::AngleAxisd(0.7, Vec3(2, 1, 2) / 3);
  add(scene, std::make_shared<const Mesh>(transformed(make_cube(), move.matrix(), false, false)));
  add(scene, Sphere{{-2, 2, 0}, 1.2});
  add(scene, Flat{{-2, -2, 0}, {1, 0, 0.3}, {0, 1.5, 0}, Vec3(-0.3, 0, 1).normalized()});
  add(scene, Flat{{0, 0, -2.5}, {1, 1, 0}, {-2, 2, 0}, {0, 0, 1}, Flat::Outline::kDisk});
  add(scene, Cylinder{{2, -3, -1}, {2.5, -1, 1}, 0.8});
  return scene;
}

/// A closed mesh: an octahedron's faces cut into n² each and moved onto the unit sphere.
inline Mesh round_mesh(int n) {
  Mesh mesh;
  for (int face = 0; face < 8; ++face) {
    const double sx = face & 1 ? -1 : 1, sy = face & 2 ? -1 : 1, sz = face & 4 ? -1 : 1;
    const auto at = [&](int i, int j) {
      const Vec3 p = Vec3(sx * i, sy * j, sz * (n - i - j)).normalized();
      mesh.positions.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
      return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (sx * sy * sz < 0) std::swap(b, c);
      mesh.triangles.push_back({a, b, c});
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return mesh;
}

inline Scene round_scene(int n) {
  Scene scene;
  add(scene, std::make_shared<const Mesh>(round_mesh(n)));
  return scene;
}

/// Rays from around towards the middle of the scene; one in four of the packets goes much the same way.
inline std::vector<RayPacket> random_rays(int packets, double around) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<RayPacket> rays(static_cast<std::size_t>(packets));
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    const Vec3 shared_origin = around * vector().normalized(), shared_target = vector();
    for (int i = 0; i < 16; ++i) {
      const Vec3 origin = p % 4 ? Vec3(around * vector().normalized()) : shared_origin;
      const Vec3 target = p % 4 ? vector() : Vec3(shared_target + 0.01 * vector());
      const Vec3 direction = (target - origin).normalized();
      rays[p].ox[i] = static_cast<float>(origin.x());
      rays[p].oy[i] = static_cast<float>(origin.y());
      rays[p].oz[i] = static_cast<float>(origin.z());
      rays[p].dx[i] = static_cast<float>(direction.x());
      rays[p].dy[i] = static_cast<float>(direction.y());
      rays[p].dz[i] = static_cast<float>(direction.z());
      rays[p].tnear[i] = 0;
      rays[p].tfar[i] = kInfinity;
      rays[p].active[i] = -1;
    }
  }
  return rays;
}

inline Ray ray_of(const RayPacket& packet, int i) {
  return {{packet.ox[i], packet.oy[i], packet.oz[i]}, Vec3(packet.dx[i], packet.dy[i], packet.dz[i]).normalized()};
}

inline void copy_ray(const RayPacket& from, int i, RayPacket& to, int j) {
  for (const auto field : {&RayPacket::ox, &RayPacket::oy, &RayPacket::oz, &RayPacket::dx, &RayPacket::dy,
                           &RayPacket::dz, &RayPacket::tnear, &RayPacket::tfar})
    (to.*field)[j] = (from.*field)[i];
  to.active[j] = from.active[i];
}

inline bool same_bits(const RayPacket& a, int i, const RayPacket& b, int j) {
  return a.primitive[i] == b.primitive[j] && a.triangle[i] == b.triangle[j] &&
         std::bit_cast<std::uint32_t>(a.tfar[i]) == std::bit_cast<std::uint32_t>(b.tfar[j]) &&
         std::bit_cast<std::uint32_t>(a.u[i]) == std::bit_cast<std::uint32_t>(b.u[j]) &&
         std::bit_cast<std::uint32_t>(a.v[i]) == std::bit_cast<std::uint32_t>(b.v[j]);
}

}  // namespace halfslope
