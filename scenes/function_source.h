// An integrand in plain code as a scene: what an embedder writes to try an integrand of its own.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/integral.h"

namespace halfslope {

/// An analytic scene whose pixels integrate f over [0,1)^d, with the estimator `mean`. A kernel
/// (scenes/integrands_*.kernel.cpp) is many times faster; this takes any code.
///
///   FunctionSource("ridge", 2, [](std::span<const double> x, int) { return std::fabs(x[0] - x[1]); }, 1.0 / 3)
class FunctionSource final : public IntegralSource {
 public:
  /// f at a point of `dims` coordinates, for a pixel. Called from several threads at once. In binary32 it is given the
  /// binary32 coordinates, and its value is rounded to binary32.
  using Function = std::function<double(std::span<const double> x, int pixel)>;

  /// `fingerprint` must name all that determines f: references are cached by it. `exact` is the integral in every
  /// pixel; where it is not known a reference is rendered.
  FunctionSource(std::string fingerprint, int dims, Function f, std::optional<double> exact = std::nullopt,
                 int width = 1, int height = 1);

  int width() const override { return width_; }
  int height() const override { return height_; }
  std::span<const Technique> techniques() const override { return techniques_; }
  PixelIntegral pixel(int index) const override;
  std::optional<Color> closed_form(int) const override;
  std::string fingerprint() const override { return fingerprint_; }

 private:
  std::string fingerprint_;
  Function f_;
  std::optional<double> exact_;
  int width_, height_;
  std::vector<Technique> techniques_;
};

}  // namespace halfslope
