#include "samplers/exact_counter.h"

#include "core/assertion.h"

namespace halfslope {
namespace {

__extension__ using Wide = unsigned __int128;
constexpr std::uint64_t kMost = std::uint64_t{1} << 31;

}  // namespace

ExactFraction ExactFraction::of(std::uint64_t numerator, std::uint64_t denominator) {
  const Wide scaled = Wide{numerator} << 53;
  return {static_cast<std::uint64_t>(scaled / denominator), static_cast<std::uint64_t>(scaled % denominator)};
}

RadicalCounter::RadicalCounter(std::uint32_t base) : base_(base) {
  assert_equal(2 <= base && base < (1u << 16), true, "RadicalCounter: a base from 2 to 65535");
  std::size_t digits = 0;
  for (; denominator_ <= kMost; ++digits) denominator_ *= base;
  digits_.resize(digits);
  std::uint64_t unit = denominator_;
  for (std::size_t c = 0; c < digits; ++c) {
    unit /= base;
    steps_.push_back(ExactFraction::of((base + 1) * unit % denominator_, denominator_));
  }
}

void RadicalCounter::seek(std::uint64_t index) {
  if (index == index_) return;
  index_ = index;
  std::uint64_t numerator = 0, unit = denominator_;
  for (std::uint16_t& digit : digits_) {
    unit /= base_;
    digit = static_cast<std::uint16_t>(index % base_);
    index /= base_;
    numerator += digit * unit;
  }
  at_ = ExactFraction::of(numerator, denominator_);
}

void EvenCounter::reset(std::uint64_t count) {
  if (count != count_) {
    count_ = count;
    step_ = ExactFraction::of(1, count);
  }
  index_ = 0;
  at_ = {};
}

void EvenCounter::seek(std::uint64_t index) {
  if (index == index_) return;
  index_ = index;
  at_ = ExactFraction::of(index, count_);
}

}  // namespace halfslope
