// A (0, 2)-sequence whose digits are drawn as they are needed (A. Helmer, P. Christensen & A. Kensler, "Stochastic
// generation of (t, s) sample sequences", 2021).
//
// In base 2 the points 2^k … 2^{k+1} − 1 must fall into those halves of the 2^k intervals of length 2^−k that the first
// 2^k points leave empty, in x and in y, and so that the elementary boxes come out right. Which earlier point a new one
// shares its interval with may be any fixed linear rule that makes a (0, 2)-sequence: here i ↦ i xor 2^k xor a constant
// of the octave (the paper's for pmj02, from its supplement). Digit k is then the other one than the earlier point's,
// and all digits below are random. That is an Owen scramble of the linear sequence, drawn point by point.
//
// One word gives all of a point's digits from its octave's on. The first kTabled points are tabled; a later one takes
// its lowest digits from its own word, higher ones from the words of its ancestors, and the rest from the table.
#include "samplers/pmj02.h"

#include <algorithm>
#include <array>
#include <bit>

#include "samplers/keyed_hash.h"
#include "samplers/padded.h"
#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

constexpr std::array<std::array<std::uint32_t, 31>, 2> kParents = {
    {{0x0,      0x0,      0x2,      0x6,      0x6,       0xe,       0x36,      0x4e,      0x16,      0x2e,    0x276,
      0x6ce,    0x716,    0xc2e,    0x3076,   0x40ce,    0x116,     0x22e,     0x20676,   0x60ece,   0x61716, 0xe2c2e,
      0x367076, 0x4ec0ce, 0x170116, 0x2c022e, 0x2700676, 0x6c00ece, 0x7001716, 0xc002c2e, 0x30007076},
     {0x0,      0x1,     0x3,      0x3,       0x7,       0x1b,      0x27,      0xb,        0x17,      0x13b,   0x367,
      0x38b,    0x617,   0x183b,   0x2067,    0x8b,      0x117,     0x1033b,   0x30767,    0x30b8b,   0x71617, 0x1b383b,
      0x276067, 0xb808b, 0x160117, 0x138033b, 0x3600767, 0x3800b8b, 0x6001617, 0x1800383b, 0x20006067}}};

int octave(std::uint32_t index) { return static_cast<int>(std::bit_width(index)) - 1; }

/// One coordinate of the sequence in each lane.
class Coordinate {
 public:
  static constexpr std::uint32_t kTabled = 1024;

  void prepare(const WordSource& words, int dim, int coordinate, std::uint64_t count) {
    coordinate_ = coordinate;
    words.fill(Draw::kScramble, dim, static_cast<std::uint64_t>(2 * coordinate), 2, keys_.data());
    const auto tabled = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, kTabled));
    table_.resize(std::max<std::size_t>(table_.size(), std::size_t{tabled} * kLanes));
    for (std::uint32_t i = 0; i < tabled; ++i) {
      std::uint32_t* row = table_.data() + std::size_t{i} * kLanes;
      for (std::size_t l = 0; l < kLanes; ++l) row[l] = keyed_word(i, keys_[l], keys_[kLanes + l]);
      if (i == 0) continue;
      const std::uint32_t* from = table_.data() + std::size_t{pmj02_parent(coordinate_, i)} * kLanes;
      const std::uint32_t flip = 0x80000000u >> octave(i), random = flip - 1;
      for (int l = 0; l < kLanes; ++l) row[l] = ((from[l] ^ flip) & ~random) | (row[l] & random);
    }
  }

  std::uint32_t at(std::uint32_t index, std::size_t lane) const {
    // From the lowest digits up: what an ancestor gives stands above what its descendants have given, and is seen
    // through the flips of their octaves' digits.
    std::uint32_t digits = 0, given = 0, flips = 0;
    for (; index >= kTabled; index = pmj02_parent(coordinate_, index)) {
      const std::uint32_t flip = 0x80000000u >> octave(index), random = flip - 1;
      digits |= (keyed_word(index, keys_[lane], keys_[kLanes + lane]) ^ flips) & random & ~given;
      given = random;
      flips |= flip;
    }
    return digits | ((table_[std::size_t{index} * kLanes + lane] ^ flips) & ~given);
  }

 private:
  int coordinate_ = 0;
  std::array<std::uint32_t, 2 * kLanes> keys_;
  AlignedBuffer<std::uint32_t> table_;
};

class Pmj02 final : public PairSet {
 public:
  void prepare(const PointRequest& request, int dim) override {
    words_.prepare(request);
    x_.prepare(words_, dim, 0, request.count);
    y_.prepare(words_, dim, 1, request.count);
  }
  void points(const PairRows& rows) override {
    const std::size_t size = static_cast<std::size_t>(rows.rows) * kLanes;
    for (std::size_t i = 0; i < size; ++i) rows.x[i] = x_.at(rows.indices[i], i % kLanes);
    for (std::size_t i = 0; i < size && rows.y; ++i) rows.y[i] = y_.at(rows.indices[i], i % kLanes);
  }

 private:
  WordSource words_;
  Coordinate x_, y_;
};

}  // namespace

std::uint32_t pmj02_parent(int coordinate, std::uint32_t index) {
  const int k = octave(index);
  return index ^ (1u << k) ^ kParents[static_cast<std::size_t>(coordinate)][static_cast<std::size_t>(k)];
}

std::unique_ptr<Sampler> make_pmj02() {
  return padded({.name = "pmj02",
                 .description = "progressive multi-jittered pairs, every aligned run of 2^m a (0,m,2)-net",
                 .reference = "Christensen, Kensler & Kilpatrick (2018); Helmer, Christensen & Kensler (2021)",
                 .sequence = true,
                 .max_dims = kPaddedDims,
                 .rate = stratified_pairs_rate},
                [] { return std::make_unique<Pmj02>(); });
}

}  // namespace halfslope
