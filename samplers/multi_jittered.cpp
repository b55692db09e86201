#include "samplers/multi_jittered.h"

#include <algorithm>
#include <array>
#include <vector>

#include "samplers/keyed_hash.h"
#include "samplers/multi_jittered_grid.h"
#include "samplers/padded.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

/// A shuffle of `length` places for each of `lines` lines, in each lane: one of LanePermutation's kind for every line,
/// held up to kShuffled places in all.
class LineShuffles {
 public:
  /// From the words of Draw::kScramble of dimension `dim` at `first` and on.
  void prepare(const WordSource& words, int dim, std::uint64_t first, std::uint64_t lines, std::uint64_t length) {
    length_ = length;
    held_ = lines * length <= LanePermutation::kShuffled;
    if (!held_) return words.fill(Draw::kScramble, dim, first, 8, keys_.data());
    const std::size_t places = lines * length;
    words_.resize(std::max(words_.size(), places * kLanes));
    table_.resize(words_.size());
    words.fill(Draw::kScramble, dim, first, static_cast<int>(places), words_.data());
    std::size_t base = 0, place = 0;  // where a line begins, and the place within it
    for (std::size_t i = 0; i < places; ++i) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        const std::size_t j = base + ((std::uint64_t{words_[i * kLanes + l]} * (place + 1)) >> 32);
        table_[i * kLanes + l] = table_[j * kLanes + l];
        table_[j * kLanes + l] = static_cast<std::uint16_t>(place);
      }
      if (++place == length) base += length, place = 0;
    }
  }
  std::uint32_t at(std::uint32_t line, std::uint32_t place, int lane) const {
    const auto l = static_cast<std::size_t>(lane);
    if (held_) return table_[(line * length_ + place) * kLanes + l];
    std::array<std::uint32_t, 4> keys;
    for (std::size_t k = 0; k < 4; ++k)
      keys[k] = keyed_word(line, keys_[2 * k * kLanes + l], keys_[(2 * k + 1) * kLanes + l]);
    return static_cast<std::uint32_t>(keyed_permutation(place, length_, keys));
  }

 private:
  std::uint64_t length_ = 1;
  bool held_ = false;
  std::vector<std::uint32_t> words_;
  std::vector<std::uint16_t> table_;  // [line][place][lane]
  std::array<std::uint32_t, 8 * kLanes> keys_;
};

class MultiJittered final : public PairSet {
 public:
  void prepare(const PointRequest& request, int dim) override {
    grid_.prepare(request, dim);
    const auto [columns, rows] = grid_.grid();
    of_columns_.prepare(grid_.words(), dim, 0, columns, rows);
    of_rows_.prepare(grid_.words(), dim, LanePermutation::kShuffled, rows, columns);
  }
  void points(const PairRows& rows) override {
    grid_.fill(
        rows, [this](std::uint32_t column, std::uint32_t row, int lane) { return of_columns_.at(column, row, lane); },
        [this](std::uint32_t column, std::uint32_t row, int lane) { return of_rows_.at(row, column, lane); });
  }

 private:
  MultiJitteredGrid grid_;
  LineShuffles of_columns_, of_rows_;
};

}  // namespace

std::unique_ptr<Sampler> make_multi_jittered() {
  return padded({.name = "multi-jittered",
                 .description = "pairs with one point in each cell of a grid, N strata of x and N of y; any N = a*b",
                 .reference = "Chiu, Shirley & Wang, Multi-jittered sampling (1994)",
                 .max_dims = kPaddedDims,
                 .rate = stratified_pairs_rate},
                [] { return std::make_unique<MultiJittered>(); });
}

}  // namespace halfslope
