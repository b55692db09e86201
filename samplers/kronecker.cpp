#include "samplers/kronecker.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

// 96 bits of y^k are wanted for k up to 1024, and rounding takes some 20 bits of these.
using Float =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<192, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;

// f(y) = y^d (1 + y) − 1 grows and is convex, so from above its root Newton's steps fall towards it, until rounding
// stops them.
Float root(int dims) {
  for (Float y = 1;;) {
    const Float power = pow(y, dims - 1);
    const Float next = y - (power * y * (1 + y) - 1) / (power * (dims + (dims + 1) * y));
    if (next >= y) return y;
    y = next;
  }
}

class Kronecker final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "kronecker",
        .description = "Kronecker sequence R_d, multiples of the powers of one number; shifted modulo 1 at random",
        .reference = "Roberts, The unreasonable effectiveness of quasirandom sequences (2018)",
        .sequence = true,
        .max_dims = 1024,
        .rate = kronecker_rate,
    };
    return kInfo;
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    const auto dims = static_cast<std::size_t>(request.layout->dims());
    if (steps_.size() != dims)
      steps_ = dims > 0 ? kronecker_steps(request.layout->dims()) : std::vector<LongFraction>();
    shifts_.resize(dims * kLanes);
    for (std::size_t d = 0; d < dims; ++d) {
      std::uint32_t words[2 * kLanes];
      words_.fill(Draw::kScramble, static_cast<int>(d), 0, 2, words);
      for (std::size_t l = 0; l < kLanes; ++l)
        shifts_[d * kLanes + l] = std::uint64_t{words[l]} << 32 | words[kLanes + l];
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      const LongFraction step = steps_[static_cast<std::size_t>(d)];
      const std::uint64_t* shift = shifts_.data() + static_cast<std::size_t>(d) * kLanes;
      std::uint32_t *high = block.high(d), *low = block.low(d);
      for (int s = 0; s < block.samples(); ++s, high += kLanes) {
        const std::uint64_t phase = step.multiple(begin + static_cast<std::uint64_t>(s));
        for (int l = 0; l < kLanes; ++l) high[l] = static_cast<std::uint32_t>((phase + shift[l]) >> 32);
        if (!low) continue;
        for (int l = 0; l < kLanes; ++l) low[l] = static_cast<std::uint32_t>(phase + shift[l]) >> 11;
        low += kLanes;
      }
    }
  }

 private:
  WordSource words_;
  std::vector<LongFraction> steps_;
  AlignedBuffer<std::uint64_t> shifts_;
};

}  // namespace

std::vector<LongFraction> kronecker_steps(int dims) {
  const Float y = root(dims);
  std::vector<LongFraction> steps;
  Float power = 1;
  for (int k = 1; k <= dims; ++k) {
    power *= y;
    const Float scaled = ldexp(power, 64), high = floor(scaled);
    steps.push_back({static_cast<std::uint64_t>(high), static_cast<std::uint32_t>(ldexp(Float(scaled - high), 32))});
  }
  return steps;
}

std::unique_ptr<Sampler> make_kronecker() { return std::make_unique<Kronecker>(); }

}  // namespace halfslope
