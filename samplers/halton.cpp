#include "samplers/halton.h"

#include <vector>

#include "samplers/exact_counter.h"
#include "samplers/radical_inverse.h"
#include "samplers/rotation.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

class Halton final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "halton",
        .description = "Halton sequence, radical inverses in the first primes from index 0",
        .reference = "Halton, On the efficiency of certain quasi-random sequences of points (1960)",
        .sequence = true,
        .randomised = false,
        .unbiased = false,
        .max_dims = static_cast<int>(primes().size()),
        .rate = low_discrepancy_rate,
    };
    return kInfo;
  }
  void prepare(const PointRequest& request) override {
    const auto dims = static_cast<std::size_t>(request.layout->dims());
    while (counters_.size() < dims) counters_.emplace_back(primes()[counters_.size()]);
  }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) fill_lanes(counters_[static_cast<std::size_t>(d)], begin, block, d);
  }

 private:
  std::vector<RadicalCounter> counters_;
};

}  // namespace

std::unique_ptr<Sampler> make_halton() { return std::make_unique<Halton>(); }
std::unique_ptr<Sampler> make_halton_cp() { return rotated(make_halton()); }

}  // namespace halfslope
