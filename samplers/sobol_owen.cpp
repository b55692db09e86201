#include "samplers/sobol_owen.h"

#include <algorithm>
#include <bit>

#include "samplers/sobol_sequence.h"
#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

/// What both scrambles share: two key words for each dimension and lane, and random digits below the 32nd.
class ScrambledSobol : public Sampler {
 public:
  explicit ScrambledSobol(SobolSequence::FirstDigit first) : sequence_(first) {}
  std::optional<GeneratorMatrices> generator_matrices(int dims, int digits) const override {
    return sobol_matrices(dims, digits);
  }
  void prepare(const PointRequest& request) override {
    if (!kernels_) kernels_ = &kernels<SamplerKernels>();
    words_.prepare(request);
    const int dims = request.layout->dims();
    sequence_.reserve(dims);
    keys_.resize(static_cast<std::size_t>(dims) * kKeys);
    for (int d = 0; d < dims; ++d) words_.fill(Draw::kScramble, d, 0, 2, keys_.data() + offset(d));
  }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      scramble(d, sequence_.run(d, begin), block.samples(), block.high(d));
      if (block.has_low_words()) words_.fill_low(d, begin, block.samples(), block.low(d));
    }
  }

 protected:
  const std::uint32_t* keys(int dim) const { return keys_.data() + offset(dim); }
  const SamplerKernels& loops() const { return *kernels_; }

 private:
  static constexpr std::size_t kKeys = 2 * kLanes;
  static std::size_t offset(int dim) { return static_cast<std::size_t>(dim) * kKeys; }
  virtual void scramble(int dim, const SobolRun& run, int samples, std::uint32_t* high) const = 0;

  const SamplerKernels* kernels_ = nullptr;
  SobolSequence sequence_;
  WordSource words_;
  AlignedBuffer<std::uint32_t> keys_;
};

class SobolOwen final : public ScrambledSobol {
 public:
  SobolOwen() : ScrambledSobol(SobolSequence::FirstDigit::kTop) {}
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "sobol-owen",
        .description = "Sobol' sequence, nested uniform scrambling exactly as defined",
        .reference = "Owen, Randomly permuted (t,m,s)-nets and (t,s)-sequences (1995)",
        .sequence = true,
        .max_dims = sobol_dims(),
        .rate = scrambled_net_rate,
    };
    return kInfo;
  }
  void prepare(const PointRequest& request) override {
    ScrambledSobol::prepare(request);
    const auto dims = static_cast<std::uint64_t>(request.layout->dims());
    const std::uint64_t points = std::min(request.count, kTabled), rows = kTableWords / (std::max(dims, kOne) * kLanes);
    digits_ = static_cast<std::uint32_t>(std::bit_width(std::min(std::bit_ceil(points), std::max(rows, kOne))) - 1);
    size_ = kLanes << digits_;
    tables_.resize(dims * size_);
    for (std::size_t d = 0; d < dims; ++d) {
      loops().sobol_owen_table(keys(static_cast<int>(d)), digits_, tables_.data() + d * size_);
    }
  }

 private:
  static constexpr std::uint64_t kOne = 1;
  static constexpr std::uint64_t kTabled = 256;             // points of a dimension
  static constexpr std::uint64_t kTableWords = 256 * 1024;  // of all dimensions: the second level of cache
  void scramble(int dim, const SobolRun& run, int samples, std::uint32_t* high) const override {
    loops().sobol_owen(run, {keys(dim), tables_.data() + static_cast<std::size_t>(dim) * size_, digits_}, samples,
                       high);
  }

  std::uint32_t digits_ = 0;
  std::size_t size_ = 0;  // words of a dimension's table
  AlignedBuffer<std::uint32_t> tables_;
};

class SobolOwenFast final : public ScrambledSobol {
 public:
  SobolOwenFast() : ScrambledSobol(SobolSequence::FirstDigit::kBottom) {}
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "sobol-owen-fast",
        .description = "Sobol' sequence, nested scrambling by a hash of its digits",
        .reference =
            "Laine & Karras, Stratified sampling for stochastic transparency (2011); Vegdahl, Building a "
            "better LK hash (2021)",
        .sequence = true,
        .max_dims = sobol_dims(),
        .rate = scrambled_net_rate,
    };
    return kInfo;
  }

 private:
  void scramble(int dim, const SobolRun& run, int samples, std::uint32_t* high) const override {
    loops().sobol_owen_fast(run, keys(dim), samples, high);
  }
};

}  // namespace

std::unique_ptr<Sampler> make_sobol_owen() { return std::make_unique<SobolOwen>(); }
std::unique_ptr<Sampler> make_sobol_owen_fast() { return std::make_unique<SobolOwenFast>(); }

}  // namespace halfslope
