// Estimators by name: techniques, how many samples of each, and the heuristic that combines them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/integral.h"
#include "core/layout.h"
#include "estimators/kernels.h"

namespace halfslope {

/// Which techniques a round of samples draws, and how often: indices into the scene's techniques, ascending.
struct Allocation {
  std::vector<int> techniques;
  std::vector<int> counts;
  /// A round is one sample, of technique i with probability counts[i] / Σ counts.
  bool one_sample = false;
  /// A round is one path, with a sample of each technique at every vertex.
  std::optional<PathShape> path = std::nullopt;

  /// Samples of one round: N is a multiple of it.
  int round() const;
  /// The dimensions of the point that drives one round: each technique's layout, `counts` times, in order; of one
  /// sample the choice, then what the techniques share (estimators/one_sample.h).
  Layout layout(std::span<const Technique> catalogue) const;
  bool operator==(const Allocation&) const = default;
};

struct Estimator {
  std::string name;
  Heuristic heuristic;
  Allocation allocation;
};

/// What `list estimators` says of one name.
struct EstimatorInfo {
  std::string name, description, reference;
};

/// The heuristics that estimators' names begin with, each over samples of every technique or, as
/// one-sample-HEURISTIC, over one of a technique chosen at random (the optimal ones excepted). Embedders add their own
/// before they call the command line.
class EstimatorCatalogue {
 public:
  static EstimatorCatalogue built_in();

  /// Adds a heuristic without parameters under info.name, which is letters, digits, '-' and '_'; a name that list()
  /// has already is an assertion failure. `weight` is called from several threads, for each sample of each
  /// technique; a run folder knows it by its name alone, so a changed one wants another name or --overwrite.
  void add(EstimatorInfo info, WeightFunction weight);
  /// Techniques first, then heuristics in the order they were added.
  std::vector<EstimatorInfo> list() const;
  /// HEURISTIC[:PARAMETER][@TECHNIQUE[*COUNT]+…], e.g. "balance@light+bsdf", "power:3@light*3+bsdf", or
  /// "one-sample-balance@light*3+bsdf", which draws from light with probability 3/4; without '@' over light+bsdf, or
  /// over all techniques of a scene that lacks those two. The name of a technique alone is that
  /// technique's own estimator. Throws Error(kBadInput) that says what is wrong and what the scene offers.
  Estimator parse(const std::string& name, std::span<const Technique> techniques) const;
  /// path-HEURISTIC[:PARAMETER][@LIGHT+bsdf] or path-TECHNIQUE, of a source of paths: a light technique and the BSDF's,
  /// one sample of each at every vertex. The heuristic weights those; path-TECHNIQUE takes its own sample alone, and of
  /// the other's what it could not have found. All estimators of one light technique share their paths.
  Estimator parse_path(const std::string& name, std::span<const Technique> techniques, const PathShape& shape) const;
  /// Whichever of the two the source takes.
  Estimator parse(const std::string& name, const IntegralSource& source) const;

 private:
  /// A heuristic's one parameter: a number from `least` to `most`.
  struct Parameter {
    std::string meaning;
    double least, most, standard;
  };
  struct Entry {
    EstimatorInfo info;
    std::string name;
    Heuristic heuristic;
    std::optional<Parameter> parameter;
  };
  const Entry* find_entry(std::string_view kind) const;
  /// Sets the heuristic, and whether it takes one sample a round.
  void parse_heuristic(Estimator& estimator, std::string_view text, std::span<const Technique> techniques) const;

  std::vector<Entry> entries_;
};

/// Whether the name is one of a path's estimator: it begins with "path-".
bool is_path_estimator(std::string_view name);

/// EstimatorCatalogue::parse with the built-in heuristics.
Estimator parse_estimator(const std::string& name, std::span<const Technique> techniques);

/// What is run where an experiment names no estimators: light, bsdf, average, balance and power, or what a scene
/// without those two techniques has.
std::vector<std::string> default_estimators(std::span<const Technique> techniques);

}  // namespace halfslope
