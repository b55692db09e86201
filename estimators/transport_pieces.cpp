#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/transport_data.h"
#include "scenes/shape_hits.h"

namespace halfslope {
namespace {

template <class T>
void copy(const Vec3& from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
}

/// A flat piece before it is rounded, in the kernels' lengths.
struct PlainFlat {
  Vec3 p0, u, v, normal;
  LightKind outline;
};

PlainFlat flat_of(const Flat& flat, const Tracing& tracing) {
  const Vec3 u = tracing.unit * flat.half_u, v = tracing.unit * flat.half_v, center = tracing.to_kernel(flat.center);
  if (flat.outline == Flat::Outline::kDisk) return {center, u, v, flat.normal, LightKind::kDisk};
  return {center - u - v, 2 * u, 2 * v, flat.normal, LightKind::kRectangle};
}

PlainFlat flat_of(const Mesh& mesh, std::size_t triangle, const Tracing& tracing) {
  const Vec3 p0 = corner(mesh, triangle, 0);
  const Vec3 u = tracing.unit * (corner(mesh, triangle, 1) - p0), v = tracing.unit * (corner(mesh, triangle, 2) - p0);
  return {tracing.to_kernel(p0), u, v, u.cross(v).normalized(), LightKind::kTriangle};
}

template <class T>
FlatPiece<T> rounded(const PlainFlat& flat, const Vec3& tangent) {
  FlatPiece<T> piece;
  copy(flat.p0, piece.p0), copy(flat.u, piece.u), copy(flat.v, piece.v);
  copy(flat.normal, piece.normal), copy(tangent, piece.tangent);
  piece.outline = static_cast<T>(flat.outline);
  return piece;
}

/// The dual basis: dual_u · u = 1, dual_u · v = 0, in the plane; and the other way round.
template <class T>
FlatTest<T> test_of(const PlainFlat& flat, std::int32_t piece) {
  const double area = flat.normal.dot(flat.u.cross(flat.v));
  const Vec3 dual_u = flat.v.cross(flat.normal) / area, dual_v = flat.normal.cross(flat.u) / area;
  FlatTest<T> test;
  copy(flat.normal, test.normal), copy(dual_u, test.dual_u), copy(dual_v, test.dual_v);
  test.plane = static_cast<T>(flat.normal.dot(flat.p0));
  test.offset_u = static_cast<T>(dual_u.dot(flat.p0));
  test.offset_v = static_cast<T>(dual_v.dot(flat.p0));
  test.piece = piece;
  return test;
}

/// Where the first texture coordinate grows on a triangle: ∂p/∂u of its corners' coordinates; its first edge where they
/// say nothing.
Vec3 tangent_of(const Mesh& mesh, std::size_t triangle, const PlainFlat& flat) {
  if (mesh.uvs.empty()) return flat.u.normalized();
  const auto uv = [&](std::size_t corner) -> Eigen::Vector2d {
    return Eigen::Vector2f(mesh.uvs[mesh.triangles[triangle][corner]].data()).cast<double>();
  };
  const Eigen::Vector2d along_u = uv(1) - uv(0), along_v = uv(2) - uv(0);
  const double determinant = along_u.x() * along_v.y() - along_u.y() * along_v.x();
  if (determinant == 0) return flat.u.normalized();
  return ((along_v.y() * flat.u - along_u.y() * flat.v) / determinant).stableNormalized();
}

TriangleAttributes attributes_of(const Mesh& mesh, std::size_t triangle) {
  TriangleAttributes attributes = {{}, {{0, 0}, {1, 0}, {0, 1}}};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const std::size_t index = mesh.triangles[triangle][corner];
    if (!mesh.normals.empty()) std::copy_n(mesh.normals[index].begin(), 3, attributes.normals[corner]);
    if (!mesh.uvs.empty()) std::copy_n(mesh.uvs[index].begin(), 2, attributes.uvs[corner]);
  }
  return attributes;
}

/// Whether two triangles are the halves of one parallelogram, (p0, p1, p2) and (p0, p2, p3), within a rounding of its
/// size; so most quadrilaterals of files are, and one test finds both.
bool joins(const Mesh& mesh, std::size_t first) {
  if (first + 1 >= mesh.triangles.size() || !mesh.normals.empty() || !mesh.uvs.empty()) return false;
  const auto &a = mesh.triangles[first], &b = mesh.triangles[first + 1];
  if (b[0] != a[0] || b[1] != a[2]) return false;
  const Vec3 p0 = corner(mesh, first, 0), p1 = corner(mesh, first, 1), p2 = corner(mesh, first, 2),
             p3 = corner(mesh, first + 1, 2);
  const double size = std::max({p0.cwiseAbs().maxCoeff(), p1.cwiseAbs().maxCoeff(), p2.cwiseAbs().maxCoeff()});
  return (p0 + p2 - p1 - p3).cwiseAbs().maxCoeff() <= std::numeric_limits<float>::epsilon() * size;
}

PlainFlat joined(const Mesh& mesh, std::size_t first, const Tracing& tracing) {
  const Vec3 p0 = corner(mesh, first, 0);
  const Vec3 u = tracing.unit * (corner(mesh, first, 1) - p0), v = tracing.unit * (corner(mesh, first + 1, 2) - p0);
  return {tracing.to_kernel(p0), u, v, u.cross(v).normalized(), LightKind::kRectangle};
}

bool needs_attributes(const Scene& scene) {
  return std::any_of(scene.primitives.begin(), scene.primitives.end(), [](const Primitive& primitive) {
    const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&primitive.shape);
    if (mesh && !(*mesh)->normals.empty()) return true;
    return primitive.bsdf.textured() || (primitive.back && primitive.back->textured());
  });
}

}  // namespace

Eigen::AlignedBox3d bounds_of(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Primitive& primitive : scene.primitives) {
    const Vec3 center = middle(primitive), reach = Vec3::Constant(extent(primitive));
    box.extend(center - reach), box.extend(center + reach);
  }
  return box;
}

Tracing tracing_of(const Scene& scene, const Intersector& intersector) {
  Tracing tracing;
  tracing.embree = intersector.embree();
  if (tracing.embree) return tracing;
  const Eigen::AlignedBox3d box = bounds_of(scene);
  if (box.isEmpty()) return tracing;
  tracing.middle = box.center();
  const double size = box.diagonal().stableNorm();
  if (size > 0) tracing.unit = std::exp2(-std::ilogb(size));
  return tracing;
}

template <class T>
void TransportData<T>::add_pieces(const Scene& scene, const Tracing& tracing, const std::vector<PieceSides>& sides) {
  std::vector<PlainFlat> plain;
  const bool attributed = needs_attributes(scene);
  const auto add_flat = [&](const PlainFlat& flat, const Vec3& tangent, const TriangleAttributes& attributes,
                            std::size_t surface) {
    plain.push_back(flat);
    flats_.push_back(rounded<T>(flat, tangent));
    if (attributed) attributes_.push_back(attributes);
    sides_.push_back(sides[surface]);
  };
  const TriangleAttributes none = {{}, {{0, 0}, {1, 0}, {0, 1}}};
  merged_.resize(scene.primitives.size());
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const Primitive& primitive = scene.primitives[p];
    first_piece_.push_back(static_cast<std::int32_t>(flats_.size()));
    if (const auto* flat = std::get_if<Flat>(&primitive.shape)) {
      const PlainFlat found = flat_of(*flat, tracing);
      add_flat(found, found.u.normalized(), none, p);
    }
    const auto* pointer = std::get_if<std::shared_ptr<const Mesh>>(&primitive.shape);
    if (!pointer) continue;
    const Mesh& mesh = **pointer;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      merged_[p].push_back(static_cast<std::int32_t>(flats_.size()));
      if (!tracing.embree && !primitive.emits && joins(mesh, t)) {
        merged_[p].push_back(static_cast<std::int32_t>(flats_.size()));
        const PlainFlat both = joined(mesh, t, tracing);
        add_flat(both, both.u.normalized(), none, p);
        ++t;
        continue;
      }
      const PlainFlat triangle = flat_of(mesh, t, tracing);
      add_flat(triangle, tangent_of(mesh, t, triangle), attributes_of(mesh, t), p);
    }
    if (tracing.embree) merged_[p].clear();
  }
  // Round pieces follow in the numbering.
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const auto* sphere = std::get_if<Sphere>(&scene.primitives[p].shape);
    if (!sphere) continue;
    SpherePiece<T> piece;
    copy(tracing.to_kernel(sphere->center), piece.center);
    piece.radius = static_cast<T>(tracing.unit * sphere->radius);
    piece.side = sphere->flip_normals ? T(-1) : T(1);
    copy(Vec3(sphere->from_world.row(0)), piece.x), copy(Vec3(sphere->from_world.row(1)), piece.y);
    copy(Vec3(sphere->from_world.row(2)), piece.z);
    first_piece_[p] = static_cast<std::int32_t>(flats_.size() + spheres_.size());
    spheres_.push_back(piece);
    sides_.push_back(sides[p]);
  }
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const auto* cylinder = std::get_if<Cylinder>(&scene.primitives[p].shape);
    if (!cylinder) continue;
    CylinderPiece<T> piece;
    const Vec3 axis = (cylinder->p1 - cylinder->p0).stableNormalized();
    copy(tracing.to_kernel(cylinder->p0), piece.p0), copy(axis, piece.axis);
    piece.length = static_cast<T>(tracing.unit * (cylinder->p1 - cylinder->p0).norm());
    piece.radius = static_cast<T>(tracing.unit * cylinder->radius);
    piece.side = cylinder->flip_normals ? T(-1) : T(1);
    const Vec3 across = cylinder->start - axis.dot(cylinder->start) * axis;
    copy(across.norm() > 0 ? Vec3(across.normalized()) : axis.unitOrthogonal(), piece.start);
    first_piece_[p] = static_cast<std::int32_t>(flats_.size() + spheres_.size() + cylinders_.size());
    cylinders_.push_back(piece);
    sides_.push_back(sides[p]);
  }

  scene_.flats = flats_.data(), scene_.spheres = spheres_.data(), scene_.cylinders = cylinders_.data();
  scene_.flat_count = static_cast<std::int32_t>(flats_.size());
  scene_.sphere_count = static_cast<std::int32_t>(spheres_.size());
  scene_.cylinder_count = static_cast<std::int32_t>(cylinders_.size());
  scene_.sides = sides_.data();
  scene_.first_piece = first_piece_.data();
  scene_.attributes = attributed ? attributes_.data() : nullptr;
  scene_.framed_flats = std::any_of(plain.begin(), plain.end(),
                                    [](const PlainFlat& flat) { return flat.outline != LightKind::kTriangle; });
  double reach = 0;
  for (const Primitive& primitive : scene.primitives) {
    reach =
        std::max(reach, tracing.to_kernel(middle(primitive)).cwiseAbs().maxCoeff() + tracing.unit * extent(primitive));
  }
  scene_.reach = static_cast<T>(reach);
  if (tracing.embree) {
    scene_.embree = tracing.embree.get();
    scene_.embree_first = EmbreeScene::first_of;
    scene_.embree_occluded = EmbreeScene::occluded_of;
    return;
  }
  for (const LightKind outline : {LightKind::kRectangle, LightKind::kTriangle, LightKind::kDisk}) {
    const std::size_t before = tests_.size();
    for (std::size_t f = 0; f < plain.size(); ++f) {
      if (plain[f].outline == outline) tests_.push_back(test_of<T>(plain[f], static_cast<std::int32_t>(f)));
    }
    const auto count = static_cast<std::int32_t>(tests_.size() - before);
    (outline == LightKind::kRectangle  ? scene_.parallelograms
     : outline == LightKind::kTriangle ? scene_.triangles
                                       : scene_.disks) = count;
  }
  scene_.tests = tests_.data();
}

template <class T>
std::int32_t TransportData<T>::piece(int primitive, int triangle) const {
  const auto p = static_cast<std::size_t>(primitive);
  if (!merged_[p].empty()) return merged_[p][static_cast<std::size_t>(triangle)];
  return first_piece_[p] + triangle;
}

template void TransportData<float>::add_pieces(const Scene&, const Tracing&, const std::vector<PieceSides>&);
template void TransportData<double>::add_pieces(const Scene&, const Tracing&, const std::vector<PieceSides>&);
template std::int32_t TransportData<float>::piece(int, int) const;
template std::int32_t TransportData<double>::piece(int, int) const;

}  // namespace halfslope
