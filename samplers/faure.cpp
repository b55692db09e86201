#include "samplers/faure.h"

#include <algorithm>
#include <vector>

#include "samplers/exact_counter.h"
#include "samplers/faure_sequence.h"
#include "samplers/scrambled_inverse.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

constexpr int kMostDims = 1024;
constexpr std::uint64_t kMost = std::uint64_t{1} << 31;

/// Digits of the indices up to 2³¹ in `base`.
int index_digits(std::uint32_t base) {
  int digits = 0;
  for (std::uint64_t power = 1; power <= kMost; power *= base) ++digits;
  return digits;
}

/// One coordinate as an exact fraction over b^t, t its digits: each digit that changes moves it by a multiple of a
/// power of 1/b, none of which is ever rounded (samplers/exact_counter.h).
class FaureCounter {
 public:
  FaureCounter(const GeneratorMatrices& matrices, int dim) : digits_(matrices, dim) {
    for (std::size_t k = 0; k < digits_.size(); ++k) denominator_ *= matrices.base;
    std::uint64_t unit = denominator_;
    for (std::size_t k = 0; k < digits_.size(); ++k) {
      unit /= matrices.base;
      for (std::uint32_t digit = 0; digit < matrices.base; ++digit) {
        multiples_.push_back(ExactFraction::of(digit * unit, denominator_));
      }
    }
    base_ = matrices.base;
  }
  void seek(std::uint64_t index) {
    if (index == digits_.index()) return;
    digits_.seek(index);
    at_ = {};
    for (std::size_t row = 0; row < digits_.size(); ++row) at_ = at_.plus(multiple(row, digits_[row]), denominator_);
  }
  std::uint64_t bits() const { return at_.quotient; }
  void next() {
    digits_.next([&](std::size_t row, std::uint32_t before, std::uint32_t after) {
      at_ = after >= before ? at_.plus(multiple(row, after - before), denominator_)
                            : at_.plus(negative(multiple(row, before - after)), denominator_);
    });
  }

 private:
  const ExactFraction& multiple(std::size_t row, std::uint32_t digit) const { return multiples_[row * base_ + digit]; }
  /// 1 minus a fraction above 0.
  ExactFraction negative(const ExactFraction& x) const {
    constexpr std::uint64_t kOne = std::uint64_t{1} << 53;
    return x.remainder ? ExactFraction{kOne - 1 - x.quotient, denominator_ - x.remainder}
                       : ExactFraction{kOne - x.quotient, 0};
  }

  FaureDigits digits_;
  std::uint32_t base_ = 2;
  std::uint64_t denominator_ = 1;
  std::vector<ExactFraction> multiples_;  ///< [row][digit]: digit b^−(row + 1)
  ExactFraction at_;
};

class Faure final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "faure",
        .description = "Faure sequence in the least prime base not below dims, natural order from the origin",
        .reference = "Faure, Discrepance de suites associees a un systeme de numeration (1982)",
        .sequence = true,
        .randomised = false,
        .unbiased = false,
        .max_dims = kMostDims,
        .rate = low_discrepancy_rate,
    };
    return kInfo;
  }
  std::optional<GeneratorMatrices> generator_matrices(int dims, int digits) const override {
    if (dims < 1 || dims > kMostDims || digits < 1) return std::nullopt;
    return faure_matrices(dims, digits);
  }
  void prepare(const PointRequest& request) override {
    const int dims = request.layout->dims();
    if (dims == 0 || counters_.size() == static_cast<std::size_t>(dims)) return;
    const GeneratorMatrices matrices = faure_matrices(dims, index_digits(faure_base(dims)));
    counters_.clear();
    for (int d = 0; d < dims; ++d) counters_.emplace_back(matrices, d);
  }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) fill_lanes(counters_[static_cast<std::size_t>(d)], begin, block, d);
  }

 private:
  std::vector<FaureCounter> counters_;
};

class FaureOwen final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "faure-owen",
        .description = "Faure sequence, nested scrambling that depends on digits and depth",
        .reference = "Owen, Randomly permuted (t,m,s)-nets and (t,s)-sequences (1995)",
        .sequence = true,
        .max_dims = kMostDims,
        .rate = scrambled_plane_rate,
    };
    return kInfo;
  }
  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    const std::uint64_t most = ScrambledInverse::most_points_in(faure_base(std::clamp(layout.dims(), 1, kMostDims)));
    if (count > most) return LegalNeighbours{most, std::nullopt};
    return Sampler::illegal(count, layout);
  }
  std::optional<GeneratorMatrices> generator_matrices(int dims, int digits) const override {
    if (dims < 1 || dims > kMostDims || digits < 1) return std::nullopt;
    return faure_matrices(dims, digits);
  }
  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    const int dims = request.layout->dims();
    const std::uint32_t base = faure_base(std::max(dims, 1));
    if (digits_.size() != static_cast<std::size_t>(dims)) {
      const GeneratorMatrices matrices = faure_matrices(std::max(dims, 1), index_digits(base));
      digits_.clear();
      for (int d = 0; d < dims; ++d) digits_.emplace_back(matrices, d);
      scrambles_.resize(digits_.size());
    }
    base_ = base;
    // The first b^k coordinates of a dimension are the first b^k radical inverses, in another order.
    std::uint64_t inverses = 1;
    while (inverses < request.count) inverses *= base;
    for (int d = 0; d < dims; ++d) scrambles_[static_cast<std::size_t>(d)].prepare(words_, d, base, inverses);
  }

  // A coordinate's digits, first one first, are scrambled as those of a radical inverse are. Whose? Of the index that
  // has them as its own digits, lowest first.
  void fill(std::uint64_t begin, PointBlock& block) override {
    indices_.resize(static_cast<std::size_t>(block.samples()));
    for (int d = 0; d < block.dims(); ++d) {
      FaureDigits& digits = digits_[static_cast<std::size_t>(d)];
      if (digits.index() != begin) digits.seek(begin);
      std::uint64_t inverse_of = 0;
      for (std::size_t row = digits.size(); row-- > 0;) inverse_of = inverse_of * base_ + digits[row];
      for (std::uint32_t& index : indices_) {
        index = static_cast<std::uint32_t>(inverse_of);
        std::uint64_t power = 1;
        digits.next([&](std::size_t, std::uint32_t before, std::uint32_t after) {
          inverse_of += power * after - power * before;
          power *= base_;
        });
      }
      scrambles_[static_cast<std::size_t>(d)].fill(indices_, block, d);
    }
  }

 private:
  std::uint32_t base_ = 2;
  WordSource words_;
  std::vector<FaureDigits> digits_;
  std::vector<ScrambledInverse> scrambles_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

std::unique_ptr<Sampler> make_faure() { return std::make_unique<Faure>(); }
std::unique_ptr<Sampler> make_faure_owen() { return std::make_unique<FaureOwen>(); }

}  // namespace halfslope
