#include "core/hash64.h"

#include <gtest/gtest.h>

#include <string_view>

namespace halfslope {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

// Digests that the xxHash project and its bindings publish.
TEST(Hash64, AgreesWithPublishedDigests) {
  EXPECT_EQ(hash64(bytes_of("")), 0xEF46DB3751D8E999u);
  EXPECT_EQ(hash64(bytes_of("a")), 0xD24EC4F1A98C6E5Bu);
  EXPECT_EQ(hash64(bytes_of("abc")), 0x44BC2CF5AD770999u);
  EXPECT_EQ(hash64(bytes_of("Nobody inspects the spammish repetition")), 0xFBCEA83C8A378BF1u);
}

TEST(Hash64, PiecesDoNotMatter) {
  const std::string_view text =
      "a text that is long enough to fill more than two stripes of thirty-two bytes, and a tail";
  const std::uint64_t whole = hash64(bytes_of(text), 5);
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    Hash64 hash(5);
    for (std::size_t begin = 0; begin < text.size(); begin += piece) hash.update(bytes_of(text.substr(begin, piece)));
    EXPECT_EQ(hash.digest(), whole) << "in pieces of " << piece;
  }
}

TEST(Hash64, SeedsAndEveryByteMatter) {
  std::string text(70, 'x');
  const std::uint64_t whole = hash64(bytes_of(text));
  EXPECT_NE(hash64(bytes_of(text), 1), whole);
  for (char& c : text) {
    c ^= 0x40;
    EXPECT_NE(hash64(bytes_of(text)), whole) << "byte " << &c - text.data();
    c ^= 0x40;
  }
}

}  // namespace
}  // namespace halfslope
