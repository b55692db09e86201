#include "experiments/picture_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/axes.h"
#include "analysis/palette.h"
#include "analysis/typeface.h"
#include "scenes/catalogue.h"
#include "scenes/loader.h"

namespace halfslope {
namespace {

constexpr double kSpace = 3;
constexpr double kUsualWidth = 150;  // of a picture, in points

std::optional<Scene> scene_of(const std::string& name) {
  if (is_scene_file(name) || shipped_scene_text(name.substr(0, name.find(':')))) return load_named_scene(name);
  return std::nullopt;
}

std::string roughness(const Bsdf& bsdf) {
  if (bsdf.kind == BsdfKind::kRoughConductor) return fmt::format("α = {:.3g}", bsdf.alpha);
  if (bsdf.kind == BsdfKind::kPhong) return fmt::format("n = {:.3g}", bsdf.exponent);
  return "";
}

bool is_square(const Flat& flat) {
  return flat.outline == Flat::Outline::kRectangle &&
         std::fabs(flat.half_u.norm() - flat.half_v.norm()) < 1e-3 * flat.half_u.norm();
}

/// What is written of a light: a sphere's radius, a square's side, or width × height.
struct Size {
  std::string text, kind;
};

Size size_of(const Primitive& light) {
  if (const auto* sphere = std::get_if<Sphere>(&light.shape)) return {fmt::format("{:.2g}", sphere->radius), "radius"};
  const Flat& flat = std::get<Flat>(light.shape);
  const double width = 2 * flat.half_u.norm(), height = 2 * flat.half_v.norm();
  if (is_square(flat)) return {fmt::format("{:.2g}", width), "side"};
  return {fmt::format("{:.2g} × {:.2g}", width, height), "size"};
}

/// The pixels that see a primitive first.
struct Seen {
  double count = 0, x = 0, y = 0;  ///< sums
};

/// Whether neighbours keep a space between them; `room` of each is what it takes, in the unit of `pixel`.
template <class Room>
bool apart(std::vector<PictureLabels::Label>& labels, Room room) {
  std::sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.pixel < b.pixel; });
  for (std::size_t k = 1; k < labels.size(); ++k) {
    if (labels[k].pixel - labels[k - 1].pixel < (room(labels[k]) + room(labels[k - 1])) / 2) return false;
  }
  return true;
}

}  // namespace

PictureLabels picture_labels(const std::string& name, int width, int height) {
  const auto scene = scene_of(name);
  if (!scene || scene->sensor.kind != Sensor::Kind::kPerspective) return {{}, {}, ""};
  std::vector<Seen> seen(scene->primitives.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Hit hit = first_hit(*scene, scene->sensor.ray(x, y, width, height));
      if (hit.primitive < 0 || !hit.front) continue;
      Seen& s = seen[static_cast<std::size_t>(hit.primitive)];
      s.count += 1, s.x += x + 0.5, s.y += y + 0.5;
    }
  }
  std::vector<PictureLabels::Label> shapes, lights;
  std::string kind;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Primitive& primitive = scene->primitives[k];
    if (primitive.emits && seen[k].count > 0) {
      const Size size = size_of(primitive);
      lights.push_back({seen[k].x / seen[k].count, size.text});
      kind = kind.empty() || kind == size.kind ? size.kind : "size";
    }
    const std::string text = roughness(primitive.bsdf);
    if (!primitive.emits && !text.empty() && seen[k].count > 0.002 * width * height) {
      shapes.push_back({seen[k].y / seen[k].count, text});
    }
  }
  // Labels that would run into each other help nobody. Three pictures side by side are the usual size.
  const double point = kUsualWidth / width;
  if (!apart(shapes, [&](const auto&) { return (kSmallSize + 1) / point; })) shapes.clear();
  if (!apart(lights, [&](const auto& l) { return (text_width(l.text, kSmallSize) + kSpace) / point; })) lights.clear();
  return {shapes, lights, "light " + kind};
}

double PictureLabels::margin() const {
  double widest = lights_.empty() ? 0 : text_width(lights_heading_, kSmallSize);
  for (const Label& label : shapes_) widest = std::max(widest, text_width(label.text, kSmallSize));
  return widest > 0 ? widest + kSpace + 1 : 0;
}

double PictureLabels::header() const { return lights_.empty() ? 0 : kSmallSize + 2.5; }

void PictureLabels::draw(Canvas& canvas, Position top_left, double point, bool first) const {
  const TextStyle centred = {.size = kSmallSize, .anchor = Anchor::kMiddle, .ink = kInkGrey};
  const TextStyle flush_right = {.size = kSmallSize, .anchor = Anchor::kEnd, .ink = kInkGrey};
  for (const Label& label : lights_) {
    canvas.text({top_left.x + label.pixel * point, top_left.y - 2.5}, label.text, centred);
  }
  if (!first) return;
  if (!lights_.empty()) canvas.text({top_left.x - kSpace, top_left.y - 2.5}, lights_heading_, flush_right);
  for (const Label& label : shapes_) {
    canvas.text({top_left.x - kSpace, top_left.y + label.pixel * point + 0.36 * kSmallSize}, label.text, flush_right);
  }
}

}  // namespace halfslope
