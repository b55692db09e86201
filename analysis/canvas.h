// A drawing as a list of plain elements, which become SVG or the pixels of a PNG.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/png.h"

namespace halfslope {

/// A colour in 8-bit sRGB.
struct Ink {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Ink&) const = default;
};
inline constexpr Ink kBlack = {0, 0, 0}, kWhite = {255, 255, 255};

/// A place on a canvas, in points (1/72 inch); x grows to the right and y downwards.
struct Position {
  double x = 0, y = 0;
};

/// A line's looks. `dashes` are lengths in points, drawn and left out by turns; empty for a solid line. Ends are butt,
/// joins round.
struct Stroke {
  Ink ink;
  double width = 0.75;
  std::vector<double> dashes = {};
};

/// How a shape is painted: its inside, then the line around it.
struct Paint {
  std::optional<Ink> fill = std::nullopt;
  double opacity = 1;  ///< of the fill, in [0, 1]
  std::optional<Stroke> stroke = std::nullopt;
};

enum class Anchor { kStart, kMiddle, kEnd };

/// `size` is the font's, in points; `degrees` turn counter-clockwise about the anchor.
struct TextStyle {
  double size = 7.5;
  Anchor anchor = Anchor::kStart;
  bool bold = false;
  double degrees = 0;
  Ink ink = kBlack;
};

/// A page of width × height points; later elements lie over earlier ones.
class Canvas {
 public:
  struct Path {
    std::vector<Position> points;
    bool closed;
    Paint paint;
  };
  struct Disc {
    Position center;
    double radius;
    Paint paint;
  };
  struct Text {
    Position baseline;  ///< where the anchor lies
    std::string text;   ///< UTF-8
    TextStyle style;
  };
  /// Every pixel a rectangle of its own, not blurred.
  struct Picture {
    Position top_left;
    double width, height;
    RgbImage image;
  };
  /// A part with a name, which SVG viewers show as a hint; it lasts to its GroupEnd.
  struct Group {
    std::string title;
  };
  struct GroupEnd {};
  using Element = std::variant<Path, Disc, Text, Picture, Group, GroupEnd>;

  Canvas(double width, double height) : width_(width), height_(height) {}
  double width() const { return width_; }
  double height() const { return height_; }
  const std::vector<Element>& elements() const { return elements_; }

  void line(std::vector<Position> points, Stroke stroke);
  void polygon(std::vector<Position> corners, Paint paint);
  void rectangle(Position top_left, double width, double height, Paint paint);
  void disc(Position center, double radius, Paint paint);
  void text(Position baseline, std::string text, TextStyle style = {});
  void picture(Position top_left, double width, double height, RgbImage image);
  void begin_group(std::string title);
  void end_group();

 private:
  double width_, height_;
  std::vector<Element> elements_;
};

/// The canvas as an SVG 1.1 document on white: text stays text (in DejaVu Sans, or what the viewer has in its place),
/// pictures are PNG inside it. Coordinates are rounded to 1/1000 point.
std::string svg_text(const Canvas& canvas);

/// The canvas on white with `scale` pixels a point, anti-aliased by exact coverage; text in DejaVu Sans. Width and
/// height are rounded up.
RgbImage rasterize(const Canvas& canvas, double scale);

}  // namespace halfslope
