#include "samplers/regular.h"

#include <algorithm>

#include "samplers/exact_counter.h"
#include "samplers/jittered.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

/// The centres (2k + 1)/(2n) of n cells, counted up and from the first again after the last.
class Centres {
 public:
  void reset(std::uint64_t side, std::uint64_t cell) {
    side_ = side;
    step_ = ExactFraction::of(2, 2 * side);
    seek(cell);
  }
  std::uint64_t bits() const { return at_.quotient; }
  void next() {
    if (++cell_ == side_) return seek(0);
    at_ = at_.plus(step_, 2 * side_);
  }

 private:
  void seek(std::uint64_t cell) {
    cell_ = cell;
    at_ = ExactFraction::of(2 * cell + 1, 2 * side_);
  }

  std::uint64_t side_ = 1, cell_ = 0;
  ExactFraction at_, step_;
};

class Regular final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "regular",
        .description = "the centres of the cells of the full grid over all d dimensions; N = n^d",
        .reference = "Davis & Rabinowitz, Methods of numerical integration (1984), the product midpoint rule",
        .randomised = false,
        .unbiased = false,
        .max_dims = 31,
        .rate = midpoint_rate,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    if (count == 0 || layout.dims() == 0) return Sampler::illegal(count, layout);
    return illegal_grid(count, layout.dims(), info().max_count);
  }

  void prepare(const PointRequest& request) override {
    const int dims = request.layout->dims();
    side_ = dims > 0 ? grid_side(request.count, dims) : 1;
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    // Points come in the order of `jittered`: the cell's coordinates are the digits of the index in base n.
    std::uint64_t period = 1;
    for (int d = 0; d < block.dims(); ++d, period *= side_) {
      Centres centres;
      centres.reset(side_, begin / period % side_);
      std::uint64_t left = period - begin % period;
      std::uint32_t *high = block.high(d), *low = block.low(d);
      for (int s = 0; s < block.samples(); ++s, high += kLanes) {
        std::fill_n(high, kLanes, static_cast<std::uint32_t>(centres.bits() >> 21));
        if (low) {
          std::fill_n(low, kLanes, static_cast<std::uint32_t>(centres.bits() & 0x1fffff));
          low += kLanes;
        }
        if (--left > 0) continue;
        left = period;
        centres.next();
      }
    }
  }

 private:
  std::uint64_t side_ = 1;
};

}  // namespace

std::unique_ptr<Sampler> make_regular() { return std::make_unique<Regular>(); }

}  // namespace halfslope
