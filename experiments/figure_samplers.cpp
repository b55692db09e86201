#include "experiments/figure_samplers.h"

#include "core/error.h"
#include "experiments/command_flags.h"
#include "samplers/file_points.h"

namespace halfslope {

std::vector<std::string> figure_samplers(const FigureRequest& request, const Catalogue& catalogue,
                                         const std::vector<std::string>& usual, int dims) {
  const SamplerCatalogue& samplers = catalogue.samplers;
  std::vector<std::string> names;
  for (const std::string& name : request.spec.samplers) {
    const auto sampler = make_sampler(catalogue, name, "--samplers");
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
  return !point_file_of(info.name).empty() ? SampleCounts{{info.max_count}, false} : usual;
}

}  // namespace halfslope
