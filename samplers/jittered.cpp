#include "samplers/jittered.h"

#include <algorithm>
#include <bit>

#include "core/assertion.h"
#include "samplers/strata.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

/// Whether side^dims ≤ count.
bool fits(std::uint64_t side, int dims, std::uint64_t count) {
  if (side <= 1) return side <= count;
  std::uint64_t rest = count;  // ⌊count / side^d⌋, so it ends after 64 divisions however many dimensions there are
  for (int d = 0; d < dims && rest > 0; ++d) rest /= side;
  return rest > 0;
}

std::uint64_t cells(std::uint64_t side, int dims) {
  std::uint64_t product = 1;
  for (int d = 0; d < dims && side > 1; ++d) product *= side;
  return product;
}

class Jittered final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "jittered",
        .description = "one point in each cell of the full grid over all d dimensions; N = n^d",
        .reference = "Cook, Porter & Carpenter, Distributed ray tracing (1984)",
        .max_dims = 31,
        .rate = grid_rate,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    if (count == 0 || layout.dims() == 0) return Sampler::illegal(count, layout);
    return illegal_grid(count, layout.dims(), info().max_count);
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    const int dims = request.layout->dims();
    if (request.count == count_ && dims == dims_) return;
    count_ = request.count;
    dims_ = dims;
    side_ = dims > 0 ? grid_side(count_, dims) : 1;
    strata_.reset(side_);
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    // Point s stands in the cell whose coordinates are the digits of s in base n, dimension 0's the lowest. A digit
    // stays for n^d points and then goes up, so no point costs a division.
    std::uint64_t period = 1;
    for (int d = 0; d < block.dims(); ++d, period *= side_) {
      std::uint32_t* high = block.high(d);
      words_.fill(Draw::kHigh, d, begin, block.samples(), high);
      if (block.has_low_words()) words_.fill_low(d, begin, block.samples(), block.low(d));
      std::uint64_t digit = begin / period % side_, left = period - begin % period;
      for (int s = 0; s < block.samples(); ++s, high += kLanes) {
        strata_.place_row(digit, high);
        if (--left > 0) continue;
        left = period;
        if (++digit == side_) digit = 0;
      }
    }
  }

 private:
  WordSource words_;
  std::uint64_t count_ = 0, side_ = 1;
  int dims_ = 0;
  Strata strata_;
};

}  // namespace

std::uint64_t grid_side(std::uint64_t count, int dims) {
  assert_equal(count >= 1 && dims >= 1, true, "grid_side: a point and a dimension at least");
  std::uint64_t side = 0;
  for (std::uint64_t bit = std::bit_floor(count); bit > 0; bit >>= 1) {
    if (fits(side | bit, dims, count)) side |= bit;
  }
  return side;
}

std::optional<LegalNeighbours> illegal_grid(std::uint64_t count, int dims, std::uint64_t most) {
  const std::uint64_t side = grid_side(std::min(count, most), dims), below = cells(side, dims);
  if (below == count) return std::nullopt;
  if (!fits(side + 1, dims, most)) return LegalNeighbours{below, std::nullopt};
  return LegalNeighbours{below, cells(side + 1, dims)};
}

std::unique_ptr<Sampler> make_jittered() { return std::make_unique<Jittered>(); }

}  // namespace halfslope
