#include "experiments/region_results.h"

#include <cmath>

#include "analysis/interval_methods.h"
#include "analysis/reference_noise.h"
#include "core/random.h"

namespace halfslope {
namespace {

// Means of squared errors over a part of the image, with the interval of log M.
struct Squared {
  std::optional<double> value, lo, hi;
};

Squared squared(const std::vector<double>& replicates, IntervalMethod method, std::uint64_t seed,
                double reference_share, double reference_noise) {
  Moments moments;
  moments.add(std::span<const double>(replicates));
  Squared result;
  if (!std::isfinite(moments.mean) || moments.mean - reference_share <= 0) return result;
  result.value = moments.mean - reference_share;
  if (const auto interval = log_mean_interval(method, replicates, seed)) {
    const Interval wide = widened_for_reference(*interval, moments.mean, reference_noise);
    const double lo = std::exp(wide.lo) - reference_share, hi = std::exp(wide.hi) - reference_share;
    if (lo > 0) result.lo = lo;
    if (hi > 0 && std::isfinite(hi)) result.hi = hi;
  }
  return result;
}

std::optional<double> root(const std::optional<double>& x) { return x ? std::optional(std::sqrt(*x)) : std::nullopt; }

// Leaves joined into a part of the image: pixel-weighted means for each replicate.
RegionResult join(const std::string& name, const FoldedCell& folded, const std::vector<std::uint32_t>& leaves,
                  const ReferenceShares& shares, int channels) {
  RegionResult result;
  result.region = name;
  std::vector<double> mse, relmse;
  ReferenceShare share;
  for (const std::uint32_t leaf : leaves) {
    const RegionErrors& errors = folded.regions.at(leaf);
    result.pixels += errors.pixels;
    mse.resize(errors.mse.size());
    relmse.resize(errors.mse.size());
    for (std::size_t r = 0; r < errors.mse.size(); ++r) {
      mse[r] += errors.mse[r] * static_cast<double>(errors.pixels);
      relmse[r] += errors.relmse[r] * static_cast<double>(errors.pixels);
    }
    const ReferenceShare& part = shares.at(leaf);
    share.plain += part.plain, share.relative += part.relative;
    share.plain_squares += part.plain_squares, share.relative_squares += part.relative_squares;
  }
  const auto pixels = static_cast<double>(result.pixels);
  for (double& x : mse) x /= pixels;
  for (double& x : relmse) x /= pixels;
  const double integrals = pixels * static_cast<double>(channels), square = integrals * integrals;
  const Squared plain = squared(mse, folded.data.interval, hash_text(name, folded.data.bootstrap_seed),
                                share.plain / integrals, 2 * share.plain_squares / square);
  const Squared relative = squared(relmse, folded.data.interval, hash_text(name, folded.data.bootstrap_seed + 1),
                                   share.relative / integrals, 2 * share.relative_squares / square);
  result.rmse = root(plain.value), result.rmse_lo = root(plain.lo), result.rmse_hi = root(plain.hi);
  result.relmse = relative.value, result.relmse_lo = relative.lo, result.relmse_hi = relative.hi;
  return result;
}

}  // namespace

ReferenceShares reference_shares(const PlannedScene& scene, const Reference& reference) {
  ReferenceShares shares;
  const auto channels = static_cast<std::size_t>(scene.source->channels());
  for (std::size_t p = 0; p < scene.pixels.size(); ++p) {
    ReferenceShare& share = shares[static_cast<std::uint32_t>(scene.source->region(scene.pixels[p]))];
    double plain = 0, relative = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const double value = reference.value[p * channels + c], variance = reference.variance[p * channels + c];
      plain += variance;
      relative += variance / (value * value + 0.01);
    }
    share.plain += plain, share.plain_squares += plain * plain;
    share.relative += relative, share.relative_squares += relative * relative;
  }
  return shares;
}

std::vector<RegionResult> region_results(const PlannedScene& scene, const FoldedCell& folded,
                                         const CellStatistics& whole, const ReferenceShares& shares) {
  std::vector<RegionResult> results;
  if (folded.regions.empty() || folded.regions.begin()->second.mse.empty()) return results;
  const auto names = scene.source->regions();
  const int channels = scene.source->channels();
  std::vector<std::pair<std::string, std::vector<std::uint32_t>>> shapes;  // in the scene's order
  for (const auto& [leaf, errors] : folded.regions) {
    const std::string shape = names[leaf].substr(0, names[leaf].find('/'));
    if (shapes.empty() || shapes.back().first != shape) shapes.emplace_back(shape, std::vector<std::uint32_t>());
    shapes.back().second.push_back(leaf);
  }
  results.push_back({"all", static_cast<std::int64_t>(scene.pixels.size()), whole.rmse, whole.rmse_lo, whole.rmse_hi,
                     whole.relmse, whole.relmse_lo, whole.relmse_hi});
  for (const auto& [shape, leaves] : shapes) {
    results.push_back(join(shape, folded, leaves, shares, channels));
    if (leaves.size() == 1 && names[leaves[0]] == shape) continue;
    for (const std::uint32_t leaf : leaves) results.push_back(join(names[leaf], folded, {leaf}, shares, channels));
  }
  return results;
}

}  // namespace halfslope
