#include "scenes/texture.h"

#include <algorithm>
#include <cmath>

namespace halfslope {
namespace {

int wrapped(int i, int size, Texture::Wrap wrap) {
  if (wrap == Texture::Wrap::kClamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == Texture::Wrap::kMirror ? 2 * size : size;
  const int r = ((i % period) + period) % period;
  return r < size ? r : period - 1 - r;
}

Rgb texel(const Texture& texture, int x, int y) {
  const Bitmap& bitmap = *texture.bitmap;
  const int column = wrapped(x, bitmap.width, texture.wrap), row = wrapped(y, bitmap.height, texture.wrap);
  const float* rgb = bitmap.rgb.data() + 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(bitmap.width) +
                                              static_cast<std::size_t>(column));
  return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace

Rgb texture_value(const Texture& texture, double u, double v) {
  const Eigen::Vector2d at = texture.to_uv * Eigen::Vector3d(u, v, 1);
  if (texture.kind == Texture::Kind::kCheckerboard) {
    const auto half = [](double x) { return x - std::floor(x) > 0.5; };
    return half(at.x()) == half(at.y()) ? texture.color0 : texture.color1;
  }
  // The far end of a huge coordinate keeps nothing of where in the picture it is.
  const auto bounded = [](double x) { return std::clamp(x, -1e9, 1e9); };
  const double x = bounded(at.x() * texture.bitmap->width), y = bounded((1 - at.y()) * texture.bitmap->height);
  const auto whole = [](double value) { return static_cast<int>(std::floor(value)); };
  if (texture.filter == Texture::Filter::kNearest) return texel(texture, whole(x), whole(y));
  const int column = whole(x - 0.5), row = whole(y - 0.5);
  const double a = x - 0.5 - column, b = y - 0.5 - row;
  return (1 - b) * ((1 - a) * texel(texture, column, row) + a * texel(texture, column + 1, row)) +
         b * ((1 - a) * texel(texture, column, row + 1) + a * texel(texture, column + 1, row + 1));
}

Rgb texture_mean(const Texture& texture) {
  if (texture.kind == Texture::Kind::kCheckerboard) return 0.5 * (texture.color0 + texture.color1);
  Rgb sum = Rgb::Zero();
  const auto& rgb = texture.bitmap->rgb;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) sum += Rgb(rgb[i], rgb[i + 1], rgb[i + 2]);
  return sum / static_cast<double>(rgb.size() / 3);
}

}  // namespace halfslope
