// What a folder of analysed images has beside the tables of a run.
#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/version.h"
#include "experiments/image_results.h"

namespace halfslope {

std::string metrics_csv(const ImageResults& images) {
  CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "metric", "version", "value", "lo", "hi",
                 "reference_share"});
  for (std::size_t c = 0; c < images.cells.size(); ++c) {
    const CellName& name = images.results.cells[c].name;
    for (const NamedMetric& metric : images.cells[c].metrics) {
      csv.row(name.scene, name.estimator, name.sampler, name.precision, name.samples, metric.name, metric.version,
              metric.value.value, metric.value.lo, metric.value.hi, metric.value.reference_share);
    }
  }
  return csv.text();
}

std::string images_manifest(const ImageRequest& request, const ImageResults& images, const std::string& name) {
  using Json = nlohmann::ordered_json;
  Json manifest;
  manifest["schema_version"] = 1;
  manifest["name"] = name;
  manifest["kind"] = "images";
  manifest["version"] = version();
  manifest["compiler"] = compiler();
  manifest["pattern"] = request.pattern;
  manifest["layer"] = request.layer.empty() ? Json(nullptr) : Json(request.layer);
  manifest["images"] = images.images;
  manifest["cells"] = images.cells.size();
  for (const SceneReference& reference : images.references) {
    manifest["references"].push_back(
        {{"scene", reference.scene},
         {"origin", reference.description},
         {"mean", reference.mean},
         {"mean_variance", reference.variance_known ? Json(reference.mean_variance) : Json(nullptr)}});
  }
  manifest["problems"] = Json::array();
  for (const ImageProblem& problem : images.problems)
    manifest["problems"].push_back({{"what", problem.what}, {"problem", problem.text}});
  manifest["invalid"] = Json::array();
  for (const CellResult& cell : images.results.cells) {
    if (!cell.statistics.invalid) continue;
    manifest["invalid"].push_back({{"cell", to_string(cell.name)},
                                   {"nonfinite", cell.statistics.nonfinite},
                                   {"first_seed", cell.first_bad_replicate},
                                   {"first_pixel", cell.first_bad_pixel}});
  }
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace halfslope
