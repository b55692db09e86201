// Random numbers of one simulated run.
#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace halfslope {

/// A stream for each (seed, run, purpose), so that what a run draws depends on no other run, nor on threads. Philox
/// 4x32-10 (core/random.h), the seed its key.
class RunRandom {
 public:
  RunRandom(std::uint64_t seed, std::uint64_t run, std::uint32_t purpose)
      : key_{{low(seed), high(seed)}}, counter_{{0, low(run), high(run), purpose}} {}

  /// Uniform in (0, 1), 52 bits: the middles of as many cells, so neither end is ever met.
  double uniform() {
    if (held_) {
      held_ = false;
      return spare_;
    }
    const auto words = r123::Philox4x32()(counter_, key_);
    ++counter_[0];
    spare_ = middle(words[2], words[3]);
    held_ = true;
    return middle(words[0], words[1]);
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

  /// Uniform in [0, count), count ≤ 2³²: two to a call of uniform() would be cheaper, but this is plain.
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(uniform() * count); }

 private:
  static std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
  static std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }
  static double middle(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t bits = (static_cast<std::uint64_t>(a) << 20) | (b >> 12);
    return (static_cast<double>(bits) + 0.5) * 0x1p-52;
  }

  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_;
  double spare_ = 0, spare_normal_ = 0;
  bool held_ = false, normal_held_ = false;
};

}  // namespace halfslope
