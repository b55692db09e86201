// A sampler: steps of 1/g and 1/g² modulo 1, g³ = g + 1, each replicate shifted as a whole (M. Roberts, 2018).
#pragma once

#include "samplers/sampler.h"

class R2 final : public halfslope::Sampler {
 public:
  const halfslope::SamplerInfo& info() const override { return info_; }
  void prepare(const halfslope::PointRequest& request) override { request_ = request; }
  void fill(std::uint64_t begin, halfslope::PointBlock& block) override {
    constexpr std::uint32_t kSteps[] = {3242174889, 2447445414};  // 2³²/g and 2³²/g²
    for (int d = 0; d < block.dims(); ++d) {
      for (std::uint32_t i = 0; i < block.stride(); ++i) {  // kLanes replicates of a point, then the next point
        const auto shift = random_word(request_.key, halfslope::Draw::kHigh, static_cast<std::uint32_t>(d), 0,
                                       request_.replicate + i % halfslope::kLanes, request_.pixel);
        block.high(d)[i] = (static_cast<std::uint32_t>(begin) + i / halfslope::kLanes) * kSteps[d] + shift;
        if (block.has_low_words()) block.low(d)[i] = 0;
      }
    }
  }

 private:
  const halfslope::SamplerInfo info_ = {.name = "r2",
                                        .description = "additive recurrence in two dimensions, shifted",
                                        .reference = "Roberts (2018)",
                                        .sequence = true,
                                        .max_dims = 2};
  halfslope::PointRequest request_;
};
