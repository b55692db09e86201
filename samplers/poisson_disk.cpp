#include "samplers/poisson_disk.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "samplers/keyed_hash.h"
#include "samplers/padded.h"
#include "samplers/sample_elimination.h"
#include "samplers/torus.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

constexpr std::uint32_t kCandidates = 5;  // for each point, as the paper advises

/// What making a set takes, shared by the groups of a sampler.
struct Scratch {
  SampleElimination elimination;
  std::vector<TorusPoint> candidates;
};

class PoissonDisk final : public PairSet {
 public:
  explicit PoissonDisk(std::shared_ptr<Scratch> scratch) : scratch_(std::move(scratch)) {}

  void prepare(const PointRequest& request, int dim) override {
    words_.prepare(request);
    std::uint32_t keys[4 * kLanes];
    words_.fill(Draw::kScramble, dim, 0, 4, keys);
    const auto count = static_cast<std::uint32_t>(request.count);
    points_.resize(std::max(points_.size(), std::size_t{count} * kLanes));
    std::vector<TorusPoint>& candidates = scratch_->candidates;
    candidates.resize(std::size_t{kCandidates} * count);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t* key = keys + lane;
      for (std::uint32_t i = 0; i < candidates.size(); ++i) {
        candidates[i] = {keyed_word(i, key[0], key[kLanes]), keyed_word(i, key[2 * kLanes], key[3 * kLanes])};
      }
      // The candidates that stay keep their order, so no place in the set is preferred.
      std::size_t at = lane;
      for (const std::uint32_t i : scratch_->elimination.keep(candidates, count)) {
        points_[at] = candidates[i];
        at += kLanes;
      }
    }
  }

  void points(const PairRows& rows) override {
    const std::size_t size = static_cast<std::size_t>(rows.rows) * kLanes;
    for (std::size_t i = 0; i < size; ++i) {
      const TorusPoint& point = points_[rows.indices[i] * std::size_t{kLanes} + i % kLanes];
      rows.x[i] = point.x;
      if (rows.y) rows.y[i] = point.y;
    }
  }

 private:
  std::shared_ptr<Scratch> scratch_;
  WordSource words_;
  std::vector<TorusPoint> points_;  // [point][lane]
};

}  // namespace

std::unique_ptr<Sampler> make_poisson_disk() {
  return padded(
      {.name = "poisson-disk",
       .description = "pairs that keep their distance on the torus, N left of 5N uniform ones; any N to 2^16",
       .reference = "Yuksel, Sample elimination for generating Poisson disk sample sets (2015)",
       .max_dims = kPaddedDims,
       .max_count = std::uint64_t{1} << 16,
       .caveats = {"made anew for every pixel at some microseconds a point: slow on pictures",
                   "no coordinate alone is stratified: a single dimension gains no more than a pair, a constant and "
                   "little rate"}},
      [scratch = std::make_shared<Scratch>()] { return std::make_unique<PoissonDisk>(scratch); }, kHeldPoints);
}

}  // namespace halfslope
