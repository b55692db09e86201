// Analytic scenes: an integrand on [0,1]^d as a scene of one pixel, with its exact integral.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integral.h"
#include "scenes/kernels.h"

namespace halfslope {

/// An analytic scene of one pixel and one channel whose integrand is a kernel.
class AnalyticSource final : public IntegralSource {
 public:
  /// `kernel` names an entry of IntegrandKernels; `fingerprint` is the scene's full name, parameters included.
  AnalyticSource(const std::string& kernel, std::vector<double> parameters, std::vector<Technique> techniques,
                 double exact, std::string fingerprint);

  std::span<const Technique> techniques() const override { return techniques_; }
  PixelIntegral pixel(int index) const override;
  std::optional<Color> closed_form(int) const override { return Color{exact_, exact_, exact_}; }
  std::string fingerprint() const override { return fingerprint_; }

 private:
  IntegrandKernel kernel_;
  std::vector<double> parameters_;
  std::vector<Technique> techniques_;
  double exact_;
  std::string fingerprint_;
};

/// What the catalogue says of an analytic scene.
struct IntegrandInfo {
  std::string name, parameters, description, reference;
};

/// The analytic scenes there are.
std::vector<IntegrandInfo> analytic_scenes();

/// The analytic scene of that name, which may carry parameters: "aligned-phong-cap:n=1000,alpha=0.05". Null where the
/// name before ':' is none; Error(kBadInput) for parameters that are unknown, missing or out of range.
std::unique_ptr<IntegralSource> make_analytic_scene(const std::string& name);

}  // namespace halfslope
