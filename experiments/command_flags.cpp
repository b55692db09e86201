#include "experiments/command_flags.h"

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
  if (scene.ends_with(".xml")) return catalogue.make_scene(scene, resolution);
  return flag("--scene", [&] { return catalogue.make_scene(scene, resolution); });
}

}  // namespace halfslope
