// Progressive multi-jittered points (P. Christensen, A. Kensler & C. Kilpatrick, "Progressive multi-jittered sample
// sequences", 2018), an octave at a time.
//
// From N = 4^k to 2N points each square of side 2^−k, which holds one point, gets its second one in the diagonally
// opposite quadrant; from 2 · 4^k to 4^{k+1} points the two empty quadrants of each square are filled, in a random
// order. Which of the N strata of x of width 1/N a new point falls into is random among those that cross its quadrant:
// a half of each is taken by one of the N earlier points. In a column of quadrants there are as many earlier as new
// points, so one shuffle of the earlier points of each column says whose stratum a new point shares, in the other half.
// Likewise y. That is the paper's choice of a random free stratum, without its search.
#include "samplers/pmj.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "samplers/keyed_hash.h"
#include "samplers/padded.h"
#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

class Pmj final : public PairSet {
 public:
  void prepare(const PointRequest& request, int dim) override {
    words_.prepare(request);
    words_.fill(Draw::kScramble, dim, 0, static_cast<int>(2 * kKinds), keys_.data());
    size_ = 0;
  }

  void points(const PairRows& rows) override {
    const std::size_t size = static_cast<std::size_t>(rows.rows) * kLanes;
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < size; ++i) last = std::max(last, rows.indices[i]);
    while (size_ <= last) extend();
    for (std::size_t i = 0; i < size; ++i) rows.x[i] = x_[rows.indices[i] * std::size_t{kLanes} + i % kLanes];
    for (std::size_t i = 0; i < size && rows.y; ++i) rows.y[i] = y_[rows.indices[i] * std::size_t{kLanes} + i % kLanes];
  }

 private:
  enum Kind : std::size_t { kX, kY, kShuffleX, kShuffleY, kQuadrant, kKinds };
  std::uint32_t word(Kind kind, std::size_t index, std::size_t lane) const {
    return keyed_word(static_cast<std::uint32_t>(index), keys_[2 * kind * kLanes + lane],
                      keys_[(2 * kind + 1) * kLanes + lane]);
  }

  /// From N points to 2N, or from none to one.
  void extend() {
    const std::size_t grown = size_ ? 2 * size_ : 1;
    x_.resize(std::max(x_.size(), grown * kLanes));
    y_.resize(x_.size());
    columns_.resize(grown), rows_.resize(grown), order_.resize(grown), met_.resize(grown);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (size_ == 0) {
        x_[lane] = word(kX, 0, lane);
        y_[lane] = word(kY, 0, lane);
        continue;
      }
      choose_quadrants(lane);
      place(x_, columns_, kShuffleX, kX, lane);
      place(y_, rows_, kShuffleY, kY, lane);
    }
    size_ = grown;
  }

  /// The column and row of quadrants, of side 2^−(k+1), of every point.
  void choose_quadrants(std::size_t lane) {
    const int digits = std::countr_zero(size_), shift = 31 - digits / 2;
    for (std::size_t i = 0; i < size_; ++i) {
      columns_[i] = x_[i * kLanes + lane] >> shift;
      rows_[i] = y_[i * kLanes + lane] >> shift;
    }
    if (digits % 2 == 0) {
      for (std::size_t i = 0; i < size_; ++i) {
        columns_[size_ + i] = columns_[i] ^ 1;
        rows_[size_ + i] = rows_[i] ^ 1;
      }
      return;
    }
    for (std::size_t i = 0; i < size_ / 2; ++i) {
      const std::uint32_t coin = word(kQuadrant, size_ + i, lane) >> 31;
      const std::size_t third = size_ + i, fourth = third + size_ / 2;
      columns_[third] = columns_[i] ^ coin;
      rows_[third] = rows_[i] ^ coin ^ 1;
      columns_[fourth] = columns_[third] ^ 1;
      rows_[fourth] = rows_[third] ^ 1;
    }
  }

  /// Gives the new points their coordinate, within the `quadrants` that they have along it.
  void place(std::vector<std::uint32_t>& coordinate, const std::vector<std::uint32_t>& quadrants, Kind shuffle,
             Kind jitter, std::size_t lane) {
    const int digits = std::countr_zero(size_);
    // The second point of all shares the one stratum there is; later the strata are no wider than a quadrant.
    const int merge = digits == 0 ? 1 : 0;
    const std::size_t groups = std::size_t{1} << (digits / 2 + 1 - merge), each = size_ / groups;
    std::fill_n(met_.begin(), groups, 0u);
    for (std::size_t i = 0; i < size_; ++i) {
      const std::size_t group = quadrants[i] >> merge, met = met_[group]++;
      std::uint32_t* members = order_.data() + group * each;
      const std::size_t j = (std::uint64_t{word(shuffle, size_ + i, lane)} * (met + 1)) >> 32;
      members[met] = members[j];
      members[j] = static_cast<std::uint32_t>(i);
    }
    std::fill_n(met_.begin(), groups, 0u);
    const std::uint32_t flip = 0x80000000u >> digits, random = flip - 1;
    for (std::size_t i = size_; i < 2 * size_; ++i) {
      const std::size_t group = quadrants[i] >> merge;
      const std::uint32_t shared = order_[group * each + met_[group]++];
      const std::uint32_t from = coordinate[shared * std::size_t{kLanes} + lane];
      coordinate[i * kLanes + lane] = ((from ^ flip) & ~random) | (word(jitter, i, lane) & random);
    }
  }

  WordSource words_;
  std::array<std::uint32_t, 2 * kKinds * kLanes> keys_;
  std::size_t size_ = 0;                                     ///< points made, 0 or a power of two
  std::vector<std::uint32_t> x_, y_;                         // [point][lane]
  std::vector<std::uint32_t> columns_, rows_, order_, met_;  // of one lane at a time
};

}  // namespace

std::unique_ptr<Sampler> make_pmj() {
  return padded(
      {.name = "pmj",
       .description = "progressive multi-jittered pairs: the first 4^k points are multi-jittered",
       .reference = "Christensen, Kensler & Kilpatrick, Progressive multi-jittered sample sequences (2018)",
       .sequence = true,
       .max_dims = kPaddedDims,
       .max_count = kHeldPoints,
       .rate = stratified_pairs_rate},
      [] { return std::make_unique<Pmj>(); }, kHeldPoints);
}

}  // namespace halfslope
