// The measures of an experiment: discrepancies of the points that its samplers gave.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/measures.h"
#include "core/layout.h"
#include "core/random.h"
#include "experiments/spec.h"
#include "samplers/catalogue.h"

namespace halfslope {

/// One N: which measures it has, and the names of the values that each replicate gives.
struct MeasuredCount {
  std::uint64_t count = 0;
  std::vector<std::size_t> measures;  ///< positions in the plan's
  std::vector<std::string> rows;
};

/// The points of one sampler that are measured: those of pixel 0 of a layout of one pair, in binary64, as `halfslope
/// points` prints them.
struct MeasuredPoints {
  std::string sampler;
  Layout layout;
  bool sequence = false;              ///< smaller N are prefixes of the largest; else each N has points of its own
  std::vector<MeasuredCount> counts;  ///< by N, ascending, all legal
  std::int64_t replicates = 1;
  StreamKey key;

  std::size_t rows() const;  ///< of discrepancy.csv
};

struct MeasuresPlan {
  std::vector<Measure> measures;       ///< in the catalogue's order; none: nothing is measured
  std::vector<MeasuredPoints> points;  ///< in the experiment's order of samplers

  std::size_t rows() const;  ///< of discrepancy.csv
};

/// Positions in `measures` of those that can measure `count` points, and what their values are called.
MeasuredCount measured_count(std::span<const Measure> measures, std::uint64_t count, std::size_t dims);

/// What the spec's measures take, and a line in `left_out` for each thing that they leave out: samplers without pairs,
/// N that a sampler's pairs cannot have, N above 2²⁰, replicates above 4096.
MeasuresPlan plan_measures(const Spec& spec, const SamplerCatalogue& samplers, std::vector<std::string>& left_out);

/// Lines of --dry-run: what will be measured.
std::string describe_measures(const MeasuresPlan& plan);

/// The rows of discrepancy.csv in its order: the plan's points, N, replicate, measure.
using Measurements = std::vector<MeasuredValue>;

/// Makes the points and measures them in parallel; the values depend on the plan alone. `label` is shown with the
/// progress, unless `quiet`. Throws Error(kInterrupted) if a signal comes meanwhile.
Measurements measure_points(const MeasuresPlan& plan, const SamplerCatalogue& samplers, int threads,
                            const std::string& label, bool quiet);

/// Writes discrepancy.csv to `path`, an AtomicFile; nothing where no measure was asked for.
void write_discrepancy_csv(const std::filesystem::path& path, const MeasuresPlan& plan, const Measurements& measured);

/// For people: each sampler's largest N, means over replicates. Empty where nothing was measured.
std::string measures_summary(const MeasuresPlan& plan, const Measurements& measured);

}  // namespace halfslope
