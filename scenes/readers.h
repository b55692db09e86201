// The parts of a Mitsuba scene, each from its element. All throw Error(kBadInput) with file:line.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "scenes/scene.h"
#include "scenes/scene_files.h"
#include "scenes/xml_reader.h"

namespace halfslope {

/// What the readers of one scene share: its files, what was read from other files, and what nobody reads.
struct Reading {
  const SceneFiles& files;
  std::map<std::filesystem::path, std::shared_ptr<const Mesh>> meshes;
  std::map<std::pair<std::filesystem::path, bool>, std::shared_ptr<const Bitmap>> bitmaps;  ///< by path and `raw`
  /// "near_clip of sensor 'perspective'", and how often.
  std::map<std::string, int> ignored;

  explicit Reading(const SceneFiles& scene_files) : files(scene_files) {}
  /// Notes what know() named and the file gives.
  void ignore(const Properties& properties);
};

/// What a surface is made of: the front, and the back where that scatters too.
struct Material {
  Bsdf front;
  std::optional<Bsdf> back = {};
};

/// <bsdf> of the kinds that BsdfKind has, and twosided and mask around them.
Material read_bsdf(const Element& bsdf, Reading& reading);

/// <texture>: bitmap or checkerboard.
std::shared_ptr<const Texture> read_texture(const Element& texture, Reading& reading);

/// The luminance of linear sRGB, the same in each channel of a texture; what is grey stays as it is.
double luminance(const Rgb& colour);
std::shared_ptr<const Texture> luminance(const std::shared_ptr<const Texture>& texture);

/// A colour property, by a colour or a texture: `colour` is then the texture's mean. What is not given stays.
void read_colour(Properties& properties, const std::string& name, Reading& reading, Rgb& colour,
                 std::shared_ptr<const Texture>& texture);

/// The image that the `filename` of a texture or emitter names, each read once; `raw` as in read_bitmap().
std::shared_ptr<const Bitmap> read_image(Properties& properties, Reading& reading, bool raw);

/// <shape>, with its bsdf and area emitter. `position` counts the shapes from 1 and names the one that has no id.
Primitive read_shape(const Element& shape, std::size_t position, Reading& reading);

/// obj, ply or cube in world space, with at least one triangle.
std::shared_ptr<const Mesh> read_mesh(Properties& properties, const std::string& type, Reading& reading);

/// A light outside of any shape: point, directional, spot, constant or envmap.
std::variant<DeltaLight, Environment> read_emitter(const Element& emitter, Reading& reading);

/// The radiance of a shape's <emitter type="area">.
Rgb read_area_emitter(const Element& emitter, Reading& reading);

/// <sensor>: perspective, thinlens, orthographic, radiancemeter or mradiancemeter.
Sensor read_sensor(const Element& sensor, Reading& reading);

struct Film {
  int width = 768, height = 576;
  ReconstructionFilter filter;
};

/// <film type="hdrfilm"> with its <rfilter>.
Film read_film(const Element& film, Reading& reading);

}  // namespace halfslope
