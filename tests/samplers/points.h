// All the points of a request at once, for tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "samplers/catalogue.h"

namespace halfslope {

/// The 53-bit fractions X of coordinates x = X · 2⁻⁵³, by (dimension, point, lane).
class Points {
 public:
  Points(int dims, std::uint64_t count) : count_(count), x_(static_cast<std::size_t>(dims) * count * kLanes) {}
  std::uint64_t& at(int dim, std::uint64_t point, int lane) { return x_[index(dim, point, lane)]; }
  std::uint64_t at(int dim, std::uint64_t point, int lane) const { return x_[index(dim, point, lane)]; }
  double operator()(int dim, std::uint64_t point, int lane) const {
    return static_cast<double>(at(dim, point, lane)) * 0x1p-53;
  }
  /// ⌊x · intervals⌋ for intervals < 2³², exactly.
  std::uint64_t interval(int dim, std::uint64_t point, int lane, std::uint64_t intervals) const {
    const std::uint64_t x = at(dim, point, lane), high = x >> 32, low = x & 0xffffffffu;
    return (high * intervals + ((low * intervals) >> 32)) >> 21;
  }
  std::uint64_t count() const { return count_; }
  bool operator==(const Points&) const = default;

 private:
  std::size_t index(int dim, std::uint64_t point, int lane) const {
    return (static_cast<std::size_t>(dim) * count_ + point) * kLanes + static_cast<std::size_t>(lane);
  }
  std::uint64_t count_;
  std::vector<std::uint64_t> x_;
};

inline const StreamKey kTestKey = stream_key(20240229, "test", "points");

/// The first `take` points (0: all) of `count` prepared ones, filled in blocks of `block` samples.
inline Points points_of(Sampler& sampler, std::uint64_t count, const Layout& layout, std::uint32_t replicate = 0,
                        std::uint32_t pixel = 7, StreamKey key = kTestKey, std::uint64_t take = 0, int block = 256) {
  sampler.prepare(
      {.count = count, .layout = &layout, .key = key, .pixel = pixel, .replicate = replicate, .low_words = true});
  Points points(layout.dims(), take ? take : count);
  PointBlock words;
  for (std::uint64_t begin = 0; begin < points.count(); begin += static_cast<std::uint64_t>(block)) {
    const int samples =
        static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(block), points.count() - begin));
    words.reset(layout.dims(), samples, true);
    sampler.fill(begin, words);
    for (int d = 0; d < layout.dims(); ++d) {
      for (int s = 0; s < samples; ++s) {
        for (int lane = 0; lane < kLanes; ++lane) {
          const auto i = static_cast<std::size_t>(s * kLanes + lane);
          points.at(d, begin + static_cast<std::uint64_t>(s), lane) =
              std::uint64_t{words.high(d)[i]} << 21 | words.low(d)[i];
        }
      }
    }
  }
  return points;
}

inline std::unique_ptr<Sampler> sampler_named(const std::string& name) {
  return SamplerCatalogue::built_in().make(name);
}

/// `dims` groups of one dimension.
inline Layout singles(int dims) { return {std::vector<std::uint8_t>(static_cast<std::size_t>(dims), 1)}; }

/// Sets HALFSLOPE_ISA for a scope, and puts back what it was.
class IsaScope {
 public:
  explicit IsaScope(const std::string& name) {
    if (const char* before = std::getenv("HALFSLOPE_ISA")) before_ = before;
    setenv("HALFSLOPE_ISA", name.c_str(), 1);
  }
  ~IsaScope() { before_.empty() ? unsetenv("HALFSLOPE_ISA") : setenv("HALFSLOPE_ISA", before_.c_str(), 1); }
  IsaScope(const IsaScope&) = delete;
  IsaScope& operator=(const IsaScope&) = delete;

 private:
  std::string before_;
};

}  // namespace halfslope
