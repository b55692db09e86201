#include "scenes/integrand.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/kernel_library.h"
#include "core/parameters.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

class KernelIntegral final : public Integral {
 public:
  KernelIntegral(const IntegrandKernel& kernel, const Integrand& integrand) : kernel_(kernel), integrand_(integrand) {}
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
    constexpr std::size_t kMostTechniques = 16;
    std::array<const std::uint32_t*, kMostIntegrandDims> high, low;
    std::array<T*, kMostTechniques> pdfs;
    const int dims = integrand_.techniques[static_cast<std::size_t>(call.technique)].layout.dims();
    for (int d = 0; d < dims; ++d) {
      high[static_cast<std::size_t>(d)] = points.high(call.first_dim + d);
      low[static_cast<std::size_t>(d)] = points.low(call.first_dim + d);
    }
    for (std::size_t k = 0; k < call.set.size(); ++k) pdfs[k] = terms.pdf(call.slot, static_cast<int>(k));
    kernel({integrand_.parameters.data(), call.technique, dims, high.data(), low.data(), points.stride(),
            terms.value(call.slot, 0), pdfs.data(), call.set.data(), static_cast<int>(call.set.size())});
  }

  const IntegrandKernel& kernel_;
  const Integrand& integrand_;
};

IntegrandKernel find_kernel(const std::string& name) {
  const auto& table = kernels<IntegrandKernels>();
  for (std::size_t f = 0; f < table.count; ++f) {
    const IntegrandFamily& family = table.families[f];
    for (std::size_t i = 0; i < family.count; ++i) {
      if (family.integrands[i].name == name) return family.integrands[i];
    }
  }
  fail(ExitCode::kIo, "the kernel library has no integrand '{}'; it is of another version", name);
}

// To add one: its formula in scenes/integrands_FAMILY.kernel.cpp, its row, with its exact moments, in
// scenes/integrands_FAMILY.cpp.
const IntegrandRows& rows() {
  static const IntegrandRows kRows = [] {
    IntegrandRows all;
    for (IntegrandRows family : {step_integrands(), ramp_integrands(), smooth_integrands(), genz_integrands(),
                                 product_integrands(), singular_integrands(), mis_integrands()}) {
      std::move(family.begin(), family.end(), std::back_inserter(all));
    }
    return all;
  }();
  return kRows;
}

const IntegrandRow* find_row(std::string_view name) {
  const auto found = std::find_if(rows().begin(), rows().end(), [&](const auto& r) { return r.info.name == name; });
  return found == rows().end() ? nullptr : &*found;
}

// Names whose other spelling follows no rule.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kOtherSpellings = {{
    {"halfplane_irr", "halfplane"},
    {"halfspace3_irr", "halfspace:d=3"},
    {"halfspace4_irr", "halfspace:d=4"},
    {"simplex4", "simplex:d=4"},
    {"ball3", "ball:d=3"},
    {"ball4", "ball:d=4"},
    {"checker7", "checker:n=7"},
    {"checker8", "checker:n=8"},
}};

}  // namespace

AnalyticSource::AnalyticSource(Integrand integrand, std::string fingerprint)
    : integrand_(std::move(integrand)), kernel_(find_kernel(integrand_.kernel)), fingerprint_(std::move(fingerprint)) {
  if (integrand_.techniques.empty()) integrand_.techniques = {{"mean", pairs(integrand_.dims)}};
}

PixelIntegral AnalyticSource::pixel(int) const {
  return {{0, 0, 0}, std::make_unique<KernelIntegral>(kernel_, integrand_)};
}

std::vector<IntegrandInfo> analytic_scenes() {
  std::vector<IntegrandInfo> infos;
  for (const IntegrandRow& row : rows()) infos.push_back(row.info);
  return infos;
}

std::string analytic_scene_name(const std::string& name) {
  for (const auto& [other, own] : kOtherSpellings) {
    if (name == other) return std::string(own);
  }
  std::string head = name, parameters;
  const std::size_t suffix = name.rfind("_d"), digits = suffix + 2;
  if (suffix != std::string::npos && digits < name.size() &&
      name.find_first_not_of("0123456789", digits) == std::string::npos) {
    head = name.substr(0, suffix);
    parameters = ":d=" + name.substr(digits);
  }
  std::replace(head.begin(), head.end(), '_', '-');
  return find_row(head) ? head + parameters : name;
}

std::unique_ptr<IntegralSource> make_analytic_scene(const std::string& name) {
  const std::string own = analytic_scene_name(name);
  const SplitName split = split_name(own);
  const IntegrandRow* found = find_row(split.head);
  if (!found) return nullptr;
  const std::string subject = fmt::format("scene '{}'", name);
  Integrand integrand = found->make(subject, parse_parameters(subject, split.parameters, found->parameters));
  if (integrand.kernel.empty()) integrand.kernel = found->info.name;
  return std::make_unique<AnalyticSource>(std::move(integrand), own);
}

}  // namespace halfslope
