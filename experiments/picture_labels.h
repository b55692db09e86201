// What is written around a picture: how rough its glossy shapes are, and how large its lights.
#pragma once

#include <string>
#include <vector>

#include "analysis/canvas.h"

namespace halfslope {

/// Labels at pixels of a picture; empty for a scene whose shapes are not known.
class PictureLabels {
 public:
  struct Label {
    double pixel;  ///< centre, in pixels from the left or the top
    std::string text;
  };
  PictureLabels(std::vector<Label> shapes, std::vector<Label> lights, std::string lights_heading)
      : shapes_(std::move(shapes)), lights_(std::move(lights)), lights_heading_(std::move(lights_heading)) {}

  /// Points left of the first picture, and above each.
  double margin() const;
  double header() const;
  /// Around a picture at `top_left` whose pixels are `point` points wide; those left of it only for the first.
  void draw(Canvas& canvas, Position top_left, double point, bool first) const;

 private:
  std::vector<Label> shapes_, lights_;
  std::string lights_heading_;
};

/// The labels of a catalogue scene or Mitsuba file, from what each pixel of a width × height picture sees first:
/// roughness α (GGX) or exponent n (Phong) of each glossy shape that more than 0.2 % of the pixels see, at their mean
/// height, and each light's radius, side, or width × height, at its mean column. Labels that would touch are left out.
/// Throws as the loader does.
PictureLabels picture_labels(const std::string& scene, int width, int height);

}  // namespace halfslope
