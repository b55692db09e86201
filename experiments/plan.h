// What will be done, decided before the first sample: cells, the passes that fill them, and what is skipped and why.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/integral.h"
#include "core/random.h"
#include "estimators/estimator.h"
#include "experiments/catalogue.h"
#include "experiments/cell_name.h"
#include "experiments/measures.h"
#include "experiments/spec.h"

namespace halfslope {

struct PlannedScene {
  std::string name;
  std::shared_ptr<const IntegralSource> source;
  bool paths = false;       ///< whether its integrals are over paths, and its estimators of them
  std::vector<int> pixels;  ///< the chosen ones, ascending; indices into the full image
  std::vector<Estimator> estimators;
  std::vector<std::pair<std::string, std::string>> misfits;  ///< estimators that it cannot have, and why
};

/// A run over points that several cells share: one scene, precision, sampler and allocation; every heuristic and N.
struct Pass {
  std::size_t scene = 0;
  Precision precision = Precision::kF32;
  std::string sampler;
  bool sequence = false, randomised = true;
  Allocation allocation;
  std::vector<std::size_t> estimators;  ///< indices into the scene's
  std::vector<std::uint64_t> samples;   ///< N, ascending, all legal
  std::int64_t replicates = 1;          ///< that the tables are made of; in a fresh plan the most there can be
  std::vector<std::int64_t> stages;     ///< replicates after each stage, after which it may stop; a plain run has one
  StreamKey key;
  int tile_pixels = 256;
  std::int64_t batch_replicates = 64;
  std::uint64_t first_unit = 0;          ///< the number of its first unit in the plan
  std::size_t tiles = 1;                 ///< of its pixels: as many units has a batch, side by side
  std::vector<std::int64_t> batch_ends;  ///< replicates after each batch; every stage ends with one

  std::size_t batches() const { return batch_ends.size(); }
  /// Batches among the first `replicates`, an end of a stage.
  std::size_t batches_within(std::int64_t replicates) const;
  /// Integrand evaluations that one replicate of one pixel takes.
  std::uint64_t evaluations() const;
};

/// The smallest piece of work: a tile of a pass's pixels and a batch of its replicates.
struct Unit {
  std::size_t pass;
  std::size_t first_pixel, pixel_count;  ///< positions in the scene's `pixels`
  std::int64_t first_replicate, replicate_count;
};

/// A row of convergence.csv: where its numbers are found.
struct Cell {
  std::size_t scene, estimator;
  std::string sampler;
  Precision precision;
  std::uint64_t samples;
  std::size_t pass, heuristic, n;  ///< the pass, the estimator's place in it, and N's
  bool image = false;              ///< an EXR is written
};

struct Plan {
  std::vector<PlannedScene> scenes;
  std::vector<Pass> passes;
  std::vector<Unit> units;
  std::vector<Cell> cells;                                ///< in the order of the tables
  MeasuresPlan measures;                                  ///< of the samplers' points
  std::vector<std::string> sampler_fingerprints;          ///< of the samplers that have one
  std::vector<std::string> skips;                         ///< what is not done, and why
  std::vector<std::string> left_out;                      ///< those of them that take something from the tables
  IntervalMethod interval = IntervalMethod::kBootstrapT;  ///< of the RMSE
  double evaluations() const;                             ///< integrand evaluations of all passes' replicates
  /// Of so many replicates of one pass.
  double evaluations(const Pass& pass, std::int64_t replicates) const;
};

/// Resolves names and splits the work. Throws Error for names that are not in the catalogue (naming the nearest),
/// techniques that a scene lacks, N that a sampler cannot take (naming the legal neighbours).
Plan make_plan(const Spec& spec, const Catalogue& catalogue);

/// Why the estimator cannot take N = `samples` of these points, `layout` being its allocation's, and which N next to it
/// it can; empty if it can.
std::string illegal_samples(const Estimator& estimator, const Sampler& sampler, const Layout& layout,
                            std::uint64_t samples);

/// Whether the variance of the scene's integrand is known to be infinite: no squared error of an estimate has an
/// expectation then, and no rate.
bool has_infinite_variance(const IntegralSource& source);

CellName cell_name(const Plan& plan, const Cell& cell);

}  // namespace halfslope
