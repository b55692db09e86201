// Everything an experiment can name.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/integral.h"
#include "estimators/estimator.h"
#include "samplers/catalogue.h"

namespace halfslope {

/// What `list scenes` says of a scene.
struct SceneInfo {
  std::string name, parameters, description, reference;
  bool rendered = false;
  std::optional<double> integral{}, variance{};  ///< where the name alone determines them
};

/// Samplers, estimators and scenes by name. Embedders add their own before they call the command line:
///   auto catalogue = Catalogue::built_in();
///   catalogue.samplers.add(make_my_sampler);
///   catalogue.estimators.add({"my-heuristic", "what it is", "where from"}, my_weight);
///   catalogue.add_scene({"my-scene", "", "what it is", "where from"}, make_my_scene);
///   return halfslope::command_line(argc, argv, catalogue);
class Catalogue {
 public:
  using Resolution = std::optional<std::array<int, 2>>;
  /// Makes the scene of that full name (parameters included); null resolution: the scene's own.
  using MakeScene =
      std::function<std::unique_ptr<IntegralSource>(const std::string& name, const Resolution& resolution)>;
  /// What is asked of paths beside what the scene says.
  struct PathWishes {
    std::optional<int> max_depth, rr_depth;  ///< as PathOptions has them
  };

  static Catalogue built_in();

  SamplerCatalogue samplers;
  EstimatorCatalogue estimators;
  void add_scene(SceneInfo info, MakeScene make);
  std::vector<SceneInfo> scenes() const;
  /// A catalogue scene ("name" or "name:parameters"; an integrand's other spelling too, "sobol_g_d4"), or a Mitsuba
  /// scene where the name ends in ".xml". Throws Error(kBadInput) naming the nearest scene where there is none.
  std::unique_ptr<IntegralSource> make_scene(const std::string& name, const Resolution& resolution) const;
  /// Whether the scene is rendered, so that light travels along paths in it.
  bool has_paths(const std::string& name) const;
  /// The same scene as integrals over paths.
  std::unique_ptr<IntegralSource> make_paths(const std::string& name, const Resolution& resolution,
                                             const PathWishes& wishes) const;

 private:
  struct Entry {
    SceneInfo info;
    MakeScene make;
  };
  std::vector<Entry> entries_;
};

}  // namespace halfslope
