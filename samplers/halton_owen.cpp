#include "samplers/halton_owen.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "samplers/word_source.h"

namespace halfslope {
namespace {

constexpr int kDims = 1024;
constexpr std::uint32_t kTableSize = 256;

constexpr std::array<std::uint32_t, kDims> first_primes() {
  std::array<std::uint32_t, kDims> primes = {};
  std::size_t found = 0;
  for (std::uint32_t n = 2; found < primes.size(); ++n) {
    bool prime = true;
    for (std::size_t i = 0; i < found && primes[i] * primes[i] <= n && prime; ++i) prime = n % primes[i] != 0;
    if (prime) primes[found++] = n;
  }
  return primes;
}

class HaltonOwen final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "halton-owen",
        .description = "Halton sequence, nested scrambling that depends on digits and depth",
        .reference = "Owen (1995); Owen, A randomized Halton algorithm in R (2017)",
        .sequence = true,
        .max_dims = kDims,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    // The kernel holds a point's digits in 31 bits.
    std::uint64_t most = info().max_count;
    for (int d = 0; d < std::min(layout.dims(), kDims); ++d) {
      const std::uint64_t base = primes()[static_cast<std::size_t>(d)];
      std::uint64_t power = base;
      while (power * base <= info().max_count) power *= base;
      most = std::min(most, power);
    }
    if (count > most) return LegalNeighbours{most, std::nullopt};
    return Sampler::illegal(count, layout);
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    if (!kernels_) kernels_ = &kernels<SamplerKernels>();
    dims_.resize(static_cast<std::size_t>(request.layout->dims()));
    for (std::size_t d = 0; d < dims_.size(); ++d) {
      Dim& dim = dims_[d];
      words_.fill(Draw::kScramble, static_cast<int>(d), 0, 4, dim.keys.data());
      const std::uint32_t base = primes()[d];
      std::uint32_t size = 1, digits = 0;
      while (size < request.count && size * base <= kTableSize) size *= base, ++digits;
      dim.table.resize(std::size_t{size} * kLanes);
      const auto tabled = static_cast<std::uint32_t>(std::min<std::uint64_t>(size, request.count));
      kernels_->halton_owen_table(base, dim.keys.data(), tabled, dim.table.data());
      dim.kernel = {base, digits, dim.table.data(), dim.keys.data()};
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      kernels_->halton_owen(dims_[static_cast<std::size_t>(d)].kernel, static_cast<std::uint32_t>(begin),
                            block.samples(), block.high(d), block.low(d));
    }
  }

 private:
  struct Dim {
    std::array<std::uint32_t, 4 * kLanes> keys;
    AlignedBuffer<double> table;
    HaltonDim kernel;
  };
  WordSource words_;
  const SamplerKernels* kernels_ = nullptr;
  std::vector<Dim> dims_;
};

}  // namespace

std::span<const std::uint32_t> primes() {
  static constexpr auto kPrimes = first_primes();
  return kPrimes;
}

std::unique_ptr<Sampler> make_halton_owen() { return std::make_unique<HaltonOwen>(); }

}  // namespace halfslope
