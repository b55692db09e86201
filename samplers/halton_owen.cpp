#include "samplers/halton_owen.h"

#include <vector>

#include "samplers/radical_inverse.h"
#include "samplers/scrambled_inverse.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

class HaltonOwen final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "halton-owen",
        .description = "Halton sequence, nested scrambling that depends on digits and depth",
        .reference = "Owen (1995); Owen, A randomized Halton algorithm in R (2017)",
        .sequence = true,
        .max_dims = static_cast<int>(primes().size()),
        .rate = scrambled_sequence_rate,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    const std::uint64_t most = ScrambledInverse::most_points(layout.dims());
    if (count > most) return LegalNeighbours{most, std::nullopt};
    return Sampler::illegal(count, layout);
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    dims_.resize(static_cast<std::size_t>(request.layout->dims()));
    for (std::size_t d = 0; d < dims_.size(); ++d) {
      dims_[d].prepare(words_, static_cast<int>(d), primes()[d], request.count);
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) dims_[static_cast<std::size_t>(d)].fill(begin, block, d);
  }

 private:
  WordSource words_;
  std::vector<ScrambledInverse> dims_;
};

}  // namespace

std::unique_ptr<Sampler> make_halton_owen() { return std::make_unique<HaltonOwen>(); }

}  // namespace halfslope
