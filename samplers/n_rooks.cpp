#include "samplers/n_rooks.h"

#include <vector>

#include "samplers/strata.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

class NRooks final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "n-rooks",
        .description = "Latin hypercube: N strata in every dimension, shuffled independently; any N",
        .reference = "McKay, Beckman & Conover (1979); Shirley, Discrepancy as a quality measure (1991)",
        .max_dims = 1024,
        .rate = latin_rate,
    };
    return kInfo;
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    strata_.reset(request.count);
    permutations_.resize(static_cast<std::size_t>(request.layout->dims()));
    for (std::size_t d = 0; d < permutations_.size(); ++d) {
      permutations_[d].prepare(words_, static_cast<int>(d), request.count);
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      std::uint32_t* high = block.high(d);
      words_.fill(Draw::kHigh, d, begin, block.samples(), high);
      const LanePermutation& permutation = permutations_[static_cast<std::size_t>(d)];
      for (int s = 0; s < block.samples(); ++s, high += kLanes) {
        std::uint32_t cells[kLanes];
        permutation.lanes(begin + static_cast<std::uint64_t>(s), cells);
        strata_.place_lanes(cells, high);
      }
      if (block.has_low_words()) words_.fill_low(d, begin, block.samples(), block.low(d));
    }
  }

 private:
  WordSource words_;
  Strata strata_;
  std::vector<LanePermutation> permutations_;
};

}  // namespace

std::unique_ptr<Sampler> make_n_rooks() { return std::make_unique<NRooks>(); }

}  // namespace halfslope
