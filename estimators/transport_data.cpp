#include "estimators/transport_data.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "scenes/bsdf_kind.h"

namespace halfslope {
namespace {

template <class T>
void copy(const Rgb& from, T (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(from[i]);
}

bool is_dielectric(BsdfKind kind) { return kind == BsdfKind::kDielectric || kind == BsdfKind::kRoughDielectric; }

template <class T>
TextureData<T> texture_data(const Texture& texture) {
  TextureData<T> data = {};
  data.bitmap = texture.kind == Texture::Kind::kBitmap ? 1 : 0;
  data.nearest = texture.filter == Texture::Filter::kNearest ? 1 : 0;
  data.wrap = static_cast<std::int32_t>(texture.wrap);
  copy(texture.color0, data.color0), copy(texture.color1, data.color1);
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 3; ++c) data.to_uv[3 * r + c] = static_cast<T>(texture.to_uv(r, c));
  }
  if (!texture.bitmap) return data;
  data.width = texture.bitmap->width, data.height = texture.bitmap->height, data.rgb = texture.bitmap->rgb.data();
  return data;
}

}  // namespace

bool chooses_lobes(const Scene& scene) {
  const auto chooses = [](const Bsdf& bsdf) {
    if (is_black(bsdf)) return false;
    if (bsdf.opacity != 1 || bsdf.opacity_texture) return true;
    if (bsdf.kind == BsdfKind::kPhong) return (bsdf.reflectance > 0).any() && (bsdf.specular > 0).any();
    return bsdf.kind != BsdfKind::kDiffuse && bsdf.kind != BsdfKind::kConductor &&
           bsdf.kind != BsdfKind::kRoughConductor;
  };
  return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
    return chooses(primitive.bsdf) || (primitive.back && chooses(*primitive.back));
  });
}

template <class T>
TransportData<T>::TransportData(const Scene& scene, const Tracing& tracing, const std::vector<LightSource>& lights,
                                std::size_t chosen)
    : embree_(tracing.embree) {
  add_pieces(scene, tracing, add_materials(scene));
  add_lights(scene, tracing, lights, chosen);
}

// A material for each side of each primitive that scatters at all.
template <class T>
std::vector<PieceSides> TransportData<T>::add_materials(const Scene& scene) {
  std::vector<PieceSides> sides;
  std::map<const Texture*, std::int32_t> known;
  const auto texture_index = [&](const std::shared_ptr<const Texture>& texture) {
    if (!texture) return -1;
    const auto [entry, is_new] = known.emplace(texture.get(), static_cast<std::int32_t>(textures_.size()));
    if (is_new) textures_.push_back(texture_data<T>(*texture));
    return entry->second;
  };
  const auto add = [&](const Bsdf& bsdf) -> std::int32_t {
    if (is_black(bsdf)) return -1;
    materials_.push_back(material_data<T>(bsdf));
    material_class_.push_back(bsdf_class(materials_.back().kind, materials_.back().distribution));
    opacities_.push_back(static_cast<T>(bsdf.opacity));
    material_textures_.push_back({{texture_index(bsdf.reflectance_texture), texture_index(bsdf.specular_texture),
                                   texture_index(bsdf.transmittance_texture), texture_index(bsdf.opacity_texture)}});
    scene_.masked |= bsdf.opacity != 1 || bsdf.opacity_texture;
    scene_.anisotropic |= bsdf.alpha_v && *bsdf.alpha_v != bsdf.alpha;
    return static_cast<std::int32_t>(materials_.size()) - 1;
  };
  for (const Primitive& primitive : scene.primitives) {
    PieceSides surface = {add(primitive.bsdf), -1, 0, -1};
    if (is_dielectric(primitive.bsdf.kind)) {
      surface.back = surface.front;
      scene_.transmits = true;
    } else if (primitive.back) {
      surface.back = add(*primitive.back);
      surface.two_sided = 1;
      scene_.two_sided = true;
    } else if (surface.front >= 0 && scene_.masked) {
      // A mask lets light through from behind as well: its back is a mask around nothing that scatters.
      Bsdf hole = primitive.bsdf;
      if (hole.opacity != 1 || hole.opacity_texture) {
        hole = {};
        hole.reflectance = Rgb::Zero();
        hole.opacity = primitive.bsdf.opacity;
        hole.opacity_texture = primitive.bsdf.opacity_texture;
        surface.back = add(hole);
        surface.two_sided = 1;
        scene_.two_sided = true;
      }
    }
    sides.push_back(surface);
  }
  scene_.materials = materials_.data();
  scene_.material_class = material_class_.data();
  scene_.only_class = -1;
  const auto is_first = [&](std::int32_t other) { return other == material_class_.front(); };
  if (!material_class_.empty() && std::all_of(material_class_.begin(), material_class_.end(), is_first)) {
    scene_.only_class = material_class_.front();
  }
  scene_.opacities = opacities_.data();
  scene_.material_textures = textures_.empty() ? nullptr : material_textures_.data();
  scene_.textures = textures_.empty() ? nullptr : textures_.data();
  return sides;
}

template class TransportData<float>;
template class TransportData<double>;

}  // namespace halfslope
