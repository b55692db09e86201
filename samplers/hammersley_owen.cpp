// Owen-scrambled Hammersley points (A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995).
//
// The digits of i/2^m are the m bits of i from the top. Nested scrambling flips digit k by a random bit of the node (k,
// the k digits above it), and appends random digits for ever. Follow zeros from any node: the bits there are fresh and
// independent, so together with the endless tail they are the digits of one uniform number. Hence (as in
// halton_owen.kernel.cpp, with base 2, where the only other permutation of a digit is its flip):
//   x_0 is uniform;
//   for i > 0 let k be the place of its lowest 1, counted from the top, and j be i without it. The first k digits of
//   x_i are those of x_j, digit k is the other one than x_j's, and the digits below are uniform and independent.
// So a point costs one random number, which is the word of its own index, and a blend with x_j. As i counts up, j is
// the last index whose lowest 1 stood where j's does: one row of words for each place is all that must be kept.
#include "samplers/hammersley_owen.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "samplers/radical_inverse.h"
#include "samplers/scrambled_inverse.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

/// i/2^m under nested scrambling, the high words; below digit 32 all is random.
class ScrambledCount {
 public:
  void prepare(std::uint64_t count) {
    digits_ = std::countr_zero(count);
    next_ = 0;
  }

  void fill(const WordSource& words, std::uint64_t begin, int samples, std::uint32_t* high) {
    words.fill(Draw::kHigh, 0, begin, samples, high);
    if (begin != next_) climb(words, begin);
    next_ = begin + static_cast<std::uint64_t>(samples);
    for (std::uint64_t i = begin; i < next_; ++i, high += kLanes) place(i, high);
  }

 private:
  /// The place of the lowest 1 of i, from the bottom; of 0, above all.
  static std::size_t lowest(std::uint64_t i) { return i ? static_cast<std::size_t>(std::countr_zero(i)) : kPlaces - 1; }

  /// From the random words of index i to its point.
  void place(std::uint64_t i, std::uint32_t* row) {
    const std::size_t at = lowest(i);
    if (i > 0) {
      const std::uint32_t* from = rows_[lowest(i & (i - 1))].data();
      const std::uint32_t flip = 0x80000000u >> (digits_ - 1 - static_cast<int>(at)), random = flip - 1;
      for (int l = 0; l < kLanes; ++l) row[l] = ((from[l] ^ flip) & ~random) | (row[l] & random);
    }
    for (std::size_t l = 0; l < kLanes; ++l) rows_[at][l] = row[l];
  }

  /// Makes the rows on the way to index i: that of 0, then with i's ones from the top, all but the lowest.
  void climb(const WordSource& words, std::uint64_t i) {
    const std::uint64_t parent = i & (i - 1);
    std::uint64_t at = 0;
    place_alone(words, at);
    for (std::uint64_t bit = std::uint64_t{1} << 31; bit > 0; bit >>= 1) {
      if (!(parent & bit)) continue;
      at |= bit;
      place_alone(words, at);
    }
  }
  void place_alone(const WordSource& words, std::uint64_t i) {
    std::uint32_t row[kLanes];
    words.fill(Draw::kHigh, 0, i, 1, row);
    place(i, row);
  }

  static constexpr std::size_t kPlaces = 33;
  int digits_ = 0;
  std::uint64_t next_ = 0;
  std::array<std::array<std::uint32_t, kLanes>, kPlaces> rows_;
};

class HammersleyOwen final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "hammersley-owen",
        .description = "Hammersley set, nested scrambling that depends on digits and depth; N a power of two",
        .reference = "Hammersley (1960); Owen, Randomly permuted (t,m,s)-nets and (t,s)-sequences (1995)",
        .max_dims = static_cast<int>(primes().size()) + 1,
        .rate = scrambled_plane_rate,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    const std::uint64_t most = std::bit_floor(ScrambledInverse::most_points(std::max(0, layout.dims() - 1)));
    if (count > most) return LegalNeighbours{most, std::nullopt};
    if (count > 0 && !std::has_single_bit(count)) return LegalNeighbours{std::bit_floor(count), std::bit_ceil(count)};
    return Sampler::illegal(count, layout);
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    first_.prepare(request.count);
    const auto dims = static_cast<std::size_t>(request.layout->dims());
    others_.resize(dims > 0 ? dims - 1 : 0);
    for (std::size_t d = 1; d < dims; ++d) {
      others_[d - 1].prepare(words_, static_cast<int>(d), primes()[d - 1], request.count);
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    if (block.dims() > 0) first_.fill(words_, begin, block.samples(), block.high(0));
    if (block.dims() > 0 && block.has_low_words()) words_.fill_low(0, begin, block.samples(), block.low(0));
    for (int d = 1; d < block.dims(); ++d) others_[static_cast<std::size_t>(d - 1)].fill(begin, block, d);
  }

 private:
  WordSource words_;
  ScrambledCount first_;
  std::vector<ScrambledInverse> others_;
};

}  // namespace

std::unique_ptr<Sampler> make_hammersley_owen() { return std::make_unique<HammersleyOwen>(); }

}  // namespace halfslope
