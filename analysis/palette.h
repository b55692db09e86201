// Looks that a reader tells apart with any kind of colour vision, and on a grey print: each has a colour, a marker and
// dashes of its own.
#pragma once

#include <string>
#include <vector>

#include "analysis/canvas.h"

namespace halfslope {

enum class Marker { kCircle, kSquare, kTriangle, kDiamond, kDownTriangle, kStar, kPentagon, kLeftTriangle };

struct Look {
  Ink ink;
  Marker marker;
  std::vector<double> dashes;
};

/// Eight looks. The colours are those of M. Okabe and K. Ito, "Color Universal Design" (2008), with a grey in place of
/// their yellow, which white paper swallows.
const std::vector<Look>& looks();

/// A marker of the area of a disc of `radius` points; filled, or hollow with a white inside.
void draw_marker(Canvas& canvas, Position center, double radius, const Look& look, bool hollow = false);

inline constexpr Ink kInkBlue = {0, 114, 178}, kInkVermillion = {213, 94, 0}, kInkGrey = {110, 110, 110},
                     kInkLightGrey = {215, 215, 215};

}  // namespace halfslope
