#include "samplers/rotation.h"

#include <utility>

#include "samplers/word_source.h"

namespace halfslope {
namespace {

class Rotated final : public Sampler {
 public:
  explicit Rotated(std::unique_ptr<Sampler> points) : points_(std::move(points)), info_(points_->info()) {
    info_.name += "-cp";
    info_.description += "; shifted modulo 1 at random";
    info_.reference = "Cranley & Patterson, Randomization of number theoretic methods (1976)";
    info_.randomised = info_.unbiased = true;
  }
  const SamplerInfo& info() const override { return info_; }
  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    return points_->illegal(count, layout);
  }

  void prepare(const PointRequest& request) override {
    points_->prepare(request);
    words_.prepare(request);
    shifts_.resize(static_cast<std::size_t>(request.layout->dims()) * kShift);
    for (int d = 0; d < request.layout->dims(); ++d) words_.fill(Draw::kScramble, d, 0, 2, shift(d));
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    points_->fill(begin, block);
    // High and low words each wrap on their own: a carry from the low ones would let a binary64 point's top 24 bits
    // differ from the binary32 point, for which no low words are made. Both shifts are uniform, so the sum is uniform
    // on all 53 bits, and points keep their distances modulo 1 to 2⁻³².
    for (int d = 0; d < block.dims(); ++d) {
      const std::uint32_t* by = shift(d);
      std::uint32_t* high = block.high(d);
      for (int s = 0; s < block.samples(); ++s, high += kLanes) {
        for (int l = 0; l < kLanes; ++l) high[l] += by[l];
      }
      if (std::uint32_t* low = block.low(d)) {
        for (int s = 0; s < block.samples(); ++s, low += kLanes) {
          for (int l = 0; l < kLanes; ++l) low[l] = (low[l] + by[kLanes + l]) & 0x1fffff;
        }
      }
    }
  }

 private:
  static constexpr std::size_t kShift = 2 * kLanes;  // words of a dimension's shift: high ones, low ones
  std::uint32_t* shift(int dim) { return shifts_.data() + static_cast<std::size_t>(dim) * kShift; }

  std::unique_ptr<Sampler> points_;
  SamplerInfo info_;
  WordSource words_;
  AlignedBuffer<std::uint32_t> shifts_;
};

}  // namespace

std::unique_ptr<Sampler> rotated(std::unique_ptr<Sampler> points) {
  return std::make_unique<Rotated>(std::move(points));
}

}  // namespace halfslope
