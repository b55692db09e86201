#include "core/point_block.h"

#include <gtest/gtest.h>

#include <utility>

namespace halfslope {
namespace {

TEST(AlignedBuffer, IsAlignedZeroAndKeepsItsMemoryWhenItShrinks) {
  for (std::size_t size : {1u, 3u, 16u, 1000u}) {
    AlignedBuffer<double> buffer(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % 64, 0u);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(buffer[i], 0);
  }
  AlignedBuffer<float> buffer(100);
  const float* data = buffer.data();
  buffer.resize(10);
  EXPECT_EQ(buffer.size(), 10u);
  buffer.resize(100);
  EXPECT_EQ(buffer.data(), data);
  AlignedBuffer<float> moved = std::move(buffer);
  EXPECT_EQ(moved.data(), data);
}

TEST(PointBlock, RowsDoNotOverlapAndEachIsAlignedForPackets) {
  PointBlock block;
  for (const bool low_words : {true, false}) {
    for (const int samples : {1, 3, 64}) {
      block.reset(5, samples, low_words);
      EXPECT_EQ(block.stride(), static_cast<std::size_t>(samples) * kLanes);
      for (int dim = 0; dim < 5; ++dim) {
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block.high(dim)) % 64, 0u);
        EXPECT_EQ(block.high(dim), block.high(0) + static_cast<std::size_t>(dim) * block.stride());
        EXPECT_EQ(block.low(dim) != nullptr, low_words);
        if (low_words) {
          EXPECT_EQ(block.low(dim), block.low(0) + static_cast<std::size_t>(dim) * block.stride());
        }
      }
    }
  }
}

TEST(PointBlock, ACoordinateIsItsHighAndLowWord) {
  PointBlock block;
  block.reset(2, 3, true);
  const std::size_t at = 2 * kLanes + 5;  // sample 2, lane 5
  block.high(1)[at] = 0xffffffffu;
  block.low(1)[at] = 0x1fffffu;
  EXPECT_EQ(block.coordinate(1, 2, 5), 1 - 0x1p-53);
  block.high(1)[at] = 1;
  block.low(1)[at] = 1;
  EXPECT_EQ(block.coordinate(1, 2, 5), 0x1p-32 + 0x1p-53);
  EXPECT_EQ(block.coordinate(1, 2, 4), 0);
  block.reset(2, 3, false);
  block.high(1)[at] = 0x80000000u;
  EXPECT_EQ(block.coordinate(1, 2, 5), 0.5);
}

}  // namespace
}  // namespace halfslope
