// Orthogonal arrays of strength 2 (R. C. Bose, "On the application of the properties of Galois fields to the problem of
// construction of hyper-Graeco-Latin squares", 1938), randomised (A. B. Owen, "Orthogonal arrays for computer
// experiments, integration and visualization", 1992) and refined (B. Tang, "Orthogonal array-based Latin hypercubes",
// 1993; W. Jarosz and others, "Orthogonal array sampling for Monte Carlo rendering", 2019).
//
// For a prime p, point i = a p + b has in dimension 0 the level a, in dimension 1 the level b, and in dimension j ≥ 2
// the level a + (j − 1) b mod p. Two dimensions' levels are two linear forms of (a, b) of which neither is a multiple
// of the other, so each of the p² pairs of levels comes once. Each dimension's levels are then permuted at random.
//
// The p points of one level go to its p sub-strata, which makes all N points a Latin hypercube in every dimension.
// Point number r of a level, r = b (in dimension 1: a), goes to sub-stratum g + h r mod p with g uniform on 0 … p − 1
// and h uniform on 1 … p − 1, of the level's own. For a prime p any two points of a level thus go to a uniform pair of
// different sub-strata, as they would under a uniformly random permutation, and points of different levels to
// independent ones. The variance of an estimate depends on pairs of points alone, so it is that of uniformly random
// permutations, at two words a level.
#include "samplers/orthogonal_array.h"

#include <algorithm>
#include <vector>

#include "samplers/strata.h"

namespace halfslope {
namespace {

bool is_prime(std::uint64_t n) {
  if (n < 2) return false;
  for (std::uint64_t d = 2; d * d <= n; ++d) {
    if (n % d == 0) return false;
  }
  return true;
}

/// ⌊√n⌋ for n < 2⁶².
std::uint64_t integer_root(std::uint64_t n) {
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 31; bit > 0; bit >>= 1) {
    if ((root | bit) * (root | bit) <= n) root |= bit;
  }
  return root;
}

/// Remainders modulo p < 2¹⁶ of x < p², without a division: with m = (2⁴⁸ + e)/p, 0 < e ≤ p, the product x m/2⁴⁸
/// exceeds x/p by x e/(2⁴⁸ p) < p²/2⁴⁸ < 1/p, too little to reach the next integer.
class Modulus {
 public:
  explicit Modulus(std::uint32_t p = 2) : p_(p), magic_((std::uint64_t{1} << 48) / p + 1) {}
  std::uint32_t operator()(std::uint32_t x) const { return x - static_cast<std::uint32_t>((x * magic_) >> 48) * p_; }

 private:
  std::uint32_t p_;
  std::uint64_t magic_;
};

/// One dimension's random permutations.
class Levels {
 public:
  void prepare(const WordSource& words, int dim, std::uint32_t p) {
    p_ = p;
    modulus_ = Modulus(p);
    levels_.prepare(words, dim, p);
    steps_.resize(std::size_t{2} * p * kLanes);
    words.fill(Draw::kScramble, dim, 0, static_cast<int>(2 * p), steps_.data());
    for (std::uint32_t level = 0; level < p; ++level) {
      std::uint32_t *g = row(2 * level), *h = row(2 * level + 1);
      for (int l = 0; l < kLanes; ++l) {
        g[l] = static_cast<std::uint32_t>((std::uint64_t{g[l]} * p) >> 32);
        h[l] = 1 + static_cast<std::uint32_t>((std::uint64_t{h[l]} * (p - 1)) >> 32);
      }
    }
  }
  /// Which of the N strata point number `rank` of `level` goes to, in each lane.
  void strata(std::uint32_t level, std::uint32_t rank, std::uint32_t* out) const {
    levels_.lanes(level, out);
    const std::uint32_t *g = row(2 * level), *h = row(2 * level + 1);
    for (int l = 0; l < kLanes; ++l) out[l] = out[l] * p_ + modulus_(g[l] + h[l] * rank);
  }

 private:
  std::uint32_t* row(std::uint32_t index) { return steps_.data() + std::size_t{index} * kLanes; }
  const std::uint32_t* row(std::uint32_t index) const { return steps_.data() + std::size_t{index} * kLanes; }

  std::uint32_t p_ = 2;
  Modulus modulus_;
  LanePermutation levels_;
  AlignedBuffer<std::uint32_t> steps_;  ///< [level][g, h][lane]
};

class OrthogonalArray final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "orthogonal-array",
        .description =
            "Bose's orthogonal array as a Latin hypercube: every pair stratified; N = p^2, p prime, d <= p + 1",
        .reference = "Bose (1938); Tang (1993); Jarosz et al., Orthogonal array sampling (2019)",
        .max_dims = 1024,
    };
    return kInfo;
  }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    const auto dims = static_cast<std::uint64_t>(layout.dims());
    const std::uint64_t least = std::max<std::uint64_t>(2, dims > 0 ? dims - 1 : 0), most = info().max_count;
    LegalNeighbours neighbours;
    std::uint64_t below = integer_root(std::min(count, most));
    while (below >= least && !is_prime(below)) --below;
    if (below >= least && below * below == count) return std::nullopt;
    if (below >= least) neighbours.below = below * below;
    std::uint64_t above = std::max(least, integer_root(std::min(count, most)) + 1);
    while (above * above <= most && !is_prime(above)) ++above;
    if (above * above <= most) neighbours.above = above * above;
    return neighbours;
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    strata_.reset(request.count);
    p_ = static_cast<std::uint32_t>(integer_root(request.count));
    modulus_ = Modulus(p_);
    dims_.resize(static_cast<std::size_t>(request.layout->dims()));
    for (std::size_t d = 0; d < dims_.size(); ++d) dims_[d].prepare(words_, static_cast<int>(d), p_);
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      const Levels& levels = dims_[static_cast<std::size_t>(d)];
      const auto factor = static_cast<std::uint32_t>(std::max(0, d - 1));
      auto a = static_cast<std::uint32_t>(begin / p_), b = static_cast<std::uint32_t>(begin % p_);
      std::uint32_t* high = block.high(d);
      words_.fill(Draw::kHigh, d, begin, block.samples(), high);
      if (block.has_low_words()) words_.fill_low(d, begin, block.samples(), block.low(d));
      for (int s = 0; s < block.samples(); ++s, high += kLanes) {
        std::uint32_t cells[kLanes];
        if (d == 1) {
          levels.strata(b, a, cells);
        } else {
          levels.strata(modulus_(a + factor * b), b, cells);
        }
        strata_.place_lanes(cells, high);
        if (++b < p_) continue;
        b = 0;
        ++a;
      }
    }
  }

 private:
  WordSource words_;
  Strata strata_;
  std::uint32_t p_ = 2;
  Modulus modulus_;
  std::vector<Levels> dims_;
};

}  // namespace

std::unique_ptr<Sampler> make_orthogonal_array() { return std::make_unique<OrthogonalArray>(); }

}  // namespace halfslope
