// Random numbers of one simulated run.
#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace halfslope {

/// A stream for each (seed, run, purpose), so that what a run draws depends on no other run, nor on threads. Philox
/// 4x32-7 (core/random.h; the fewest rounds that its authors found to pass BigCrush), the seed its key.
class RunRandom {
 public:
  RunRandom(std::uint64_t seed, std::uint64_t run, std::uint32_t purpose)
      : key_{{low(seed), high(seed)}}, counter_{{0, low(run), high(run), purpose}} {}

  std::uint32_t word() {
    if (next_ == 4) {
      words_ = Philox()(counter_, key_);
      ++counter_[0];
      next_ = 0;
    }
    return words_[next_++];
  }

  /// Uniform in (0, 1), 52 bits: the middles of as many cells, so neither end is ever met.
  double uniform() {
    const std::uint64_t high_bits = word();
    return (static_cast<double>((high_bits << 20) | (word() >> 12)) + 0.5) * 0x1p-52;
  }

  /// Standard normal, by Box and Muller.
  double normal() {
    if (normal_held_) {
      normal_held_ = false;
      return spare_normal_;
    }
    const double radius = std::sqrt(-2 * std::log(uniform())), angle = 2 * std::numbers::pi * uniform();
    spare_normal_ = radius * std::sin(angle);
    normal_held_ = true;
    return radius * std::cos(angle);
  }

 private:
  static std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
  static std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

  using Philox = r123::Philox4x32_R<7>;
  Philox::key_type key_;
  Philox::ctr_type counter_, words_{};
  std::uint32_t next_ = 4;
  double spare_normal_ = 0;
  bool normal_held_ = false;
};

}  // namespace halfslope
