// Measures of the points that samplers gave, as `run` and `measure` take them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/intervals.h"
#include "analysis/measures.h"
#include "core/layout.h"
#include "core/random.h"
#include "experiments/spec.h"
#include "samplers/catalogue.h"

namespace halfslope {

/// What is to be measured: every sampler at every N.
struct MeasuresRequest {
  std::vector<std::string> samplers;
  SampleCounts counts;
  int dims = 2;
  std::vector<std::string> measures;  ///< names, in the order of the tables
  std::int64_t replicates = 1;
  std::uint64_t seed = 1;
};

/// One N: which measures it has, and the names of the values that each replicate gives.
struct MeasuredCount {
  std::uint64_t count = 0;
  std::vector<std::size_t> measures;  ///< positions in the plan's
  std::vector<std::string> rows;
};

/// The points of one sampler that are measured: those of pixel 0 of a layout of pairs, in binary64, as `halfslope
/// points` prints them.
struct MeasuredPoints {
  std::string sampler;
  Layout layout;
  bool sequence = false;              ///< smaller N are prefixes of the largest; else each N has points of its own
  std::vector<MeasuredCount> counts;  ///< by N, ascending, all legal
  std::int64_t replicates = 1;
  StreamKey key;
  std::optional<GeneratorMatrices> matrices = std::nullopt;  ///< of a digital net: of as many points as are measured

  std::size_t rows() const;  ///< of discrepancy.csv
  /// Whether the matrices alone give the measure of the first `count` points.
  bool net_gives(const Measure& measure, std::uint64_t count) const {
    return measure.takes_net && matrices && measure.takes_net(*matrices, count);
  }
};

struct MeasuresPlan {
  std::vector<Measure> measures;       ///< in the order of the tables; none: nothing is measured
  std::vector<MeasuredPoints> points;  ///< in the order of the request's samplers

  std::size_t rows() const;  ///< of discrepancy.csv
};

/// What the measures take, and a line in `left_out` for each thing that they leave out: samplers without so many
/// dimensions, N that a sampler cannot have or a measure refuses, N above 2²⁰, replicates above 4096. Throws
/// Error(kBadInput) for names that are none.
MeasuresPlan plan_measures(const MeasuresRequest& request, const SamplerCatalogue& samplers,
                           std::vector<std::string>& left_out);

/// The measures of an experiment: of pairs.
MeasuresPlan plan_measures(const Spec& spec, const SamplerCatalogue& samplers, std::vector<std::string>& left_out);

/// Lines of --dry-run: what will be measured.
std::string describe_measures(const MeasuresPlan& plan);

/// The rows of discrepancy.csv in its order: the plan's points, N, replicate, the names of that N.
using Measurements = std::vector<MeasuredValue>;

/// Makes the points and measures them in parallel; the values depend on the plan alone. `label` is shown with the
/// progress, unless `quiet`. Throws Error(kInterrupted) if a signal comes meanwhile.
Measurements measure_points(const MeasuresPlan& plan, const SamplerCatalogue& samplers, int threads,
                            const std::string& label, bool quiet);

/// Visits every row of discrepancy.csv in its order.
using VisitMeasurement = std::function<void(const MeasuredPoints& points, std::uint64_t count, std::int64_t replicate,
                                            const std::string& name, const MeasuredValue& value)>;
void visit_measurements(const MeasuresPlan& plan, const Measurements& measured, const VisitMeasurement& visit);

/// Columns of discrepancy.csv.
std::span<const std::string> discrepancy_columns();

/// One value over the replicates.
struct MeasuredMean {
  const MeasuredPoints* points;
  std::uint64_t count;
  std::string name;
  double value;  ///< mean over replicates
  double
      lower;  ///< the lower end of the 95 % t interval of the mean of lower bounds; of one replicate, its lower bound
  double upper;        ///< the same above
  std::string method;  ///< the replicates' own, and that it is a mean
};

/// Means over replicates: the plan's points, N, the names of that N.
std::vector<MeasuredMean> measured_means(const MeasuresPlan& plan, const Measurements& measured);

/// Writes discrepancy.csv to `path`, an AtomicFile; nothing where no measure was asked for.
void write_discrepancy_csv(const std::filesystem::path& path, const MeasuresPlan& plan, const Measurements& measured);

/// For people: each sampler's largest N, means over replicates. Empty where nothing was measured.
std::string measures_summary(const MeasuresPlan& plan, const Measurements& measured);

}  // namespace halfslope
