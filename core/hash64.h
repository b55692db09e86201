// XXH64: a fast 64-bit hash for checksums, at the speed of memory. Not against adversaries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace halfslope {

/// Yann Collet's XXH64 (https://github.com/Cyan4973/xxHash/blob/dev/doc/xxhash_spec.md), in pieces: the digest depends
/// on the seed and the bytes alone, not on how update() was given them. Little-endian machines only.
class Hash64 {
 public:
  explicit Hash64(std::uint64_t seed = 0);
  void update(std::span<const std::byte> bytes);
  std::uint64_t digest() const;

 private:
  void stripe(const std::byte* bytes);

  std::array<std::uint64_t, 4> lanes_;
  std::uint64_t seed_, length_ = 0;
  std::array<std::byte, 32> tail_{};
  std::size_t tail_size_ = 0;
};

std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed = 0);

}  // namespace halfslope
