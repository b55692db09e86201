#include "samplers/scrambled_inverse.h"

#include <algorithm>
#include <numeric>

#include "samplers/radical_inverse.h"

namespace halfslope {
namespace {

constexpr std::uint32_t kTableSize = 256;
constexpr std::uint64_t kMost = std::uint64_t{1} << 31;

}  // namespace

void ScrambledInverse::prepare(const WordSource& words, int dim, std::uint32_t base, std::uint64_t count) {
  if (!kernels_) kernels_ = &kernels<SamplerKernels>();
  words.fill(Draw::kScramble, dim, 0, 4, keys_.data());
  base_ = base;
  table_digits_ = 0;
  std::uint32_t size = 1;
  while (size < count && size * base <= kTableSize) size *= base, ++table_digits_;
  table_.resize(std::size_t{size} * kLanes);
  const auto tabled = static_cast<std::uint32_t>(std::min<std::uint64_t>(size, count));
  kernels_->halton_owen_table(base, keys_.data(), tabled, table_.data());
}

void ScrambledInverse::fill(std::uint64_t begin, PointBlock& block, int dim) {
  indices_.resize(static_cast<std::size_t>(block.samples()));
  std::iota(indices_.begin(), indices_.end(), static_cast<std::uint32_t>(begin));
  fill(indices_, block, dim);
}

void ScrambledInverse::fill(std::span<const std::uint32_t> indices, PointBlock& block, int dim) const {
  kernels_->halton_owen({base_, table_digits_, table_.data(), keys_.data()}, indices.data(), block.samples(),
                        block.high(dim), block.low(dim));
}

std::uint64_t ScrambledInverse::most_points_in(std::uint32_t base) {
  std::uint64_t power = base;
  while (power * base <= kMost) power *= base;
  return power;
}

std::uint64_t ScrambledInverse::most_points(int bases) {
  std::uint64_t most = kMost;
  for (const std::uint32_t base : primes().first(std::min(static_cast<std::size_t>(bases), primes().size()))) {
    most = std::min(most, most_points_in(base));
  }
  return most;
}

}  // namespace halfslope
