#pragma once

#include <functional>
#include <limits>
#include <memory>

#include "samplers/pair_set.h"

namespace halfslope {

using MakePairSet = std::function<std::unique_ptr<PairSet>()>;

/// The points that all groups of a sampler together may hold in memory, kLanes replicates each: 32 MB of high words.
inline constexpr std::uint64_t kHeldPoints = std::uint64_t{1} << 18;

/// Gives a two-dimensional point set any number of dimensions: each group of the layout has a randomisation of its own,
/// a single dimension takes its first coordinate. Groups are shuffled independently, so that dimensions of different
/// groups are uncorrelated: of a set (info.sequence false) every group, by a LanePermutation; of a sequence the first
/// group keeps its order, and the others are shuffled by an OctaveShuffle, so that prefixes stay what they are.
///
/// `info` is the set's, to which the caveat of padding is added. `held` is the most points that all groups together
/// may have, where the set holds its points in memory.
///
/// T. Kollig & A. Keller, "Efficient multidimensional sampling" (2002), call it padding.
std::unique_ptr<Sampler> padded(SamplerInfo info, MakePairSet make,
                                std::uint64_t held = std::numeric_limits<std::uint64_t>::max());

/// Dimensions that padded() is declared for.
inline constexpr int kPaddedDims = 1024;

}  // namespace halfslope
