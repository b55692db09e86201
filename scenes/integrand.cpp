#include "scenes/integrand.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <string_view>

#include "core/error.h"
#include "core/kernel_library.h"

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

// The value of each parameter in "n=1000,alpha=0.05"; every one of `names` must be given once, and no other.
std::map<std::string, double> parse_parameters(const std::string& scene, std::string_view text,
                                               const std::vector<std::string>& names) {
  std::map<std::string, double> values;
  while (!text.empty()) {
    const std::string item(text.substr(0, text.find(',')));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const auto equals = item.find('=');
    const std::string name = item.substr(0, equals);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      fail(ExitCode::kBadInput, "scene '{}': there is no parameter '{}'{}; allowed: {}", scene, name,
           did_you_mean(name, names), fmt::join(names, ", "));
    }
    char* end = nullptr;
    const std::string number = equals == std::string::npos ? "" : item.substr(equals + 1);
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(value)) {
      fail(ExitCode::kBadInput, "scene '{}': parameter '{}' must be a number, found '{}'", scene, name, number);
    }
    if (!values.emplace(name, value).second)
      fail(ExitCode::kBadInput, "scene '{}': parameter '{}' stands twice", scene, name);
  }
  for (const auto& name : names) {
    if (!values.contains(name)) {
      fail(ExitCode::kBadInput, "scene '{}': parameter '{}' is missing; it takes {}", scene, name,
           fmt::join(names, ", "));
    }
  }
  return values;
}

const Technique kMean = {"mean", {{2}}};
const std::vector<Technique> kLightAndBsdf = {{"light", {{1}}}, {"bsdf", {{1}}}};

std::unique_ptr<IntegralSource> make_cap(const std::string& scene, std::string_view text) {
  const auto values = parse_parameters(scene, text, {"n", "alpha"});
  const double n = values.at("n"), alpha = values.at("alpha");
  if (n < 0) fail(ExitCode::kBadInput, "scene '{}': n must be at least 0, found {}", scene, n);
  if (!(alpha > 0 && alpha <= std::numbers::pi / 2)) {
    fail(ExitCode::kBadInput, "scene '{}': alpha is a half-angle in radians, in (0, pi/2]; found {}", scene, alpha);
  }
  const double half_sine = std::sin(alpha / 2), v_max = std::min(1.0, 2 * half_sine * half_sine);
  const double exact = -std::expm1((n + 1) * std::log1p(-v_max));
  return std::make_unique<AnalyticSource>("aligned-phong-cap", std::vector{n, v_max}, kLightAndBsdf, exact, scene);
}

struct Entry {
  IntegrandInfo info;
  std::function<std::unique_ptr<IntegralSource>(const std::string& scene, std::string_view parameters)> make;
};

// A scene without parameters.
auto plain(const char* kernel, std::vector<Technique> techniques, double exact) {
  return [=](const std::string& scene, std::string_view text) {
    parse_parameters(scene, text, {});
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
  const auto colon = name.find(':');
  for (const Entry& entry : entries()) {
    if (entry.info.name == name.substr(0, colon)) {
      return entry.make(name,
                        colon == std::string::npos ? std::string_view() : std::string_view(name).substr(colon + 1));
    }
  }
  return nullptr;
}

}  // namespace halfslope
