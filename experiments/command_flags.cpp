#include "experiments/command_flags.h"

#include "samplers/file_points.h"
#include "scenes/catalogue.h"

namespace halfslope {

Catalogue::Resolution parse_resolution(const std::string& text) {
  Spec spec;
  if (!text.empty()) apply_flag(spec, "resolution", text);
  return spec.resolution;
}

Precision parse_precision(const std::string& text) {
  Spec spec;
  apply_flag(spec, "precision", text);
  if (spec.precision.size() != 1) fail(ExitCode::kUsage, "--precision: one of f32, f64 at a time");
  return spec.precision.front();
}

std::unique_ptr<IntegralSource> make_source(const Catalogue& catalogue, const std::string& scene,
                                            const Catalogue::Resolution& resolution) {
  if (is_scene_file(scene)) return catalogue.make_scene(scene, resolution);
  return flag("--scene", [&] { return catalogue.make_scene(scene, resolution); });
}

std::unique_ptr<IntegralSource> make_path_source(const Catalogue& catalogue, const std::string& scene,
                                                 const Catalogue::Resolution& resolution,
                                                 const Catalogue::PathWishes& wishes) {
  if (is_scene_file(scene)) return catalogue.make_paths(scene, resolution, wishes);
  return flag("--scene", [&] { return catalogue.make_paths(scene, resolution, wishes); });
}

std::unique_ptr<Sampler> make_sampler(const Catalogue& catalogue, const std::string& sampler, const char* flag_name) {
  const auto make = [&] { return catalogue.samplers.make(sampler); };
  return point_file_of(sampler).empty() ? flag(flag_name, make) : make();
}

void check_count(const Sampler& sampler, std::uint64_t count, const Layout& layout, const char* flag_name) {
  const auto neighbours = sampler.illegal(count, layout);
  if (!neighbours) return;
  std::string nearest;
  for (const auto& n : {neighbours->below, neighbours->above}) {
    if (n) nearest += (nearest.empty() ? "" : " and ") + std::to_string(*n);
  }
  fail(ExitCode::kUsage, "{}: sampler '{}' cannot make {} points in {} dimension{}; the nearest legal: {}", flag_name,
       sampler.info().name, count, layout.dims(), layout.dims() == 1 ? "" : "s", nearest);
}

void check_replicate(const SamplerInfo& sampler, std::uint32_t replicate) {
  if (!sampler.replicates || replicate < *sampler.replicates) return;
  fail(ExitCode::kUsage, "--replicate: sampler '{}' has {} replicate{}, from 0 on, found {}", sampler.name,
       *sampler.replicates, *sampler.replicates == 1 ? "" : "s", replicate);
}

}  // namespace halfslope
