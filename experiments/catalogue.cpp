#include "experiments/catalogue.h"

#include "core/assertion.h"
#include "core/error.h"
#include "estimators/direct_lighting.h"
#include "scenes/catalogue.h"
#include "scenes/integrand.h"
#include "scenes/loader.h"

namespace halfslope {
namespace {

std::unique_ptr<IntegralSource> render_source(Scene scene, const Catalogue::Resolution& resolution) {
  const Sensor& sensor = scene.sensor;
  if (resolution && sensor.kind == Sensor::Kind::kRays) {
    fail(ExitCode::kBadInput, "scene '{}': its sensor gives {} rays one by one, so `resolution` does not apply",
         scene.name, sensor.rays.size());
  }
  const int width = resolution ? (*resolution)[0] : sensor.width,
            height = resolution ? (*resolution)[1] : sensor.height;
  return std::make_unique<DirectLighting>(std::move(scene), width, height);
}

}  // namespace

Catalogue Catalogue::built_in() {
  Catalogue catalogue;
  catalogue.samplers = SamplerCatalogue::built_in();
  catalogue.estimators = EstimatorCatalogue::built_in();
  for (const SceneEntry& scene : rendered_scenes()) {
    catalogue.add_scene({scene.name, "", scene.description, scene.reference, true},
                        [](const std::string& name, const Resolution& resolution) {
                          return render_source(load_catalogue_scene(name), resolution);
                        });
  }
  for (const IntegrandInfo& scene : analytic_scenes()) {
    catalogue.add_scene(
        {scene.name, scene.parameters, scene.description, scene.reference, false, scene.integral, scene.variance},
        [](const std::string& name, const Resolution&) { return make_analytic_scene(name); });
  }
  return catalogue;
}

void Catalogue::add_scene(SceneInfo info, MakeScene make) {
  for (const Entry& entry : entries_) assert_equal(entry.info.name == info.name, false, "a scene of that name");
  entries_.push_back({std::move(info), std::move(make)});
}

std::vector<SceneInfo> Catalogue::scenes() const {
  std::vector<SceneInfo> infos;
  for (const Entry& entry : entries_) infos.push_back(entry.info);
  return infos;
}

std::unique_ptr<IntegralSource> Catalogue::make_scene(const std::string& name, const Resolution& resolution) const {
  if (name.ends_with(".xml")) return render_source(load_scene(name), resolution);
  const std::string head = name.substr(0, name.find(':'));
  std::vector<std::string> names;
  for (const Entry& entry : entries_) {
    if (entry.info.name == head) return entry.make(name, resolution);
    names.push_back(entry.info.name);
  }
  if (auto scene = make_analytic_scene(name)) return scene;  // in its other spelling
  fail(ExitCode::kBadInput,
       "there is no scene '{}'{} (`halfslope list scenes` names them all; a path that ends in .xml is a Mitsuba 3 "
       "scene)",
       head, did_you_mean(head, names));
}

}  // namespace halfslope
