#include "samplers/sobol.h"

#include <algorithm>
#include <bit>

#include "samplers/rotation.h"
#include "samplers/sobol_sequence.h"
#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

/// Calls use(sample, point) for the points of a run.
template <class Use>
void follow(const SobolRun& run, int count, Use use) {
  std::uint32_t index = run.begin, point = run.first;
  for (int s = 0; s < count; ++s, ++index) {
    use(s, point);
    point ^= run.steps[std::countr_one(index)];
  }
}

class Sobol final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "sobol",
        .description = "Sobol' sequence, natural order from the origin",
        .reference = "Sobol' (1967); Joe & Kuo, Constructing Sobol' sequences with better 2-D projections (2008)",
        .sequence = true,
        .randomised = false,
        .unbiased = false,
        .max_dims = sobol_dims(),
        .rate = low_discrepancy_rate,
    };
    return kInfo;
  }
  std::optional<GeneratorMatrices> generator_matrices(int dims, int digits) const override {
    return sobol_matrices(dims, digits);
  }
  void prepare(const PointRequest& request) override { sequence_.reserve(request.layout->dims()); }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      std::uint32_t* high = block.high(d);
      follow(sequence_.run(d, begin), block.samples(),
             [&](int s, std::uint32_t point) { std::fill_n(high + s * kLanes, kLanes, point); });
      if (block.has_low_words()) std::fill_n(block.low(d), block.stride(), 0u);
    }
  }

 private:
  SobolSequence sequence_;
};

class SobolXor final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "sobol-xor",
        .description = "Sobol' sequence under a digital shift: the same random digits are added to every point's",
        .reference = "L'Ecuyer & Lemieux, Recent advances in randomized quasi-Monte Carlo methods (2002)",
        .sequence = true,
        .max_dims = sobol_dims(),
        .rate = low_discrepancy_rate,
    };
    return kInfo;
  }
  std::optional<GeneratorMatrices> generator_matrices(int dims, int digits) const override {
    return sobol_matrices(dims, digits);
  }
  void prepare(const PointRequest& request) override {
    sequence_.reserve(request.layout->dims());
    words_.prepare(request);
    shifts_.resize(static_cast<std::size_t>(request.layout->dims()) * kShift);
    for (int d = 0; d < request.layout->dims(); ++d) words_.fill(Draw::kScramble, d, 0, 2, shift(d));
  }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      const std::uint32_t* by = shift(d);
      std::uint32_t* high = block.high(d);
      follow(sequence_.run(d, begin), block.samples(), [&](int s, std::uint32_t point) {
        for (int l = 0; l < kLanes; ++l) high[s * kLanes + l] = point ^ by[l];
      });
      // The digits below the 32nd are 0 in the sequence, so the shift alone is there, in every point.
      if (std::uint32_t* low = block.low(d)) {
        for (int s = 0; s < block.samples(); ++s, low += kLanes) {
          for (int l = 0; l < kLanes; ++l) low[l] = by[kLanes + l] >> 11;
        }
      }
    }
  }

 private:
  static constexpr std::size_t kShift = 2 * kLanes;  // words of a dimension's shift: high ones, low ones
  std::uint32_t* shift(int dim) { return shifts_.data() + static_cast<std::size_t>(dim) * kShift; }

  SobolSequence sequence_;
  WordSource words_;
  AlignedBuffer<std::uint32_t> shifts_;
};

}  // namespace

std::unique_ptr<Sampler> make_sobol() { return std::make_unique<Sobol>(); }
std::unique_ptr<Sampler> make_sobol_xor() { return std::make_unique<SobolXor>(); }
std::unique_ptr<Sampler> make_sobol_cp() { return rotated(make_sobol()); }

}  // namespace halfslope
