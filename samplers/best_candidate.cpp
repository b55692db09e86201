#include "samplers/best_candidate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "samplers/keyed_hash.h"
#include "samplers/nearest_grid.h"
#include "samplers/padded.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

/// Candidates for each point that is there. Their places in the stream are fixed by the point's index alone.
constexpr std::uint64_t kCandidates = 1;

class BestCandidate final : public PairSet {
 public:
  explicit BestCandidate(std::shared_ptr<NearestGrid> scratch) : grid_(std::move(scratch)) {}

  void prepare(const PointRequest& request, int dim) override {
    words_.prepare(request);
    words_.fill(Draw::kScramble, dim, 0, 4, keys_.data());
    count_ = request.count;
    size_ = 0;
  }

  void points(const PairRows& rows) override {
    const std::size_t size = static_cast<std::size_t>(rows.rows) * kLanes;
    std::uint64_t wanted = 0;
    for (std::size_t i = 0; i < size; ++i) wanted = std::max<std::uint64_t>(wanted, rows.indices[i] + 1);
    if (wanted > size_) grow(std::min(std::bit_ceil(wanted), count_));
    for (std::size_t i = 0; i < size; ++i) {
      const TorusPoint& point = points_[rows.indices[i] * std::size_t{kLanes} + i % kLanes];
      rows.x[i] = point.x;
      if (rows.y) rows.y[i] = point.y;
    }
  }

 private:
  /// To `wanted` points in every lane. The grids hold one lane at a time, so they are made anew.
  void grow(std::uint64_t wanted) {
    points_.resize(std::max(points_.size(), static_cast<std::size_t>(wanted) * kLanes));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      grid_->clear();
      for (std::uint64_t i = 0; i < size_; ++i) grid_->add(points_[i * kLanes + lane]);
      for (std::uint64_t i = size_; i < wanted; ++i) {
        points_[i * kLanes + lane] = next(lane);
        grid_->add(points_[i * kLanes + lane]);
      }
    }
    size_ = wanted;
  }

  TorusPoint next(std::size_t lane) const {
    const auto word = [&](std::size_t k) { return std::uint64_t{keys_[k * kLanes + lane]}; };
    const std::uint64_t key0 = word(0) << 32 | word(1), key1 = word(2) << 32 | word(3);
    const auto candidate = [&](std::uint64_t i) -> TorusPoint {
      const std::uint64_t pair = keyed_pair(i, key0, key1);
      return {static_cast<std::uint32_t>(pair >> 32), static_cast<std::uint32_t>(pair)};
    };
    const std::uint64_t size = grid_->size(), begin = kCandidates * size * (size + 1) / 2;
    if (size == 0) return candidate(0);
    TorusPoint best = {};
    std::uint64_t farthest = 0;
    for (std::uint64_t i = begin; i < begin + kCandidates * size; ++i) {
      const TorusPoint point = candidate(i);
      if (grid_->all_beyond(point, farthest)) best = point;
    }
    return best;
  }

  std::shared_ptr<NearestGrid> grid_;
  WordSource words_;
  std::uint64_t count_ = 0, size_ = 0;
  std::array<std::uint32_t, 4 * kLanes> keys_;
  std::vector<TorusPoint> points_;  // [point][lane]
};

}  // namespace

std::unique_ptr<Sampler> make_best_candidate() {
  return padded(
      {.name = "best-candidate",
       .description = "each point the farthest, on the torus, of as many candidates as points; N to 2^14",
       .reference = "Mitchell, Spectrally optimal sampling for distribution ray tracing (1991)",
       .sequence = true,
       .max_dims = kPaddedDims,
       .max_count = std::uint64_t{1} << 14,
       .caveats = {"made anew for every pixel, at a cost that grows as the square of N: slow on pictures",
                   "no coordinate alone is stratified: a single dimension gains no more than a pair, a constant and "
                   "little rate"}},
      [scratch = std::make_shared<NearestGrid>()] { return std::make_unique<BestCandidate>(scratch); }, kHeldPoints);
}

}  // namespace halfslope
