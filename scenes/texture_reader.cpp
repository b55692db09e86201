#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "scenes/bitmap_reader.h"
#include "scenes/readers.h"

namespace halfslope {
namespace {

/// `to_uv`, of which the rows of u and v are kept, as Mitsuba's; or the offsets and scales of Mitsuba 0.x, which its
/// upgrade makes a translate with a scale after it.
Eigen::Matrix<double, 2, 3> read_to_uv(Properties& properties) {
  const auto to_uv = properties.transform("to_uv");
  Eigen::Matrix<double, 2, 3> matrix = Eigen::Matrix<double, 2, 3>::Identity();
  if (to_uv) {
    matrix << (*to_uv)(0, 0), (*to_uv)(0, 1), (*to_uv)(0, 3), (*to_uv)(1, 0), (*to_uv)(1, 1), (*to_uv)(1, 3);
  }
  if (properties.element().file().upgraded) {
    for (int i = 0; i < 2; ++i) {
      const std::string axis = i == 0 ? "u" : "v";
      const auto offset = properties.number(axis + "offset"), scale = properties.number(axis + "scale");
      if (to_uv && (offset || scale)) {
        properties.reject(axis + (offset ? "offset" : "scale"), "given beside to_uv", "one or the other");
      }
      matrix.row(i) = scale.value_or(1) * (matrix.row(i) + Eigen::RowVector3d(0, 0, offset.value_or(0)));
    }
  }
  return matrix;
}

template <class Choice>
Choice read_choice(Properties& properties, const std::string& name, const std::map<std::string, Choice>& choices,
                   Choice absent) {
  const auto given = properties.string(name);
  if (!given) return absent;
  if (const auto found = choices.find(*given); found != choices.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  properties.reject(name, fmt::format("'{}'", *given), comma_separated(names) + did_you_mean(*given, names));
}

Texture read_checkerboard(Properties& properties) {
  Texture texture;
  texture.to_uv = read_to_uv(properties);
  const auto color0 = properties.colour("color0"), color1 = properties.colour("color1");
  properties.finish();
  if (color0) texture.color0 = *color0;
  if (color1) texture.color1 = *color1;
  return texture;
}

Texture read_bitmap_texture(Properties& properties, Reading& reading) {
  using Filter = Texture::Filter;
  using Wrap = Texture::Wrap;
  Texture texture;
  texture.kind = Texture::Kind::kBitmap;
  // Mitsuba's v = 0 is the top row, a Texture's is the bottom one.
  texture.to_uv = read_to_uv(properties);
  texture.to_uv.row(1) = Eigen::RowVector3d(0, 0, 1) - texture.to_uv.row(1);
  texture.filter = read_choice<Filter>(
      properties, "filter_type", {{"bilinear", Filter::kBilinear}, {"nearest", Filter::kNearest}}, Filter::kBilinear);
  texture.wrap =
      read_choice<Wrap>(properties, "wrap_mode",
                        {{"repeat", Wrap::kRepeat}, {"mirror", Wrap::kMirror}, {"clamp", Wrap::kClamp}}, Wrap::kRepeat);
  const bool raw = properties.boolean("raw").value_or(false);
  properties.know({"filename", "format", "accel"});
  properties.finish();
  reading.ignore(properties);
  texture.bitmap = read_image(properties, reading, raw);
  return texture;
}

bool is_grey(const Rgb& colour) { return colour[0] == colour[1] && colour[1] == colour[2]; }

}  // namespace

std::shared_ptr<const Texture> read_texture(const Element& element, Reading& reading) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"bitmap", "checkerboard"};
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("texture", type, types);
  Properties properties(element, {});
  return std::make_shared<const Texture>(type == "bitmap" ? read_bitmap_texture(properties, reading)
                                                          : read_checkerboard(properties));
}

void read_colour(Properties& properties, const std::string& name, Reading& reading, Rgb& colour,
                 std::shared_ptr<const Texture>& texture) {
  if (const auto element = properties.texture(name)) {
    texture = read_texture(*element, reading);
    colour = texture_mean(*texture);
  } else if (const auto given = properties.colour(name)) {
    colour = *given;
  }
}

std::shared_ptr<const Bitmap> read_image(Properties& properties, Reading& reading, bool raw) {
  const auto name = properties.string("filename");
  if (!name) properties.reject("filename", "absent", "the name of an image");
  const auto path = reading.files.find(properties.element(), *name);
  std::shared_ptr<const Bitmap>& bitmap = reading.bitmaps[{path, raw}];
  if (bitmap) return bitmap;
  try {
    bitmap = std::make_shared<const Bitmap>(read_bitmap(path, raw));
  } catch (const Error& error) {
    throw Error(error.code(), properties.element().place() + ": " + error.what());
  }
  return bitmap;
}

double luminance(const Rgb& colour) {
  if (is_grey(colour)) return colour[0];
  return (colour * Rgb(0.212671, 0.715160, 0.072169)).sum();  // of BT.709's primaries, as Mitsuba's luminance()
}

std::shared_ptr<const Texture> luminance(const std::shared_ptr<const Texture>& texture) {
  Texture grey = *texture;
  grey.color0 = Rgb::Constant(luminance(grey.color0));
  grey.color1 = Rgb::Constant(luminance(grey.color1));
  if (grey.bitmap && !is_grey(*grey.bitmap)) {
    Bitmap bitmap = *grey.bitmap;
    for (std::size_t i = 0; i < bitmap.rgb.size(); i += 3) {
      float* rgb = bitmap.rgb.data() + i;
      rgb[0] = rgb[1] = rgb[2] = static_cast<float>(luminance(Rgb(rgb[0], rgb[1], rgb[2])));
    }
    grey.bitmap = std::make_shared<const Bitmap>(std::move(bitmap));
  }
  return std::make_shared<const Texture>(std::move(grey));
}

}  // namespace halfslope
