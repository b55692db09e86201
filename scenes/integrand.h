// Analytic scenes: an integrand on [0,1]^d as a scene of one pixel, with its exact integral and variance.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integral.h"
#include "scenes/integrand_table.h"
#include "scenes/kernels.h"

namespace halfslope {

/// An analytic scene of one pixel and one channel whose integrand is a kernel.
class AnalyticSource final : public IntegralSource {
 public:
  /// `fingerprint` is the scene's full name, parameters included.
  AnalyticSource(Integrand integrand, std::string fingerprint);

  std::span<const Technique> techniques() const override { return integrand_.techniques; }
  PixelIntegral pixel(int index) const override;
  std::optional<Color> closed_form(int) const override {
    return Color{integrand_.integral, integrand_.integral, integrand_.integral};
  }
  std::optional<double> variance() const override { return integrand_.variance; }
  Regularity regularity() const override { return integrand_.regularity; }
  std::optional<ExactDensities> exact_densities() const override { return integrand_.exact; }
  std::string fingerprint() const override { return fingerprint_; }

 private:
  Integrand integrand_;
  IntegrandKernel kernel_;
  std::string fingerprint_;
};

/// The analytic scenes there are.
std::vector<IntegrandInfo> analytic_scenes();

/// The name that `analytic_scenes` has for one spelled with underscores, and with its dimensions or its side at the
/// end: "sobol_g_d4" is "sobol-g:d=4", "halfspace3_irr" "halfspace:d=3". Other names come back as they are.
std::string analytic_scene_name(const std::string& name);

/// The analytic scene of that name, in either spelling, which may carry parameters:
/// "aligned-phong-cap:n=1000,alpha=0.05". Null where the name before ':' is none; Error(kBadInput) for parameters that
/// are unknown, missing or out of range.
std::unique_ptr<IntegralSource> make_analytic_scene(const std::string& name);

}  // namespace halfslope
