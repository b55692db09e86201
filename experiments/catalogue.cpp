#include "experiments/catalogue.h"

#include <algorithm>

#include "core/assertion.h"
#include "core/error.h"
#include "estimators/direct_lighting.h"
#include "estimators/path_transport.h"
#include "scenes/catalogue.h"
#include "scenes/integrand.h"
#include "scenes/loader.h"

namespace halfslope {
namespace {

/// The image's size.
std::array<int, 2> size_of(const Scene& scene, const Catalogue::Resolution& resolution) {
  const Sensor& sensor = scene.sensor;
  if (resolution && sensor.kind == Sensor::Kind::kRays) {
    fail(ExitCode::kBadInput, "scene '{}': its sensor gives {} rays one by one, so `resolution` does not apply",
         scene.name, sensor.rays.size());
  }
  return resolution.value_or(std::array{sensor.width, sensor.height});
}

std::unique_ptr<IntegralSource> render_source(Scene scene, const Catalogue::Resolution& resolution) {
  const auto [width, height] = size_of(scene, resolution);
  return std::make_unique<DirectLighting>(std::move(scene), width, height);
}

constexpr int kUsualDepth = 8;

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

bool Catalogue::has_paths(const std::string& name) const {
  if (is_scene_file(name)) return true;
  const std::string head = name.substr(0, name.find(':'));
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.info.name == head && entry.info.rendered; });
}

std::unique_ptr<IntegralSource> Catalogue::make_paths(const std::string& name, const Resolution& resolution,
                                                      const PathWishes& wishes) const {
  if (!has_paths(name)) {
    make_scene(name, std::nullopt);  // throws where there is none of that name at all
    fail(ExitCode::kBadInput, "scene '{}' is an integrand, and paths are of rendered scenes", name);
  }
  Scene scene = load_named_scene(name);
  const auto [width, height] = size_of(scene, resolution);
  PathOptions options;
  const int own = scene.max_depth.value_or(kUsualDepth);
  if (!wishes.max_depth && own > kMostDepth) {
    fail(ExitCode::kBadInput, "scene '{}': its max_depth is {}, and paths go to {} at most; give another max_depth",
         name, own, kMostDepth);
  }
  options.max_depth = wishes.max_depth.value_or(own < 0 ? kMostDepth : own);
  options.rr_depth = wishes.rr_depth.value_or(scene.rr_depth.value_or(0));
  return std::make_unique<PathTransport>(std::move(scene), width, height, options);
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
  if (is_scene_file(name)) return render_source(load_named_scene(name), resolution);
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
