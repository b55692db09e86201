#include "experiments/plan_units.h"

#include <algorithm>
#include <numeric>

namespace halfslope {
namespace {

// Samples of a unit, about: half a second of work, so that little is lost to an interruption.
constexpr std::uint64_t kUnitSamples = std::uint64_t{1} << 24;
constexpr int kTile = 256;
constexpr std::int64_t kMostBatch = 4096;

// Tiles and batches that hold about kUnitSamples, a function of the spec alone.
void size_units(Pass& pass, std::size_t pixels) {
  const std::uint64_t each = std::max<std::uint64_t>(1, pass.evaluations());
  pass.tile_pixels = static_cast<int>(std::clamp<std::uint64_t>(kUnitSamples / (each * 64), 1, kTile));
  const std::uint64_t used = std::min<std::uint64_t>(static_cast<std::uint64_t>(pass.tile_pixels), pixels) * each;
  const auto batch = static_cast<std::int64_t>(kUnitSamples / used / 64 * 64);
  pass.batch_replicates = std::min(pass.replicates, std::clamp<std::int64_t>(batch, 64, kMostBatch));
}

std::vector<std::int64_t> batch_ends(const Pass& pass) {
  std::vector<std::int64_t> ends;
  std::int64_t end = 0;
  for (const std::int64_t stage : pass.stages) {
    while (end < stage) ends.push_back(end = std::min(end + pass.batch_replicates, stage));
  }
  return ends;
}

}  // namespace

std::size_t Pass::batches_within(std::int64_t count) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(batch_ends, count) - batch_ends.begin());
}

std::uint64_t Pass::evaluations() const {
  return sequence ? samples.back() : std::accumulate(samples.begin(), samples.end(), std::uint64_t{0});
}

double Plan::evaluations(const Pass& pass, std::int64_t replicates) const {
  return static_cast<double>(pass.evaluations()) * static_cast<double>(scenes[pass.scene].pixels.size()) *
         static_cast<double>(replicates);
}

double Plan::evaluations() const {
  double sum = 0;
  for (const Pass& pass : passes) sum += evaluations(pass, pass.replicates);
  return sum;
}

void add_units(Plan& plan, std::size_t index) {
  Pass& pass = plan.passes[index];
  const std::size_t pixels = plan.scenes[pass.scene].pixels.size();
  size_units(pass, pixels);
  pass.first_unit = plan.units.size();
  pass.batch_ends = batch_ends(pass);
  const auto tile = static_cast<std::size_t>(pass.tile_pixels);
  pass.tiles = (pixels + tile - 1) / tile;
  std::int64_t first = 0;
  for (const std::int64_t end : pass.batch_ends) {
    for (std::size_t p = 0; p < pixels; p += tile)
      plan.units.push_back({index, p, std::min(tile, pixels - p), first, end - first});
    first = end;
  }
}

}  // namespace halfslope
