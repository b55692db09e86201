#include "samplers/padded.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "samplers/octave_shuffle.h"
#include "samplers/strata.h"

namespace halfslope {
namespace {

class Padded final : public Sampler {
 public:
  Padded(SamplerInfo info, MakePairSet make, std::uint64_t held)
      : info_(std::move(info)), make_(std::move(make)), held_(held) {
    info_.caveats.insert(info_.caveats.begin(),
                         "beyond two dimensions: independently shuffled pairs, so across the groups of a layout "
                         "nothing is stratified, and what mixes them converges as with independent points");
    groups_.push_back({make_(), {}, {}});
  }

  const SamplerInfo& info() const override { return info_; }

  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout& layout) const override {
    if (count == 0) return LegalNeighbours{std::nullopt, 1};
    // A shuffled sequence takes points of the whole octave that its last point stands in.
    const PairSet& set = *groups_.front().set;
    std::uint64_t most = held_ / std::max<std::size_t>(1, layout.groups.size());
    if (info_.sequence) most = std::bit_floor(most);
    most = std::min(most, info_.max_count);
    if (count > most) {
      const auto neighbours = set.illegal(most);
      return LegalNeighbours{neighbours ? legal_count(neighbours->below) : most, std::nullopt};
    }
    const auto neighbours = set.illegal(info_.sequence ? std::bit_ceil(count) : count);
    if (!neighbours) return std::nullopt;
    if (info_.sequence) return LegalNeighbours{legal_count(neighbours->below), std::nullopt};
    if (neighbours->above && *neighbours->above > most) return LegalNeighbours{neighbours->below, std::nullopt};
    return neighbours;
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    layout_ = request.layout;
    while (groups_.size() < layout_->groups.size()) groups_.push_back({make_(), {}, {}});
    int dim = 0;
    for (std::size_t g = 0; g < layout_->groups.size(); ++g) {
      PointRequest wanted = request;
      if (info_.sequence && g > 0) {
        groups_[g].octaves.prepare(words_, dim);
        wanted.count = std::bit_ceil(request.count);
      } else if (!info_.sequence) {
        groups_[g].permutation.prepare(words_, dim, request.count);
      }
      groups_[g].set->prepare(wanted, dim);
      dim += layout_->groups[g];
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    indices_.resize(block.stride());
    int dim = 0;
    for (std::size_t g = 0; g < layout_->groups.size(); ++g) {
      const bool pair = layout_->groups[g] == 2;
      indices(g, begin, block.samples());
      for (int d = dim; d < dim + layout_->groups[g] && block.has_low_words(); ++d) {
        words_.fill_low(d, begin, block.samples(), block.low(d));
      }
      groups_[g].set->points({begin, block.samples(), indices_.data(), block.high(dim),
                              pair ? block.high(dim + 1) : nullptr, block.low(dim),
                              pair ? block.low(dim + 1) : nullptr});
      dim += layout_->groups[g];
    }
  }

 private:
  struct Group {
    std::unique_ptr<PairSet> set;
    LanePermutation permutation;
    OctaveShuffle octaves;
  };

  std::optional<std::uint64_t> legal_count(std::optional<std::uint64_t> points) const {
    if (points && info_.sequence) return std::bit_floor(*points);
    return points;
  }

  /// Which points of its set the samples of group g are.
  void indices(std::size_t g, std::uint64_t begin, int samples) {
    std::uint32_t* out = indices_.data();
    if (info_.sequence && g > 0) return groups_[g].octaves.rows(begin, samples, out);
    for (int s = 0; s < samples; ++s, out += kLanes) {
      const std::uint64_t index = begin + static_cast<std::uint64_t>(s);
      if (info_.sequence) {
        std::fill_n(out, kLanes, static_cast<std::uint32_t>(index));
      } else {
        groups_[g].permutation.lanes(index, out);
      }
    }
  }

  SamplerInfo info_;
  MakePairSet make_;
  std::uint64_t held_;
  WordSource words_;
  const Layout* layout_ = nullptr;
  std::vector<Group> groups_;  // one at least, to ask for legal counts
  AlignedBuffer<std::uint32_t> indices_;
};

}  // namespace

std::unique_ptr<Sampler> padded(SamplerInfo info, MakePairSet make, std::uint64_t held) {
  return std::make_unique<Padded>(std::move(info), std::move(make), held);
}

}  // namespace halfslope
