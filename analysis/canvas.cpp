#include "analysis/canvas.h"

#include <utility>

namespace halfslope {

void Canvas::line(std::vector<Position> points, Stroke stroke) {
  Path path{std::move(points), false, {}};
  path.paint.stroke = std::move(stroke);
  elements_.emplace_back(std::move(path));
}

void Canvas::polygon(std::vector<Position> corners, Paint paint) {
  elements_.emplace_back(std::in_place_type<Path>, std::move(corners), true, std::move(paint));
}

void Canvas::rectangle(Position top_left, double width, double height, Paint paint) {
  const double left = top_left.x, top = top_left.y, right = left + width, bottom = top + height;
  polygon({{left, top}, {right, top}, {right, bottom}, {left, bottom}}, std::move(paint));
}

void Canvas::disc(Position center, double radius, Paint paint) {
  elements_.emplace_back(std::in_place_type<Disc>, center, radius, std::move(paint));
}

void Canvas::text(Position baseline, std::string text, TextStyle style) {
  elements_.emplace_back(std::in_place_type<Text>, baseline, std::move(text), style);
}

void Canvas::picture(Position top_left, double width, double height, RgbImage image) {
  elements_.emplace_back(std::in_place_type<Picture>, top_left, width, height, std::move(image));
}

void Canvas::begin_group(std::string title) { elements_.emplace_back(std::in_place_type<Group>, std::move(title)); }

void Canvas::end_group() { elements_.emplace_back(GroupEnd{}); }

}  // namespace halfslope
