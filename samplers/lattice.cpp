// Lattice rules of every size 2^m in one sequence (F. J. Hickernell, H. S. Hong, P. L'Ecuyer and C. Lemieux,
// "Extensible lattice sequences for quasi-Monte Carlo quadrature", 2000): the first 2^m points, i = 0 … 2^m − 1, have
// the radical inverses φ_2(i) = 0/2^m … (2^m − 1)/2^m in some order, so φ_2(i) z modulo 1 are the points of the lattice
// with 2^m points and generating vector z.
#include "samplers/lattice.h"

#include "samplers/theory.h"
#include "samplers/word_source.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 20;

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

class Lattice final : public Sampler {
 public:
  explicit Lattice(bool tent) : tent_(tent) {
    info_.name = tent ? "lattice-tent" : "lattice";
    info_.description = tent ? "embedded rank-1 lattice, shifted modulo 1 at random, folded by the tent; N at most 2^20"
                             : "embedded rank-1 lattice, shifted modulo 1 at random; N at most 2^20";
    info_.reference = tent ? "Cools, Kuo & Nuyens (2006); Hickernell, Obtaining O(N^(-2+e)) convergence (2002)"
                           : "Cools, Kuo & Nuyens, Constructing embedded lattice rules (2006)";
    info_.sequence = true;
    info_.max_dims = static_cast<int>(lattice_vector().size());
    info_.max_count = kMostPoints;
    info_.rate = tent ? folded_lattice_rate : low_discrepancy_rate;
  }
  const SamplerInfo& info() const override { return info_; }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    const int dims = request.layout->dims();
    shifts_.resize(static_cast<std::size_t>(dims) * 2 * kLanes);
    for (int d = 0; d < dims; ++d) words_.fill(Draw::kScramble, d, 0, 2, shift(d));
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    // Up to 2²⁰ points the phase φ_2(i) z modulo 1 has no bits below 2⁻²⁰. So the low word is the shift's own, and
    // there is no carry.
    for (int d = 0; d < block.dims(); ++d) {
      const std::uint32_t z = lattice_vector()[static_cast<std::size_t>(d)];
      const std::uint32_t *by = shift(d), *by_low = by + kLanes;
      std::uint32_t *high = block.high(d), *low = block.low(d);
      for (int s = 0; s < block.samples(); ++s) {
        const std::uint32_t phase = reversed(static_cast<std::uint32_t>(begin) + static_cast<std::uint32_t>(s)) * z;
        for (int l = 0; l < kLanes; ++l) high[l] = phase + by[l];
        if (low) {
          for (int l = 0; l < kLanes; ++l) low[l] = by_low[l] >> 11;
        }
        if (tent_) fold(high, low, by_low);
        high += kLanes;
        if (low) low += kLanes;
      }
    }
  }

 private:
  // The tent over the 53 bits of x: all bits go up by one place, and where the one that falls out was set, the others
  // turn over. That is 2x below ½ and 1 − 2⁻⁵³ − (2x − 1) above: a bijection of the 2⁵³ coordinates, so what was
  // uniform stays uniform, and 1 is never reached. The high word needs the low word's first bit even where none is
  // asked for.
  static void fold(std::uint32_t* high, std::uint32_t* low, const std::uint32_t* by_low) {
    for (int l = 0; l < kLanes; ++l) {
      const std::uint32_t turn = 0u - (high[l] >> 31);
      high[l] = ((high[l] << 1) | (by_low[l] >> 31)) ^ turn;
      if (low) low[l] = ((low[l] << 1) ^ turn) & 0x1fffff;
    }
  }
  /// The high words of a dimension's shift, then the low ones in their upper 21 bits.
  std::uint32_t* shift(int dim) { return shifts_.data() + static_cast<std::size_t>(dim) * 2 * kLanes; }

  SamplerInfo info_;
  bool tent_;
  WordSource words_;
  AlignedBuffer<std::uint32_t> shifts_;
};

}  // namespace

std::unique_ptr<Sampler> make_lattice() { return std::make_unique<Lattice>(false); }
std::unique_ptr<Sampler> make_lattice_tent() { return std::make_unique<Lattice>(true); }

}  // namespace halfslope
