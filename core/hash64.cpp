#include "core/hash64.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace halfslope {
namespace {

static_assert(std::endian::native == std::endian::little, "words are read as they lie in memory");

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87, kPrime2 = 0xC2B2AE3D27D4EB4F, kPrime3 = 0x165667B19E3779F9,
                        kPrime4 = 0x85EBCA77C2B2AE63, kPrime5 = 0x27D4EB2F165667C5;

template <class Word>
Word load(const std::byte* bytes) {
  Word word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t word) { return std::rotl(lane + word * kPrime2, 31) * kPrime1; }

std::uint64_t merged(const std::array<std::uint64_t, 4>& lanes) {
  std::uint64_t hash =
      std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) + std::rotl(lanes[3], 18);
  for (std::uint64_t lane : lanes) hash = (hash ^ round(0, lane)) * kPrime1 + kPrime4;
  return hash;
}

}  // namespace

Hash64::Hash64(std::uint64_t seed)
    : lanes_{seed + kPrime1 + kPrime2, seed + kPrime2, seed, seed - kPrime1}, seed_(seed) {}

void Hash64::stripe(const std::byte* bytes) {
  for (std::size_t i = 0; i < 4; ++i) lanes_[i] = round(lanes_[i], load<std::uint64_t>(bytes + 8 * i));
}

void Hash64::update(std::span<const std::byte> bytes) {
  length_ += bytes.size();
  if (tail_size_ > 0) {
    const std::size_t taken = std::min(bytes.size(), tail_.size() - tail_size_);
    std::copy_n(bytes.begin(), taken, tail_.begin() + static_cast<std::ptrdiff_t>(tail_size_));
    tail_size_ += taken;
    bytes = bytes.subspan(taken);
    if (tail_size_ < tail_.size()) return;
    stripe(tail_.data());
    tail_size_ = 0;
  }
  for (; bytes.size() >= tail_.size(); bytes = bytes.subspan(tail_.size())) stripe(bytes.data());
  std::copy(bytes.begin(), bytes.end(), tail_.begin());
  tail_size_ = bytes.size();
}

std::uint64_t Hash64::digest() const {
  std::uint64_t hash = (length_ >= tail_.size() ? merged(lanes_) : seed_ + kPrime5) + length_;
  const std::byte* next = tail_.data();
  const std::byte* end = next + tail_size_;
  for (; end - next >= 8; next += 8)
    hash = std::rotl(hash ^ round(0, load<std::uint64_t>(next)), 27) * kPrime1 + kPrime4;
  for (; end - next >= 4; next += 4)
    hash = std::rotl(hash ^ load<std::uint32_t>(next) * kPrime1, 23) * kPrime2 + kPrime3;
  for (; next != end; ++next) hash = std::rotl(hash ^ std::to_integer<std::uint64_t>(*next) * kPrime5, 11) * kPrime1;
  hash = (hash ^ (hash >> 33)) * kPrime2;
  hash = (hash ^ (hash >> 29)) * kPrime3;
  return hash ^ (hash >> 32);
}

std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed) {
  Hash64 hash(seed);
  hash.update(bytes);
  return hash.digest();
}

}  // namespace halfslope
