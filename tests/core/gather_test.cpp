// Entries of their own for each lane, in packets of every width.
#include "core/gather.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace halfslope {
namespace {

template <class T>
struct Entry {
  std::uint8_t kind;
  T first, many[6], last[3];
};

constexpr std::array<std::int32_t, kLanes> kIndex = {3, 0, 2, 2, 5, 1, 4, 0, 3, 3, 5, 2, 1, 0, 4, 5};

template <class T>
std::array<Entry<T>, 6> entries() {
  std::array<Entry<T>, 6> all;
  for (std::size_t e = 0; e < all.size(); ++e) {
    const auto base = static_cast<T>(100 * e);
    all[e] = {7, base, {}, {}};
    for (std::size_t k = 0; k < 6; ++k) all[e].many[k] = base + static_cast<T>(1 + k);
    for (std::size_t k = 0; k < 3; ++k) all[e].last[k] = base + static_cast<T>(7 + k);
  }
  return all;
}

template <class T, int kWidth>
void expect_quads() {
  const auto all = entries<T>();
  alignas(64) std::array<T, 4 * kLanes> out = {};
  gather_quads<T, kWidth>(&all[0].many[1], sizeof(Entry<T>), kIndex.data(), out.data());
  for (int l = 0; l < kWidth; ++l) {
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(out[static_cast<std::size_t>(k * kLanes + l)],
                static_cast<T>(100 * kIndex[static_cast<std::size_t>(l)] + 2 + k))
          << kWidth << " lanes, lane " << l << ", number " << k;
    }
  }
}

TEST(Gather, QuadsOfEveryWidth) {
  expect_quads<float, 1>(), expect_quads<float, 2>(), expect_quads<float, 4>(), expect_quads<float, 8>();
  expect_quads<float, 16>(), expect_quads<double, 1>(), expect_quads<double, 2>(), expect_quads<double, 4>();
  expect_quads<double, 8>(), expect_quads<std::int32_t, 4>(), expect_quads<std::int32_t, 8>();
  expect_quads<std::int32_t, 16>();
}

template <class F>
class GatherOf : public testing::Test {};
using Numbers = testing::Types<float, double, xsimd::batch<float>, xsimd::batch<double>>;
TYPED_TEST_SUITE(GatherOf, Numbers);

TYPED_TEST(GatherOf, FieldsOfEntriesOrOfOneForAll) {
  using F = TypeParam;
  using T = scalar_t<F>;
  const auto all = entries<T>();
  constexpr std::array<std::int32_t, kLanes> same = {4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4};
  for (const auto& index : {kIndex, same}) {
    const LaneEntries<F, Entry<T>> lanes(all.data(), index.data());
    F many[6], two[2], one[1], last[3];
    lanes(&Entry<T>::many, many), lanes(&Entry<T>::many, two), lanes(&Entry<T>::many, one);
    lanes(&Entry<T>::last, last);  // whose quad begins before it
    const auto expect = [&](const F& found, int offset) {
      alignas(64) std::array<T, kLanes> at = {};
      store(at.data(), found);
      for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) {
        EXPECT_EQ(at[l], static_cast<T>(100 * index[l] + offset));
      }
    };
    expect(lanes(&Entry<T>::first), 0);
    for (int k = 0; k < 6; ++k) expect(many[k], 1 + k);
    for (int k = 0; k < 2; ++k) expect(two[k], 1 + k);
    for (int k = 0; k < 3; ++k) expect(last[k], 7 + k);
    expect(one[0], 1);
    EXPECT_EQ(lanes.same(), kWidth<F> == 1 || index == same);
  }
}

}  // namespace
}  // namespace halfslope
