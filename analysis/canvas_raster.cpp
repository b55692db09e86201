// The canvas as pixels. FreeType fills outlines: coverage of a pixel is the exact area, to 1/64 pixel in the corners.
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include FT_STROKER_H

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "analysis/canvas.h"
#include "analysis/typeface.h"
#include "core/assertion.h"
#include "core/error.h"

namespace halfslope {
namespace {

void check(FT_Error error) {
  if (error != 0) fail(ExitCode::kIo, "FreeType cannot draw (its error {})", error);
}

/// An FT_Outline that owns its arrays, in 1/64 pixel; y grows upwards from the image's top edge.
class Outline {
 public:
  Outline(FT_Library library, unsigned points, int contours) : library_(library) {
    check(FT_Outline_New(library, points, contours, &outline_));
    outline_.n_points = 0;  // room, to be filled
    outline_.n_contours = 0;
  }
  Outline(const Outline&) = delete;
  Outline& operator=(const Outline&) = delete;
  ~Outline() { FT_Outline_Done(library_, &outline_); }
  FT_Outline* get() { return &outline_; }

 private:
  FT_Library library_;
  FT_Outline outline_ = {};
};

class Raster {
 public:
  Raster(const Canvas& canvas, double scale)
      : image_(static_cast<int>(std::ceil(canvas.width() * scale)),
               static_cast<int>(std::ceil(canvas.height() * scale))),
        scale_(scale) {}

  void operator()(const Canvas::Path& path) { paint(path.points, path.closed, path.paint); }

  void operator()(const Canvas::Disc& disc) {
    // n sides lose (2π/n)²/6 of the area: 0.3 % of 48, and a hundredth of a pixel at the rim of larger discs.
    const int sides = std::clamp(static_cast<int>(std::ceil(22 * std::sqrt(disc.radius * scale_))), 48, 720);
    std::vector<Position> points;
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      points.push_back({disc.center.x + disc.radius * std::cos(angle), disc.center.y + disc.radius * std::sin(angle)});
    }
    paint(points, true, disc.paint);
  }

  void operator()(const Canvas::Text& text) {
    const Typeface& typeface = text.style.bold ? bold_ : regular_;
    const Typeface::Line line = typeface.set(text.text);
    const double start = text.style.anchor == Anchor::kStart    ? 0
                         : text.style.anchor == Anchor::kMiddle ? -0.5 * static_cast<double>(line.width)
                                                                : -static_cast<double>(line.width);
    const double em = text.style.size * scale_ * 64 / typeface.units_per_em();
    const double angle = text.style.degrees * std::numbers::pi / 180;
    const double along = em * std::cos(angle), across = em * std::sin(angle);
    const auto fixed = [](double x) { return static_cast<FT_Fixed>(std::lround(x * 65536)); };
    const FT_Matrix matrix = {fixed(along), fixed(-across), fixed(across), fixed(along)};
    for (const Typeface::Glyph& glyph : line.glyphs) {
      if (FT_Load_Glyph(typeface.face(), glyph.index, FT_LOAD_NO_SCALE) != 0) continue;
      FT_Outline& outline = typeface.face()->glyph->outline;
      FT_Outline_Transform(&outline, &matrix);
      const double offset = start + static_cast<double>(glyph.offset);
      FT_Outline_Translate(&outline, std::lround(text.baseline.x * scale_ * 64 + offset * along),
                           std::lround(-text.baseline.y * scale_ * 64 + offset * across));
      fill(typeface.library(), &outline, text.style.ink, 1);
    }
  }

  void operator()(const Canvas::Picture& picture) {
    const double left = picture.top_left.x * scale_, top = picture.top_left.y * scale_;
    const double width = picture.width * scale_, height = picture.height * scale_;
    // Pixels whose centre lies in the picture; the nearest of its own.
    const auto first = [](double edge) { return std::max(0, static_cast<int>(std::ceil(edge - 0.5 - 1e-6))); };
    const int x_end = std::min(image_.width, first(left + width)), y_end = std::min(image_.height, first(top + height));
    const auto nearest = [](double fraction, int count) {
      return std::clamp(static_cast<int>(std::floor(fraction * count)), 0, count - 1);
    };
    for (int y = first(top); y < y_end; ++y) {
      const int from_y = nearest((y + 0.5 - top) / height, picture.image.height);
      for (int x = first(left); x < x_end; ++x) {
        std::copy_n(picture.image.pixel(nearest((x + 0.5 - left) / width, picture.image.width), from_y), 3,
                    image_.pixel(x, y));
      }
    }
  }

  void operator()(const Canvas::Group&) {}
  void operator()(const Canvas::GroupEnd&) {}

  RgbImage take() { return std::move(image_); }

 private:
  static constexpr std::size_t kMostPoints = 8000;  // an FT_Outline counts its points in 16 bits

  FT_Vector place(Position p) const { return {std::lround(p.x * scale_ * 64), std::lround(-p.y * scale_ * 64)}; }

  void paint(const std::vector<Position>& points, bool closed, const Paint& paint) {
    if (points.size() < 2) return;
    if (paint.fill) fill_polygon(points, *paint.fill, paint.opacity);
    if (paint.stroke && paint.stroke->dashes.empty()) stroke(points, closed, *paint.stroke);
    if (paint.stroke && !paint.stroke->dashes.empty()) stroke_dashes(points, closed, *paint.stroke);
  }

  void fill_polygon(const std::vector<Position>& points, Ink ink, double opacity) {
    assert_equal(points.size() <= kMostPoints, true, "corners of a polygon, at most 8000");
    Outline outline(regular_.library(), static_cast<unsigned>(points.size()), 1);
    FT_Outline* o = outline.get();
    for (const Position& p : points) {
      o->points[o->n_points] = place(p);
      o->tags[o->n_points++] = FT_CURVE_TAG_ON;
    }
    o->contours[o->n_contours++] = static_cast<short>(o->n_points - 1);
    fill(regular_.library(), o, ink, opacity);
  }

  void stroke(const std::vector<Position>& points, bool closed, const Stroke& stroke) {
    // A long line in pieces that share a point.
    if (points.size() > kMostPoints) {
      const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
      this->stroke({points.begin(), middle + 1}, false, stroke);
      return this->stroke({middle, points.end()}, false, stroke);
    }
    // FreeType 2.12 reads beyond its arrays on a line all of whose points are one; such a line has no length to draw.
    std::vector<FT_Vector> vertices;
    for (const Position& p : points) {
      const FT_Vector at = place(p);
      if (vertices.empty() || at.x != vertices.back().x || at.y != vertices.back().y) vertices.push_back(at);
    }
    if (vertices.size() < 2) return;
    FT_Stroker stroker = nullptr;
    check(FT_Stroker_New(regular_.library(), &stroker));
    const std::unique_ptr<FT_StrokerRec_, decltype(&FT_Stroker_Done)> owner(stroker, FT_Stroker_Done);
    FT_Stroker_Set(stroker, std::lround(stroke.width * scale_ * 32), FT_STROKER_LINECAP_BUTT, FT_STROKER_LINEJOIN_ROUND,
                   0);
    check(FT_Stroker_BeginSubPath(stroker, &vertices.front(), !closed));
    for (std::size_t k = 1; k < vertices.size(); ++k) check(FT_Stroker_LineTo(stroker, &vertices[k]));
    check(FT_Stroker_EndSubPath(stroker));
    FT_UInt count = 0, contours = 0;
    check(FT_Stroker_GetCounts(stroker, &count, &contours));
    Outline outline(regular_.library(), count, static_cast<int>(contours));
    FT_Stroker_Export(stroker, outline.get());
    fill(regular_.library(), outline.get(), stroke.ink, 1);
  }

  void stroke_dashes(std::vector<Position> points, bool closed, const Stroke& looks) {
    if (closed) points.push_back(points.front());
    const Stroke solid = {looks.ink, looks.width};
    std::size_t dash = 0;
    double left = looks.dashes[0];
    std::vector<Position> piece = {points.front()};
    for (std::size_t k = 1; k < points.size(); ++k) {
      Position from = points[k - 1];
      for (double length = std::hypot(points[k].x - from.x, points[k].y - from.y); length > left;) {
        const double t = left / length;
        from = {from.x + t * (points[k].x - from.x), from.y + t * (points[k].y - from.y)};
        length -= left;
        piece.push_back(from);
        if (dash % 2 == 0) stroke(piece, false, solid);
        piece = {from};
        left = looks.dashes[++dash % looks.dashes.size()];
      }
      left -= std::hypot(points[k].x - from.x, points[k].y - from.y);
      piece.push_back(points[k]);
    }
    if (dash % 2 == 0) stroke(piece, false, solid);
  }

  void fill(FT_Library library, FT_Outline* outline, Ink ink, double opacity) {
    FT_BBox box;
    FT_Outline_Get_CBox(outline, &box);
    const int left = std::max(0, static_cast<int>(box.xMin >> 6));
    const int right = std::min(image_.width, static_cast<int>((box.xMax + 63) >> 6));
    const int top = std::max(0, static_cast<int>(-((box.yMax + 63) >> 6)));
    const int bottom = std::min(image_.height, static_cast<int>(-(box.yMin >> 6)));
    if (left >= right || top >= bottom) return;
    FT_Outline_Translate(outline, -64 * static_cast<FT_Pos>(left), 64 * static_cast<FT_Pos>(bottom));
    coverage_.assign(static_cast<std::size_t>(right - left) * static_cast<std::size_t>(bottom - top), 0);
    FT_Bitmap bitmap = {};
    bitmap.rows = static_cast<unsigned>(bottom - top);
    bitmap.width = static_cast<unsigned>(right - left);
    bitmap.pitch = right - left;
    bitmap.buffer = coverage_.data();
    bitmap.num_grays = 256;
    bitmap.pixel_mode = FT_PIXEL_MODE_GRAY;
    check(FT_Outline_Get_Bitmap(library, outline, &bitmap));
    const std::uint8_t ink_values[3] = {ink.red, ink.green, ink.blue};
    for (int y = top; y < bottom; ++y) {
      const unsigned char* covered = coverage_.data() + static_cast<std::ptrdiff_t>(y - top) * bitmap.pitch;
      for (int x = left; x < right; ++x, ++covered) {
        const double alpha = opacity * *covered / 255;
        std::uint8_t* pixel = image_.pixel(x, y);
        for (int c = 0; c < 3; ++c) {
          pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + alpha * (ink_values[c] - pixel[c])));
        }
      }
    }
  }

  RgbImage image_;
  double scale_;
  Typeface regular_{false}, bold_{true};
  std::vector<unsigned char> coverage_;
};

}  // namespace

RgbImage rasterize(const Canvas& canvas, double scale) {
  Raster raster(canvas, scale);
  for (const Canvas::Element& element : canvas.elements()) std::visit(raster, element);
  return raster.take();
}

}  // namespace halfslope
