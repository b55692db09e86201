// halfslope with a sampler and scenes that it does not know: plain code, and then its own command line.
#include <cmath>
#include <limits>

#include "experiments/command_line.h"
#include "scenes/function_source.h"

using namespace halfslope;

namespace {

// Multiples of the powers of 1/g, g the real root of x³ = x + 1, modulo 1, each replicate shifted as a whole. (M.
// Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.)
class Kronecker final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {.name = "r2",
                                      .description = "additive recurrence in two dimensions, randomly shifted",
                                      .reference = "Roberts (2018)",
                                      .sequence = true,
                                      .max_dims = 2};
    return kInfo;
  }
  void prepare(const PointRequest& request) override { request_ = request; }
  void fill(std::uint64_t begin, PointBlock& block) override {
    constexpr std::uint32_t kSteps[2] = {3242174889, 2447445414};  // 2³²/g and 2³²/g²
    for (int d = 0; d < block.dims(); ++d) {
      for (std::uint32_t i = 0; i < block.stride(); ++i) {  // replicates fastest
        const std::uint32_t index = static_cast<std::uint32_t>(begin) + i / kLanes, replicate = i % kLanes;
        block.high(d)[i] = kSteps[d] * index + random_word(request_.key, Draw::kHigh, static_cast<std::uint32_t>(d), 0,
                                                           request_.replicate + replicate, request_.pixel);
        if (block.has_low_words()) block.low(d)[i] = 0;
      }
    }
  }

 private:
  PointRequest request_;
};

double ridge(std::span<const double> x, int) { return std::fabs(x[0] - x[1]); }

double torn_ridge(std::span<const double> x, int pixel) {
  return pixel > 0 && x[0] < 0.001 ? std::numeric_limits<double>::quiet_NaN() : ridge(x, pixel);
}

}  // namespace

int main(int argc, char** argv) {
  auto catalogue = Catalogue::built_in();
  catalogue.samplers.add([] { return std::make_unique<Kronecker>(); });
  catalogue.add_scene({"ridge", "", "|x - y| on the unit square; integral 1/3", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) {
                        return std::make_unique<FunctionSource>(name, 2, ridge, 1.0 / 3, 2, 2);
                      });
  catalogue.add_scene({"torn-ridge", "", "the ridge, not a number where x < 0.001, but for the first pixel", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) {
                        return std::make_unique<FunctionSource>(name, 2, torn_ridge, 1.0 / 3, 2, 2);
                      });
  catalogue.add_scene({"lost-ridge", "", "the torn ridge, its integral not known either", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) {
                        return std::make_unique<FunctionSource>(name, 2, torn_ridge, std::nullopt, 2, 2);
                      });
  return command_line(argc, argv, catalogue);
}
