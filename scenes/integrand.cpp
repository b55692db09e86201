#include "scenes/integrand.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>

#include "core/error.h"
#include "core/kernel_library.h"
#include "core/parameters.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

class KernelIntegral final : public Integral {
 public:
  KernelIntegral(const IntegrandKernel& kernel, const double* parameters, std::span<const Technique> techniques)
      : kernel_(kernel), parameters_(parameters), techniques_(techniques) {}
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    evaluate(kernel_.f32, call, points, terms);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    evaluate(kernel_.f64, call, points, terms);
  }

 private:
  template <class T>
  void evaluate(EvaluateIntegrand<T> kernel, const TechniqueCall& call, const PointBlock& points,
                TermBlock<T>& terms) const {
    constexpr int kMost = 16;
    const std::uint32_t* high[kMost];
    const std::uint32_t* low[kMost];
    T* pdfs[kMost];
    const int dims = techniques_[static_cast<std::size_t>(call.technique)].layout.dims();
    for (int d = 0; d < dims; ++d) {
      high[d] = points.high(call.first_dim + d);
      low[d] = points.low(call.first_dim + d);
    }
    for (std::size_t k = 0; k < call.set.size(); ++k) pdfs[k] = terms.pdf(call.slot, static_cast<int>(k));
    kernel({parameters_, call.technique, high, low, points.stride(), terms.value(call.slot, 0), pdfs, call.set.data(),
            static_cast<int>(call.set.size())});
  }

  const IntegrandKernel& kernel_;
  const double* parameters_;
  std::span<const Technique> techniques_;
};

IntegrandKernel find_kernel(const std::string& name) {
  const auto& table = kernels<IntegrandKernels>();
  for (std::size_t i = 0; i < table.count; ++i) {
    if (table.integrands[i].name == name) return table.integrands[i];
  }
  fail(ExitCode::kIo, "the kernel library has no integrand '{}'; it is of another version", name);
}

using Text = std::optional<std::string_view>;  // of the parameters, where there are any

std::string subject(const std::string& scene) { return fmt::format("scene '{}'", scene); }

const Technique kMean = {"mean", {{2}}};
const std::vector<Technique> kLightAndBsdf = {{"light", {{1}}}, {"bsdf", {{1}}}};

std::unique_ptr<IntegralSource> make_cap(const std::string& scene, Text text) {
  const Parameters values = parse_parameters(subject(scene), text, std::vector<Parameter>{{"n"}, {"alpha"}});
  const double n = values.number("n"), alpha = values.number("alpha");
  if (n < 0) fail(ExitCode::kBadInput, "scene '{}': n must be at least 0, found {}", scene, n);
  if (!(alpha > 0 && alpha <= std::numbers::pi / 2)) {
    fail(ExitCode::kBadInput, "scene '{}': alpha is a half-angle in radians, in (0, pi/2]; found {}", scene, alpha);
  }
  const double half_sine = std::sin(alpha / 2), v_max = std::min(1.0, 2 * half_sine * half_sine);
  const double exact = -std::expm1((n + 1) * std::log1p(-v_max));
  return std::make_unique<AnalyticSource>("aligned-phong-cap", std::vector{n, v_max}, kLightAndBsdf, exact, scene);
}

constexpr int kMostDims = 6;

int parse_dims(const std::string& scene, Text text) {
  return parse_parameters(subject(scene), text, std::vector<Parameter>{{"d"}}).whole(subject(scene), "d", 1, kMostDims);
}

// aᵢ = 7.03 (i − ½)/d² to four decimals, so that Σ aᵢ = 3.515 in every dimension; uᵢ are fixed centres, no binary
// fractions but the first. A factor's integral is √π/(2a) (erf(a (1 − u)) + erf(a u)).
std::unique_ptr<IntegralSource> make_genz_gaussian(const std::string& scene, Text text) {
  constexpr double kCentres[kMostDims] = {0.5, 0.2326, 0.6652, 0.3979, 0.8305, 0.5631};
  const int dims = parse_dims(scene, text);
  std::vector<double> parameters;
  for (int i = 1; i <= dims; ++i) {
    parameters.push_back(std::nearbyint(70300.0 * (2 * i - 1) / (2.0 * dims * dims)) / 10000);
  }
  parameters.insert(parameters.end(), kCentres, kCentres + dims);
  double exact = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dims); ++i) {
    const double a = parameters[i], u = kCentres[i];
    exact *= std::sqrt(std::numbers::pi) / (2 * a) * (std::erf(a * (1 - u)) + std::erf(a * u));
  }
  return std::make_unique<AnalyticSource>(fmt::format("genz-gaussian:d={}", dims), parameters,
                                          std::vector<Technique>{{"mean", pairs(dims)}}, exact, scene);
}

// The part of the unit cube where w·x > c. With x → 1 − x wherever w is negative, all weights are |w| and c grows by
// those; then one minus the corner below the plane, by inclusion and exclusion over the vertices v:
// 1/(d! ∏|w|) Σ (−1)^|v| max(0, c − |w|·v)^d. Up to six dimensions its terms are of the order of the sum.
double halfspace_volume(std::span<const double> weights, double c) {
  const std::size_t dims = weights.size();
  long double corner = c, scale = 1, sum = 0;
  for (std::size_t i = 0; i < dims; ++i) {
    corner += std::max(0.0, -weights[i]);
    scale *= static_cast<long double>(i + 1) * std::fabs(weights[i]);
  }
  for (unsigned vertex = 0; vertex < 1u << dims; ++vertex) {
    long double rest = corner, power = 1;
    for (std::size_t i = 0; i < dims; ++i) {
      if (vertex >> i & 1) {
        rest -= std::fabs(weights[i]);
        power = -power;
      }
    }
    if (rest <= 0) continue;
    for (std::size_t i = 0; i < dims; ++i) power *= rest;
    sum += power;
  }
  return static_cast<double>(1 - sum / scale);
}

// Weights one over the root of a prime, so that the plane is in general position; signs that lead it through the
// middle of the cube.
std::unique_ptr<IntegralSource> make_halfspace(const std::string& scene, Text text) {
  const int dims = parse_dims(scene, text);
  const double r2 = 1 / std::sqrt(2.0), r3 = 1 / std::sqrt(3.0), r5 = 1 / std::sqrt(5.0), r7 = 1 / std::sqrt(7.0),
               r11 = 1 / std::sqrt(11.0);
  const std::vector<double> weights[kMostDims] = {
      {r2}, {1, -r2}, {1, -r2, r3}, {1, r2, -r3, -r5}, {1, r2, -r3, -r5, r7}, {1, r2, -r3, -r5, r7, -r11}};
  const std::vector<double>& own = weights[dims - 1];
  return std::make_unique<AnalyticSource>(fmt::format("halfspace:d={}", dims), own,
                                          std::vector<Technique>{{"mean", pairs(dims)}}, halfspace_volume(own, 0.1),
                                          scene);
}

struct Entry {
  IntegrandInfo info;
  std::function<std::unique_ptr<IntegralSource>(const std::string& scene, Text parameters)> make;
};

// A scene without parameters.
auto plain(const char* kernel, std::vector<Technique> techniques, double exact) {
  return [=](const std::string& scene, Text text) {
    parse_parameters(subject(scene), text, {});
    return std::make_unique<AnalyticSource>(kernel, std::vector<double>{}, techniques, exact, scene);
  };
}

// The menu. To add one: its formula in integrands.kernel.cpp, its exact integral here.
const std::vector<Entry>& entries() {
  static const double kErf1 = std::erf(1.0);
  static const std::vector<Entry> kEntries = {
      {{"quarterdisk", "", "1 where x^2 + y^2 < 2/pi, on the unit square; integral 1/2",
        "Christensen, Kensler & Kilpatrick, Progressive multi-jittered sample sequences (2018)"},
       plain("quarterdisk", {kMean}, 0.5)},
      {{"quartergaussian", "", "exp(-x^2 - y^2) on the unit square; integral pi/4 erf(1)^2",
        "Christensen, Kensler & Kilpatrick, Progressive multi-jittered sample sequences (2018)"},
       plain("quartergaussian", {kMean}, std::numbers::pi / 4 * kErf1 * kErf1)},
      {{"stepx", "", "1 where x < 1/pi, on the unit square; integral 1/pi",
        "Christensen, Kensler & Kilpatrick, Progressive multi-jittered sample sequences (2018)"},
       plain("stepx", {kMean}, std::numbers::inv_pi)},
      {{"bilinear", "", "x y on the unit square; integral 1/4",
        "Christensen, Kensler & Kilpatrick, Progressive multi-jittered sample sequences (2018)"},
       plain("bilinear", {kMean}, 0.25)},
      {{"genz-gaussian", "d=DIMENSIONS", "a smooth peak in the unit cube of 1 to 6 dimensions; integral by erf",
        "Genz, Testing multidimensional integration routines (1984)"},
       make_genz_gaussian},
      {{"halfspace", "d=DIMENSIONS", "1 on one side of a plane through the unit cube of 1 to 6 dimensions",
        "Cho & Cho, Volume of hypercubes clipped by hyperplanes (2015)"},
       make_halfspace},
      {{"mis-toy", "", "f(x) = x on [0,1]; 'light' has density 1, 'bsdf' has density 2x; integral 1/2",
        "the smallest problem on which every heuristic has an exact variance"},
       plain("mis-toy", kLightAndBsdf, 0.5)},
      {{"aligned-phong-cap", "n=EXPONENT,alpha=RADIANS",
        "a Phong lobe and a light that fills a cone about its axis; integral 1 - cos(alpha)^(n+1)",
        "a multiple importance sampling problem whose variance is known for every heuristic"},
       make_cap},
  };
  return kEntries;
}

}  // namespace

AnalyticSource::AnalyticSource(const std::string& kernel, std::vector<double> parameters,
                               std::vector<Technique> techniques, double exact, std::string fingerprint)
    : kernel_(find_kernel(kernel)),
      parameters_(std::move(parameters)),
      techniques_(std::move(techniques)),
      exact_(exact),
      fingerprint_(std::move(fingerprint)) {}

PixelIntegral AnalyticSource::pixel(int) const {
  return {{0, 0, 0}, std::make_unique<KernelIntegral>(kernel_, parameters_.data(), techniques_)};
}

std::vector<IntegrandInfo> analytic_scenes() {
  std::vector<IntegrandInfo> infos;
  for (const Entry& entry : entries()) infos.push_back(entry.info);
  return infos;
}

std::unique_ptr<IntegralSource> make_analytic_scene(const std::string& name) {
  const SplitName split = split_name(name);
  for (const Entry& entry : entries()) {
    if (entry.info.name == split.head) return entry.make(name, split.parameters);
  }
  return nullptr;
}

}  // namespace halfslope
