#include "samplers/independent.h"

#include "core/kernel_library.h"
#include "samplers/kernels.h"
#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

class Independent final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "independent",
        .description = "pseudo-random points, every coordinate independent and uniform",
        .reference = "Salmon, Moraes, Dror & Shaw, Parallel random numbers: as easy as 1, 2, 3 (2011): Philox 4x32-10",
        .sequence = true,
        .max_dims = kMaxWordDims,
        .rate = monte_carlo_rate,
    };
    return kInfo;
  }
  void prepare(const PointRequest& request) override { words_.prepare(request); }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      words_.fill(Draw::kHigh, d, begin, block.samples(), block.high(d));
      if (block.has_low_words()) words_.fill_low(d, begin, block.samples(), block.low(d));
    }
  }

 private:
  WordSource words_;
};

}  // namespace

std::unique_ptr<Sampler> make_independent() { return std::make_unique<Independent>(); }

}  // namespace halfslope
