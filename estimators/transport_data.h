// A scene as the transport kernels see it (estimators/transport_scene.h), with the arrays that it points to.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "estimators/transport_calls.h"
#include "scenes/embree_scene.h"
#include "scenes/environment_map.h"
#include "scenes/intersector.h"
#include "scenes/light_bvh.h"
#include "scenes/scene.h"

namespace halfslope {

/// How a scene is traced by kernels: by Embree, or by our own shapes in lengths of their own.
struct Tracing {
  std::shared_ptr<const EmbreeScene> embree;  ///< null: our own shapes
  Vec3 middle = Vec3::Zero();                 ///< where the kernels' origin is in the scene
  double unit = 1;                            ///< the kernels' lengths are the scene's, less `middle`, times this

  Vec3 to_kernel(const Vec3& p) const { return unit * (p - middle); }
};
/// Holds every shape, with room to spare.
Eigen::AlignedBox3d bounds_of(const Scene& scene);

Tracing tracing_of(const Scene& scene, const Intersector& intersector);

/// A light of one piece, or none, as chosen from.
struct LightSource {
  LightKind kind;
  int primitive = -1, triangle = 0;  ///< −1: no surface
  std::size_t delta = 0;             ///< its place among the scene's delta lights
  Rgb radiance = Rgb::Zero();        ///< LightElement's
  double area = 0;                   ///< of the piece, in the scene's lengths
  double power = 0;                  ///< emitted, of its mean channel; what falls on the scene from beyond it
  double share = 1;                  ///< of its emitter: a triangle's of its mesh by area
};

/// The lights of a scene that emit anything: those of surfaces in their order, delta lights, the environment. First all
/// that are somewhere, then those infinitely far away.
std::vector<LightSource> list_lights(const Scene& scene);

/// The scene itself. Throws Error(kBadInput) where it has none.
Scene with_lights(Scene scene);

/// What of the scene's light no light technique's samples reach, in words; empty: they reach all.
std::string missed_by_lights(const Scene& scene);

/// Whether only a connection finds such a light.
bool is_delta(LightKind kind);

/// Whether some BSDF of the scene draws a number to choose between lobes.
bool chooses_lobes(const Scene& scene);

/// One scene in one precision. Immutable once made; shared by threads.
template <class T>
class TransportData {
 public:
  /// Keeps what it needs of `scene`, textures' and the environment's images apart, which must outlive it.
  /// The first `chosen` of the lights are chosen from; the others are delta lights that something else takes care of.
  TransportData(const Scene& scene, const Tracing& tracing, const std::vector<LightSource>& lights, std::size_t chosen);
  TransportData(const TransportData&) = delete;
  TransportData& operator=(const TransportData&) = delete;

  const TransportScene<T>& scene() const { return scene_; }

 private:
  /// Of a primitive's triangle; 0 of a shape that is no mesh.
  std::int32_t piece(int primitive, int triangle) const;
  /// The sides of each primitive, made of the materials.
  std::vector<PieceSides> add_materials(const Scene& scene);
  void add_pieces(const Scene& scene, const Tracing& tracing, const std::vector<PieceSides>& sides);
  void add_lights(const Scene& scene, const Tracing& tracing, const std::vector<LightSource>& lights,
                  std::size_t chosen);

  TransportScene<T> scene_ = {};
  std::shared_ptr<const EmbreeScene> embree_;
  std::vector<FlatPiece<T>> flats_;
  std::vector<FlatTest<T>> tests_;
  std::vector<SpherePiece<T>> spheres_;
  std::vector<CylinderPiece<T>> cylinders_;
  std::vector<PieceSides> sides_;
  std::vector<std::int32_t> first_piece_;
  std::vector<std::vector<std::int32_t>> merged_;  ///< of a mesh whose triangles were joined: the piece of each
  std::vector<TriangleAttributes> attributes_;
  std::vector<MaterialData<T>> materials_;
  std::vector<std::int32_t> material_class_;
  std::vector<T> opacities_;
  std::vector<MaterialTextures> material_textures_;
  std::vector<TextureData<T>> textures_;
  std::vector<LightElement<T>> lights_;
  std::vector<std::uint32_t> uniform_last_, power_last_, surface_last_;
  std::vector<T> uniform_probability_, power_probability_, surface_probability_;
  std::unique_ptr<EnvironmentMap<T>> environment_;
  std::unique_ptr<LightBvh<T>> bvh_;
};

extern template class TransportData<float>;
extern template class TransportData<double>;

/// A scene in the precisions that are asked for, each made once. Refers to the scene.
class LazyTransport {
 public:
  LazyTransport(const Scene& scene, const Tracing& tracing, bool draws_delta_lights);

  template <class T>
  const TransportData<T>& of() const {
    auto& [once, data] = std::get<Made<T>>(made_);
    std::call_once(once, [&] { data = std::make_unique<const TransportData<T>>(scene_, tracing_, lights_, chosen_); });
    return *data;
  }
  const std::vector<LightSource>& lights() const { return lights_; }
  /// How many of them are chosen from.
  std::size_t chosen() const { return chosen_; }

 private:
  template <class T>
  struct Made {
    std::once_flag once;
    std::unique_ptr<const TransportData<T>> data;
  };
  const Scene& scene_;
  const Tracing& tracing_;
  std::vector<LightSource> lights_;
  std::size_t chosen_;
  mutable std::tuple<Made<float>, Made<double>> made_;
};

}  // namespace halfslope
