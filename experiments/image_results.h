// Results of images that other renderers wrote: the same cells, rates and tables as a run's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/image_metrics.h"
#include "experiments/image_pattern.h"
#include "experiments/image_reference.h"
#include "experiments/results.h"

namespace halfslope {

struct ImageRequest {
  std::string pattern;
  ReferenceFiles reference;  ///< with the field {scene} where each scene has its own
  std::string layer;         ///< of the images; empty: their own channels
  int threads = 0;           ///< 0: every core; the results do not depend on it
  bool quiet = false;
};

/// A metric of one cell, as a row of metrics.csv.
struct NamedMetric {
  std::string name;
  int version = 1;
  MetricValue value;
};

/// What a cell of images has beside its row in convergence.csv.
struct ImageCell {
  std::vector<std::uint64_t> seeds;         ///< of the images that were read, ascending; 0 where they have none
  std::vector<ReplicateErrors> replicates;  ///< one for each of them
  std::vector<NamedMetric> metrics;
};

/// A scene's reference, in words and without its values.
struct SceneReference {
  std::string scene, description;
  bool variance_known = false;
  double mean = 0, mean_variance = 0;
};

struct ImageResults {
  Results results;
  std::vector<ImageCell> cells;  ///< as results.cells
  std::vector<SceneReference> references;
  std::vector<ImageProblem> problems;  ///< all that was named and gone round
  std::vector<ImageProblem> notes;     ///< what was gone round and is no problem: the reference among the images
  std::size_t images = 0;              ///< that were read
};

/// Reads every image that matches and measures it against its scene's reference. The seeds of a cell are its
/// replicates; an image is held no longer than it takes to add it up.
///
/// An image that is the reference itself is left out, and noted. What is wrong is in `problems`, and the rest is
/// analysed: an image that cannot be read or differs from the reference in size or channels is left out; values that
/// are not finite stay, are counted, and make the cell `invalid`, with the first seed and pixel in first_bad_replicate
/// and first_bad_pixel; a seed that a cell lacks and others of its scene and precision have leaves the cell's own row
/// to the seeds there are, while `replicate_mse`, which rates and comparisons pair, has the seeds in common alone.
///
/// The precision, where the pattern has none, is "f16" for a line whose first readable image stores halves, else "f32";
/// either sets the rounding that rates stay away from.
///
/// Throws Error(kUsage) for a pattern or a path that is none, Error(kBadInput) if no image could be measured, with the
/// first problem, and Error(kInterrupted).
ImageResults analyze_images(const ImageRequest& request);

/// metrics.csv: a row for each cell and metric.
std::string metrics_csv(const ImageResults& images);

/// manifest.json: what was read, measured against what, and what was wrong.
std::string images_manifest(const ImageRequest& request, const ImageResults& images, const std::string& name);

}  // namespace halfslope
