#include "experiments/results.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <map>

#include "analysis/intervals.h"
#include "core/error.h"
#include "core/random.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"

namespace halfslope {
namespace {

// Means of squared errors over a part of the image, with the interval of log M.
struct Squared {
  std::optional<double> value, lo, hi;
};

Squared squared(const std::vector<double>& replicates, std::uint64_t seed, double reference_share) {
  Moments moments;
  moments.add(std::span<const double>(replicates));
  Squared result;
  if (!std::isfinite(moments.mean) || moments.mean - reference_share <= 0) return result;
  result.value = moments.mean - reference_share;
  if (const auto interval = log_mean_bootstrap_t(replicates, seed)) {
    const double lo = std::exp(interval->lo) - reference_share, hi = std::exp(interval->hi) - reference_share;
    if (lo > 0) result.lo = lo;
    if (hi > 0) result.hi = hi;
  }
  return result;
}

std::optional<double> root(const std::optional<double>& x) { return x ? std::optional(std::sqrt(*x)) : std::nullopt; }

/// The reference's mean variance and relative variance over a part of the image.
struct ReferenceShare {
  double plain = 0, relative = 0;
  std::int64_t pixels = 0;
};

std::map<std::uint32_t, ReferenceShare> reference_shares(const PlannedScene& scene, const Reference& reference) {
  std::map<std::uint32_t, ReferenceShare> shares;
  const auto channels = static_cast<std::size_t>(scene.source->channels());
  for (std::size_t p = 0; p < scene.pixels.size(); ++p) {
    ReferenceShare& share = shares[static_cast<std::uint32_t>(scene.source->region(scene.pixels[p]))];
    ++share.pixels;
    for (std::size_t c = 0; c < channels; ++c) {
      const double value = reference.value[p * channels + c], variance = reference.variance[p * channels + c];
      share.plain += variance / static_cast<double>(channels);
      share.relative += variance / (value * value + 0.01) / static_cast<double>(channels);
    }
  }
  return shares;
}

// Leaves joined into a part of the image: pixel-weighted means for each replicate.
RegionResult join(const std::string& name, const FoldedCell& folded, const std::vector<std::uint32_t>& leaves,
                  const std::map<std::uint32_t, ReferenceShare>& shares) {
  RegionResult result;
  result.region = name;
  std::vector<double> mse, relmse;
  double share = 0, relative_share = 0;
  for (const std::uint32_t leaf : leaves) {
    const RegionErrors& errors = folded.regions.at(leaf);
    result.pixels += errors.pixels;
    mse.resize(errors.mse.size());
    relmse.resize(errors.mse.size());
    for (std::size_t r = 0; r < errors.mse.size(); ++r) {
      mse[r] += errors.mse[r] * static_cast<double>(errors.pixels);
      relmse[r] += errors.relmse[r] * static_cast<double>(errors.pixels);
    }
    share += shares.at(leaf).plain;
    relative_share += shares.at(leaf).relative;
  }
  const auto pixels = static_cast<double>(result.pixels);
  for (double& x : mse) x /= pixels;
  for (double& x : relmse) x /= pixels;
  const Squared plain = squared(mse, hash_text(name, folded.data.bootstrap_seed), share / pixels);
  const Squared relative = squared(relmse, hash_text(name, folded.data.bootstrap_seed + 1), relative_share / pixels);
  result.rmse = root(plain.value), result.rmse_lo = root(plain.lo), result.rmse_hi = root(plain.hi);
  result.relmse = relative.value, result.relmse_lo = relative.lo, result.relmse_hi = relative.hi;
  return result;
}

std::vector<RegionResult> region_results(const PlannedScene& scene, const FoldedCell& folded,
                                         const CellStatistics& whole,
                                         const std::map<std::uint32_t, ReferenceShare>& shares) {
  std::vector<RegionResult> results;
  if (folded.regions.empty() || folded.regions.begin()->second.mse.empty()) return results;
  const auto names = scene.source->regions();
  std::vector<std::pair<std::string, std::vector<std::uint32_t>>> shapes;  // in the scene's order
  for (const auto& [leaf, errors] : folded.regions) {
    const std::string shape = names[leaf].substr(0, names[leaf].find('/'));
    if (shapes.empty() || shapes.back().first != shape) shapes.emplace_back(shape, std::vector<std::uint32_t>());
    shapes.back().second.push_back(leaf);
  }
  results.push_back({"all", static_cast<std::int64_t>(scene.pixels.size()), whole.rmse, whole.rmse_lo, whole.rmse_hi,
                     whole.relmse, whole.relmse_lo, whole.relmse_hi});
  for (const auto& [shape, leaves] : shapes) {
    results.push_back(join(shape, folded, leaves, shares));
    if (leaves.size() == 1 && names[leaves[0]] == shape) continue;
    for (const std::uint32_t leaf : leaves) results.push_back(join(names[leaf], folded, {leaf}, shares));
  }
  return results;
}

RateResult fit_line(const Plan& plan, std::span<const Reference> references, std::size_t begin,
                    const std::vector<FoldedCell>& line, const SamplerCatalogue& samplers) {
  const Cell& first = plan.cells[begin];
  const Reference& reference = references[first.scene];
  std::vector<double> samples;
  const std::vector<double> reference_mse(line.size(), reference.mean_variance);
  std::vector<std::vector<double>> mse(line.size());
  const bool kept = !line.front().data.per_replicate.empty();
  for (std::size_t j = 0; j < line.size(); ++j) {
    samples.push_back(static_cast<double>(plan.cells[begin + j].samples));
    for (const ReplicateErrors& errors : line[j].data.per_replicate) mse[j].push_back(errors.mse);
    if (!kept) mse[j].push_back(line[j].data.mse.mean);
  }
  const double unit = first.precision == Precision::kF32 ? 0x1p-24 : 0x1p-53;
  // Values are as large as their root mean square, however small their mean.
  const double known = plan.scenes[first.scene].source->variance().value_or(0),
               variance = std::isfinite(known) ? known : 0;
  const double rounding = unit * std::sqrt(reference.mean * reference.mean + variance);
  RateResult rate;
  rate.first_cell = begin;
  const std::string name = cell_name(plan, first);
  rate.fit = fit_rate(samples, mse, reference_mse, hash_text(name.substr(0, name.rfind(',')), 1), rounding * rounding);
  if (const auto mark = rate.fit.status.find("deterministic"); !kept && mark != std::string::npos) {
    // One number at each N not because there was one replicate: they are not kept, so there is no interval.
    rate.fit.status.replace(mark, std::string("deterministic").size(), "many-replicates");
  }
  if (has_infinite_variance(*plan.scenes[first.scene].source)) {
    // The slope would be that of the largest values that happened to be met.
    rate.fit.rate.reset();
    rate.fit.interval.reset();
    rate.fit.status = rate.fit.status.starts_with("invalid") ? "invalid;infinite-variance" : "infinite-variance";
    return rate;
  }
  for (const SamplerInfo& info : samplers.list()) {
    if (info.name == first.sampler) rate.theory = info.rate;
  }
  return rate;
}

}  // namespace

Results collect_results(const Plan& plan, std::span<const Reference> references, const Journal& journal,
                        const SamplerCatalogue& samplers, int threads, const CellVisitor& visitor) {
  Results results;
  results.cells.resize(plan.cells.size());
  std::vector<std::map<std::uint32_t, ReferenceShare>> shares;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s)
    shares.push_back(reference_shares(plan.scenes[s], references[s]));
  const auto same_line = [&](std::size_t a, std::size_t b) {
    const Cell &x = plan.cells[a], &y = plan.cells[b];
    return x.scene == y.scene && x.estimator == y.estimator && x.sampler == y.sampler && x.precision == y.precision;
  };
  // A line of convergence at a time: its replicates are needed together for the rate, and then no more.
  for (std::size_t begin = 0, end = 0; begin < plan.cells.size(); begin = end) {
    if (interrupted()) {
      fail(ExitCode::kInterrupted,
           "interrupted while the tables were made; all units are done: run the same command again to go on");
    }
    while (end < plan.cells.size() && same_line(begin, end)) ++end;
    std::vector<FoldedCell> line(end - begin);
    with_threads(threads, [&](int) {
      tbb::parallel_for(
          begin, end,
          [&](std::size_t c) {
            const Cell& cell = plan.cells[c];
            FoldedCell& folded = line[c - begin] = fold_cell(plan, cell, references[cell.scene], journal);
            visitor.as_folded(cell, folded);
            folded.integrals = {};
            CellResult& result = results.cells[c];
            result.statistics = summarise(folded.data);
            result.regions = region_results(plan.scenes[cell.scene], folded, result.statistics, shares[cell.scene]);
            folded.regions = {};
            result.first_bad_replicate = folded.first_bad_replicate;
            result.first_bad_pixel = folded.first_bad_pixel;
          },
          tbb::simple_partitioner());
    });
    for (std::size_t c = begin; c < end; ++c) visitor.in_order(plan.cells[c], line[c - begin]);
    results.rates.push_back(fit_line(plan, references, begin, line, samplers));
  }
  return results;
}

}  // namespace halfslope
