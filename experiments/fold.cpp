#include "experiments/fold.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/compensated_sum.h"
#include "analysis/tails.h"
#include "core/random.h"

namespace halfslope {
namespace {

/// One batch of replicates over all tiles.
struct Batch {
  std::vector<ReplicateSums> sums;
  std::map<std::uint32_t, std::vector<SquaredErrors>> squared;

  explicit Batch(std::size_t replicates) : sums(replicates) {}
  void add(const CellPart& part) {
    const std::size_t replicates = sums.size();
    for (std::size_t r = 0; r < replicates; ++r) {
      const ReplicateSums& from = part.replicates[r];
      ReplicateSums& to = sums[r];
      to.value += from.value;
      to.error += from.error;
      to.abs_error += from.abs_error;
      to.spread += from.spread;
      const bool larger = from.max_abs_error > to.max_abs_error || std::isnan(from.max_abs_error);
      if (larger && !std::isnan(to.max_abs_error)) to.max_abs_error = from.max_abs_error;
    }
    for (std::size_t g = 0; g < part.regions.size(); ++g) {
      auto& region = squared[part.regions[g]];
      region.resize(replicates);
      for (std::size_t r = 0; r < replicates; ++r) {
        region[r].plain += part.squared[g * replicates + r].plain;
        region[r].relative += part.squared[g * replicates + r].relative;
      }
    }
  }
};

}  // namespace

FoldedCell fold_cell(const Plan& plan, const Cell& cell, const Reference& reference, const Journal& journal,
                     std::int64_t replicates) {
  const Pass& pass = plan.passes[cell.pass];
  const PlannedScene& scene = plan.scenes[pass.scene];
  const auto channels = static_cast<std::size_t>(scene.source->channels());
  const std::size_t part_index = cell.heuristic * pass.samples.size() + cell.n;
  const bool keep = replicates <= kMostKept;
  const bool several_regions = scene.source->regions().size() > 1;

  FoldedCell folded;
  CellData& data = folded.data;
  data.replicates = replicates;
  data.integrals = static_cast<std::int64_t>(scene.pixels.size() * channels);
  data.reference_mean = reference.mean;
  data.reference_se = reference.mean_se;
  data.reference_mse = reference.mean_variance;
  data.reference_mse_noise = reference.mse_noise;
  data.reference_relmse = reference.mean_relative_variance;
  data.reference_relmse_noise = reference.relmse_noise;
  data.bootstrap_seed = hash_text(to_string(cell_name(plan, cell)));
  data.interval = plan.interval;
  data.deterministic = !pass.randomised;
  data.infinite_variance = has_infinite_variance(*scene.source);
  const auto integrals = static_cast<double>(data.integrals);

  if (several_regions) {
    for (const int pixel : scene.pixels)
      ++folded.regions[static_cast<std::uint32_t>(scene.source->region(pixel))].pixels;
  }
  std::vector<Moments> merged;  // of every integral, where batches have to be merged or an image is written
  CompensatedSum abs_error, m2, m2_squared, m4, other_squared_error;
  std::vector<double> worst;
  folded.first_bad_replicate = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t b = 0; b < pass.batches_within(replicates); ++b) {
    const Unit& first = plan.units[pass.first_unit + b * pass.tiles];
    Batch batch(static_cast<std::size_t>(first.replicate_count));
    for (std::size_t t = 0; t < pass.tiles; ++t) {
      const std::uint64_t unit = pass.first_unit + b * pass.tiles + t;
      const CellPart part = decode_part(
          part_index, [&](std::uint64_t offset, std::uint64_t size) { return journal.read(unit, offset, size); });
      batch.add(part);
      data.abs_error.merge(part.abs_error);
      if (part.nonfinite > 0) {
        if (part.first_bad_replicate < folded.first_bad_replicate) {
          folded.first_bad_replicate = part.first_bad_replicate;
          folded.first_bad_pixel = part.first_bad_pixel;
        }
        data.nonfinite += static_cast<std::int64_t>(part.nonfinite);
      }
      m2.add(part.spread.m2);
      m2_squared.add(part.spread.m2_squared);
      m4.add(part.spread.m4);
      other_squared_error.add(part.other_squared_error);
      worst.insert(worst.end(), part.worst.begin(), part.worst.end());
      if (!part.integrals.empty()) {
        merged.resize(static_cast<std::size_t>(data.integrals));
        const std::size_t begin = plan.units[unit].first_pixel * channels;
        for (std::size_t i = 0; i < part.integrals.size(); ++i) merged[begin + i].merge(part.integrals[i]);
      }
    }
    for (std::size_t r = 0; r < batch.sums.size(); ++r) {
      ReplicateErrors errors;
      errors.mean = batch.sums[r].value / integrals;
      errors.mean_error = batch.sums[r].error / integrals;
      errors.mae = batch.sums[r].abs_error / integrals;
      errors.variance = batch.sums[r].spread / integrals;
      errors.max_abs_error = batch.sums[r].max_abs_error;
      for (const auto& [region, squared] : batch.squared) {
        errors.mse += squared[r].plain;
        errors.relmse += squared[r].relative;
      }
      errors.mse /= integrals;
      errors.relmse /= integrals;
      data.mean.add(errors.mean);
      data.mean_error.add(errors.mean_error);
      data.mse.add(errors.mse);
      data.relmse.add(errors.relmse);
      abs_error.add(errors.mae);
      if (keep) data.per_replicate.push_back(errors);
    }
    if (keep && several_regions) {
      for (const auto& [region, squared] : batch.squared) {
        RegionErrors& errors = folded.regions[region];
        const auto count = static_cast<double>(errors.pixels * static_cast<std::int64_t>(channels));
        for (const SquaredErrors& s : squared) {
          errors.mse.push_back(s.plain / count);
          errors.relmse.push_back(s.relative / count);
        }
      }
    }
  }
  SpreadSums spread;
  if (pass.batches() > 1) {
    for (std::size_t i = 0; i < merged.size(); ++i) {
      spread.add(merged[i]);
      worst.push_back(mean_squared_error(merged[i], reference.value[i]));
    }
  }
  data.sum_m2 = m2.value() + spread.m2;
  data.sum_m2_squared = m2_squared.value() + spread.m2_squared;
  data.sum_m4 = m4.value() + spread.m4;
  other_squared_error.add(keep_largest(worst, worst_count(data.integrals)));
  CompensatedSum worst_sum;
  for (const double squared : worst) worst_sum.add(squared);
  data.worst_squared_error = worst_sum.value();
  data.other_squared_error = other_squared_error.value();
  data.mae = abs_error.value() / static_cast<double>(replicates);
  if (cell.image) folded.integrals = std::move(merged);
  return folded;
}

}  // namespace halfslope
