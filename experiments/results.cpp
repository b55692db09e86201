#include "experiments/results.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <map>

#include "analysis/intervals.h"
#include "core/random.h"

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
                                         const std::map<std::uint32_t, ReferenceShare>& shares) {
  std::vector<RegionResult> results;
  if (folded.regions.empty() || folded.regions.begin()->second.mse.empty()) return results;
  const auto names = scene.source->regions();
  std::vector<std::uint32_t> all;
  std::vector<std::pair<std::string, std::vector<std::uint32_t>>> shapes;  // in the scene's order
  for (const auto& [leaf, errors] : folded.regions) {
    all.push_back(leaf);
    const std::string shape = names[leaf].substr(0, names[leaf].find('/'));
    if (shapes.empty() || shapes.back().first != shape) shapes.emplace_back(shape, std::vector<std::uint32_t>());
    shapes.back().second.push_back(leaf);
  }
  results.push_back(join("all", folded, all, shares));
  for (const auto& [shape, leaves] : shapes) {
    results.push_back(join(shape, folded, leaves, shares));
    if (leaves.size() == 1 && names[leaves[0]] == shape) continue;
    for (const std::uint32_t leaf : leaves) results.push_back(join(names[leaf], folded, {leaf}, shares));
  }
  return results;
}

RateResult fit_line(const Plan& plan, const Results& results, std::span<const Reference> references, std::size_t begin,
                    std::size_t end, const SamplerCatalogue& samplers) {
  const Cell& first = plan.cells[begin];
  std::vector<double> samples, reference_mse;
  std::vector<std::vector<double>> mse;
  bool kept = true;
  for (std::size_t c = begin; c < end; ++c) {
    const CellResult& cell = results.cells[c];
    samples.push_back(static_cast<double>(plan.cells[c].samples));
    reference_mse.push_back(references[first.scene].mean_variance);
    auto& column = mse.emplace_back();
    kept = !cell.per_replicate.empty();
    for (const ReplicateErrors& errors : cell.per_replicate) column.push_back(errors.mse);
    if (!kept) column.push_back(cell.mse);
  }
  const double unit = first.precision == Precision::kF32 ? 0x1p-24 : 0x1p-53;
  const double rounding = unit * std::fabs(references[first.scene].mean);
  RateResult rate;
  rate.first_cell = begin;
  const std::string name = cell_name(plan, first);
  rate.fit = fit_rate(samples, mse, reference_mse, hash_text(name.substr(0, name.rfind(',')), 1), rounding * rounding);
  if (!kept && rate.fit.status == "deterministic")
    rate.fit.status = "many-replicates";  // no interval: they are not kept
  for (const SamplerInfo& info : samplers.list()) {
    if (info.name == first.sampler) rate.theory = info.rate;
  }
  return rate;
}

}  // namespace

Results collect_results(const Plan& plan, std::span<const Reference> references, const Journal& journal,
                        const SamplerCatalogue& samplers, int threads,
                        const std::function<void(std::size_t, const FoldedCell&)>& visit) {
  Results results;
  results.cells.resize(plan.cells.size());
  std::vector<std::map<std::uint32_t, ReferenceShare>> shares;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s)
    shares.push_back(reference_shares(plan.scenes[s], references[s]));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, plan.cells.size(),
        [&](std::size_t c) {
          const Cell& cell = plan.cells[c];
          FoldedCell folded = fold_cell(plan, cell, references[cell.scene], journal);
          visit(c, folded);
          CellResult& result = results.cells[c];
          result.statistics = summarise(folded.data);
          result.mse = folded.data.mse.mean;
          result.regions = region_results(plan.scenes[cell.scene], folded, shares[cell.scene]);
          result.per_replicate = std::move(folded.data.per_replicate);
          result.first_bad_replicate = folded.first_bad_replicate;
          result.first_bad_pixel = folded.first_bad_pixel;
        },
        tbb::simple_partitioner());
  });
  const auto same_line = [&](std::size_t a, std::size_t b) {
    const Cell &x = plan.cells[a], &y = plan.cells[b];
    return x.scene == y.scene && x.estimator == y.estimator && x.sampler == y.sampler && x.precision == y.precision;
  };
  for (std::size_t begin = 0, end = 0; begin < plan.cells.size(); begin = end) {
    while (end < plan.cells.size() && same_line(begin, end)) ++end;
    results.rates.push_back(fit_line(plan, results, references, begin, end, samplers));
  }
  return results;
}

}  // namespace halfslope
