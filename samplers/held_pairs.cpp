#include "samplers/held_pairs.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "samplers/keyed_hash.h"
#include "samplers/padded.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}};

/// A key for each group's randomisation; the first group keeps the sampler's own.
StreamKey key_of_group(StreamKey key, int dim) {
  if (dim == 0) return key;
  const std::uint64_t word = keyed_pair(static_cast<std::uint64_t>(dim), std::uint64_t{key.word1} << 32 | key.word0, 0);
  return {static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(word >> 32)};
}

class HeldPairs final : public PairSet {
 public:
  explicit HeldPairs(std::shared_ptr<Sampler> sampler) : sampler_(std::move(sampler)) {}

  std::optional<LegalNeighbours> illegal(std::uint64_t count) const override { return sampler_->illegal(count, kPair); }

  void prepare(const PointRequest& request, int dim) override {
    PointRequest pairs = request;
    pairs.layout = &kPair;
    pairs.key = key_of_group(request.key, dim);
    sampler_->prepare(pairs);
    held_.reset(2, static_cast<int>(request.count), request.low_words);
    sampler_->fill(0, held_);
  }

  void points(const PairRows& rows) override {
    copy(rows, held_.high(0), rows.x);
    if (rows.y) copy(rows, held_.high(1), rows.y);
    if (rows.low_x) copy(rows, held_.low(0), rows.low_x);
    if (rows.low_y) copy(rows, held_.low(1), rows.low_y);
  }

 private:
  static void copy(const PairRows& rows, const std::uint32_t* from, std::uint32_t* to) {
    const std::size_t size = static_cast<std::size_t>(rows.rows) * kLanes;
    for (std::size_t i = 0; i < size; ++i) to[i] = from[rows.indices[i] * std::size_t{kLanes} + i % kLanes];
  }

  std::shared_ptr<Sampler> sampler_;
  PointBlock held_;
};

}  // namespace

SamplerInfo padded_family_info() {
  return {.name = "padded:NAME",
          .description = "the pairs of any sampler here, of which each group of dimensions has its own, shuffled",
          .reference = "Kollig & Keller, Efficient multidimensional sampling (2002)",
          .max_dims = kPaddedDims,
          .max_count = kHeldPoints};
}

std::unique_ptr<Sampler> make_padded(const std::string& name, const SamplerCatalogue& catalogue) {
  // One sampler serves all groups, since each holds what it was given.
  const std::shared_ptr<Sampler> sampler = catalogue.make(name);
  SamplerInfo info = sampler->info();
  if (info.max_dims < 2) {
    fail(ExitCode::kBadInput, "there is no sampler 'padded:{}': padding takes pairs, and '{}' has {} dimension", name,
         name, info.max_dims);
  }
  info.name = "padded:" + name;
  info.description += "; padded pairs";
  info.reference += "; " + padded_family_info().reference;
  info.max_dims = kPaddedDims;
  info.max_count = std::min(info.max_count, kHeldPoints);
  // One pair is the sampler's own; of several, each is good by itself and their combinations are random.
  info.rate = [own = info.rate](Regularity regularity, const Layout& layout) -> std::optional<double> {
    if (layout.groups.size() == 1) return own ? own(regularity, layout) : std::nullopt;
    const bool sum = regularity >= Regularity::kOneCoordinateJump;
    return regularity == Regularity::kSquareIntegrable || sum ? std::nullopt : std::optional(-0.5);
  };
  const bool fixed = !info.randomised || info.replicates.has_value();
  info.replicates = std::nullopt;
  if (fixed) {
    info.caveats = {
        name + (info.randomised ? " holds given sets" : " is deterministic") +
        ": replicates share pairs, and only their shuffles are random. Estimates are biased, and replicates "
        "of a single pair of one set agree"};
    info.randomised = true;
  }
  return padded(
      std::move(info), [sampler] { return std::make_unique<HeldPairs>(sampler); }, kHeldPoints);
}

}  // namespace halfslope
