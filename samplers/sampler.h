// What a sampler is: it fills blocks of points, and everything downstream only reads them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/generator_matrices.h"
#include "core/layout.h"
#include "core/point_block.h"
#include "core/random.h"
#include "core/regularity.h"

namespace halfslope {

/// The slope of log RMSE against log N that a theorem promises; empty where none does.
using RateTheory = std::function<std::optional<double>(Regularity regularity, const Layout& layout)>;

/// What a sampler declares of itself.
struct SamplerInfo {
  std::string name, description, reference;
  /// A sequence is good at every prefix, so one pass gives every N on the way; a set is made for one N.
  bool sequence = false;
  /// A deterministic sampler has one replicate, and the same points in every pixel.
  bool randomised = true;
  /// Estimates are unbiased: each point is uniform, or (jittered points) one picked from the set at random is.
  bool unbiased = true;
  int max_dims = 0;
  std::uint64_t max_count = std::uint64_t{1} << 31;
  /// The rate that theory gives for an integrand of that class, as an exponent of N; see samplers/theory.h. Null: none.
  RateTheory rate = nullptr;
  /// The replicates there are, where they cannot be made at will: such a sampler always runs all of them.
  std::optional<std::int64_t> replicates = std::nullopt;
  /// What the points depend on beside the name, such as a file's contents; part of what a run is.
  std::string fingerprint = {};
  /// What every user of these points should know before reading a number: lines for --dry-run.
  std::vector<std::string> caveats = {};

  /// How many replicates it runs where `asked` are asked for.
  std::int64_t replicates_of(std::int64_t asked) const { return randomised ? replicates.value_or(asked) : 1; }
};

/// The nearest legal counts around an illegal one.
struct LegalNeighbours {
  std::optional<std::uint64_t> below, above;
};

/// Which points to prepare: `count` points whose dimensions are grouped by `layout`, for replicates `replicate` to
/// `replicate` + kLanes − 1 of the pixel.
struct PointRequest {
  std::uint64_t count = 0;
  const Layout* layout = nullptr;  ///< must outlive the fills
  StreamKey key;
  std::uint32_t pixel = 0, replicate = 0;
  bool low_words = false;  ///< for binary64
};

/// Makes points, a block at a time. Not shared between threads; each asks its catalogue for one.
class Sampler {
 public:
  virtual ~Sampler() = default;
  virtual const SamplerInfo& info() const = 0;
  /// Whether `count` points of this layout exist; if not, the legal counts next to it.
  virtual std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const {
    const std::uint64_t most = info().max_count;
    (void)layout;
    if (count == 0) return LegalNeighbours{std::nullopt, 1};
    if (count > most) return LegalNeighbours{most, std::nullopt};
    return std::nullopt;
  }
  /// Makes ready; cheap, since it is called for every pixel and group of replicates.
  virtual void prepare(const PointRequest& request) = 0;
  /// Fills points [begin, begin + block.samples()) of what was prepared, in any order of calls. `block` has the
  /// layout's dims; low words are filled where it has them.
  virtual void fill(std::uint64_t begin, PointBlock& block) = 0;
  /// The generator matrices of the first base^digits points in `dims` dimensions, if they are a digital net or a
  /// scramble or digital shift of one, which leave its t as it is; nothing where they are none, or beyond its digits.
  virtual std::optional<GeneratorMatrices> generator_matrices(int dims, int digits) const {
    (void)dims, (void)digits;
    return std::nullopt;
  }
};

}  // namespace halfslope
