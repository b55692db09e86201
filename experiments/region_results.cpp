#include "experiments/region_results.h"

#include "analysis/interval_methods.h"
#include "analysis/reference_noise.h"
#include "core/random.h"

namespace halfslope {
namespace {

// The mean over replicates of squared errors over a part of the image.
CorrectedMean mean_of(const std::vector<double>& replicates, IntervalMethod method, std::uint64_t seed,
                      const ReferencePart& reference) {
  Moments moments;
  moments.add(std::span<const double>(replicates));
  return corrected_mean(moments.mean, log_mean_interval(method, replicates, seed), reference);
}

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
  const CorrectedMean plain = rooted(mean_of(mse, folded.data.interval, hash_text(name, folded.data.bootstrap_seed),
                                             {share.plain / integrals, 2 * share.plain_squares / square}));
  const CorrectedMean relative = mean_of(relmse, folded.data.interval, hash_text(name, folded.data.bootstrap_seed + 1),
                                         {share.relative / integrals, 2 * share.relative_squares / square});
  result.rmse = plain.value, result.rmse_lo = plain.lo, result.rmse_hi = plain.hi;
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
