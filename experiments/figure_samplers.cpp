#include "experiments/figure_samplers.h"

#include "core/error.h"
#include "experiments/command_flags.h"

namespace halfslope {
namespace {

bool is_file(const std::string& name) { return name.starts_with("file") && name.find(':') != std::string::npos; }

}  // namespace

std::vector<std::string> figure_samplers(const FigureRequest& request, const Catalogue& catalogue,
                                         const std::vector<std::string>& usual, int dims) {
  const SamplerCatalogue& samplers = catalogue.samplers;
  std::vector<std::string> names;
  for (const std::string& name : request.spec.samplers) {
    const auto sampler = is_file(name) ? samplers.make(name) : flag("--samplers", [&] { return samplers.make(name); });
    if (const int most = sampler->info().max_dims; most < dims) {
      fail(ExitCode::kUsage, "--samplers: '{}' has at most {} dimension{}; {} are needed", name, most,
           most == 1 ? "" : "s", dims);
    }
    names.push_back(name);
  }
  if (!names.empty()) return names;
  for (const std::string& name : usual) {
    if (samplers.has(name) && samplers.make(name)->info().max_dims >= dims) names.push_back(name);
  }
  if (names.empty()) fail(ExitCode::kUsage, "--samplers is missing: `halfslope list samplers` names them");
  return names;
}

SampleCounts figure_counts(const FigureRequest& request, const SamplerInfo& info, const SampleCounts& usual) {
  if (!request.spec.samples.counts.empty()) return request.spec.samples;
  return is_file(info.name) ? SampleCounts{{info.max_count}, false} : usual;
}

void check_count(const Sampler& sampler, std::uint64_t count, const Layout& layout) {
  const auto neighbours = sampler.illegal(count, layout);
  if (!neighbours) return;
  std::string nearest;
  for (const auto& n : {neighbours->below, neighbours->above}) {
    if (n) nearest += (nearest.empty() ? "" : " and ") + std::to_string(*n);
  }
  fail(ExitCode::kUsage, "--samples: sampler '{}' cannot make {} points in {} dimension{}; the nearest legal: {}",
       sampler.info().name, count, layout.dims(), layout.dims() == 1 ? "" : "s", nearest);
}

}  // namespace halfslope
