#include "samplers/hammersley.h"

#include <vector>

#include "samplers/exact_counter.h"
#include "samplers/radical_inverse.h"
#include "samplers/rotation.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

class Hammersley final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "hammersley",
        .description = "Hammersley set, i/N and then radical inverses in the first primes; any N",
        .reference = "Hammersley, Monte Carlo methods for solving multivariable problems (1960)",
        .randomised = false,
        .unbiased = false,
        .max_dims = static_cast<int>(primes().size()) + 1,
        .rate = low_discrepancy_rate,
    };
    return kInfo;
  }
  void prepare(const PointRequest& request) override {
    even_.reset(request.count);
    const auto dims = static_cast<std::size_t>(request.layout->dims());
    while (counters_.size() + 1 < dims) counters_.emplace_back(primes()[counters_.size()]);
  }
  void fill(std::uint64_t begin, PointBlock& block) override {
    if (block.dims() > 0) fill_lanes(even_, begin, block, 0);
    for (int d = 1; d < block.dims(); ++d) fill_lanes(counters_[static_cast<std::size_t>(d - 1)], begin, block, d);
  }

 private:
  EvenCounter even_;
  std::vector<RadicalCounter> counters_;
};

}  // namespace

std::unique_ptr<Sampler> make_hammersley() { return std::make_unique<Hammersley>(); }
std::unique_ptr<Sampler> make_hammersley_cp() { return rotated(make_hammersley()); }

}  // namespace halfslope
