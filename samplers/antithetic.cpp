#include "samplers/antithetic.h"

#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

class Antithetic final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "antithetic",
        .description = "pairs of independent points u and their reflections 1 - u; N even",
        .reference = "Hammersley & Morton, A new Monte Carlo technique: antithetic variates (1956)",
        .sequence = true,
        .max_dims = kMaxWordDims,
        .rate = monte_carlo_rate,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    if (count == 0) return LegalNeighbours{std::nullopt, 2};
    if (count > info().max_count || count % 2 == 0) return Sampler::illegal(count, layout);
    return LegalNeighbours{count > 1 ? std::optional(count - 1) : std::nullopt, count + 1};
  }

  void prepare(const PointRequest& request) override { words_.prepare(request); }

  void fill(std::uint64_t begin, PointBlock& block) override {
    const std::uint64_t first = begin / 2, end = (begin + static_cast<std::uint64_t>(block.samples()) + 1) / 2;
    const auto pairs = static_cast<int>(end - first);
    drawn_.resize(static_cast<std::size_t>(pairs) * kLanes);
    for (int d = 0; d < block.dims(); ++d) {
      // 1 − u takes every bit of the high word the other way and the negative of the low word, so that the two add up
      // to 1 exactly. For that the low word must not be 0, and an odd one is as far from 0 below as above.
      words_.fill(Draw::kHigh, d, first, pairs, drawn_.data());
      spread(begin, block.samples(), block.high(d), [](std::uint32_t word) { return ~word; });
      if (!block.has_low_words()) continue;
      words_.fill_low(d, first, pairs, drawn_.data());
      for (std::uint32_t* word = drawn_.data(); word < drawn_.data() + drawn_.size(); ++word) *word |= 1;
      spread(begin, block.samples(), block.low(d), [](std::uint32_t word) { return (1u << 21) - word; });
    }
  }

 private:
  // The words of the drawn points, and after each those of its reflection.
  template <class Reflect>
  void spread(std::uint64_t begin, int samples, std::uint32_t* out, Reflect reflect) const {
    const std::uint32_t* from = drawn_.data();
    for (std::uint64_t i = begin; i < begin + static_cast<std::uint64_t>(samples); ++i, out += kLanes) {
      if (i % 2 == 0) {
        for (int l = 0; l < kLanes; ++l) out[l] = from[l];
      } else {
        for (int l = 0; l < kLanes; ++l) out[l] = reflect(from[l]);
        from += kLanes;
      }
    }
  }

  WordSource words_;
  AlignedBuffer<std::uint32_t> drawn_;
};

}  // namespace

std::unique_ptr<Sampler> make_antithetic() { return std::make_unique<Antithetic>(); }

}  // namespace halfslope
