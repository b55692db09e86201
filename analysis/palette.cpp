#include "analysis/palette.h"

#include <cmath>
#include <numbers>

namespace halfslope {
namespace {

/// A regular polygon of radius 1, or a star where every second corner is at `inner`; `degrees` turn the first corner,
/// from the top, clockwise.
std::vector<Position> regular(int corners, double degrees, double inner = 1) {
  std::vector<Position> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners + degrees * std::numbers::pi / 180;
    const double radius = k % 2 == 0 ? 1 : inner;
    points.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
  }
  return points;
}

std::vector<Position> corners_of(Marker marker) {
  switch (marker) {
    case Marker::kSquare:
      return regular(4, 45);
    case Marker::kTriangle:
      return regular(3, 0);
    case Marker::kDiamond:
      return regular(4, 0);
    case Marker::kDownTriangle:
      return regular(3, 180);
    case Marker::kStar:
      return regular(10, 0, 0.45);
    case Marker::kPentagon:
      return regular(5, 0);
    case Marker::kLeftTriangle:
      return regular(3, 270);
    case Marker::kCircle:
      break;
  }
  return {};
}

/// Of a polygon without crossings (the shoelace formula).
double area_of(const std::vector<Position>& corners) {
  double twice = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Position &a = corners[k], &b = corners[(k + 1) % corners.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::fabs(twice) / 2;
}

}  // namespace

const std::vector<Look>& looks() {
  static const std::vector<Look> kLooks = {
      {kInkBlue, Marker::kCircle, {}},
      {kInkVermillion, Marker::kSquare, {4, 1.5}},
      {{0, 158, 115}, Marker::kTriangle, {1.2, 1.2}},
      {{204, 121, 167}, Marker::kDiamond, {5, 1.5, 1.2, 1.5}},
      {{230, 159, 0}, Marker::kDownTriangle, {2.5, 1.5}},
      {{86, 180, 233}, Marker::kStar, {7, 1.5}},
      {kBlack, Marker::kPentagon, {4, 1.2, 1.2, 1.2, 1.2, 1.2}},
      {kInkGrey, Marker::kLeftTriangle, {1.2, 2.4}},
  };
  return kLooks;
}

void draw_marker(Canvas& canvas, Position center, double radius, const Look& look, bool hollow) {
  const Paint paint = {.fill = hollow ? kWhite : look.ink, .stroke = Stroke{look.ink, 0.6}};
  if (look.marker == Marker::kCircle) return canvas.disc(center, radius, paint);
  std::vector<Position> points = corners_of(look.marker);
  const double factor = std::sqrt(std::numbers::pi / area_of(points));
  for (Position& p : points) p = {center.x + factor * radius * p.x, center.y + factor * radius * p.y};
  canvas.polygon(std::move(points), paint);
}

}  // namespace halfslope
