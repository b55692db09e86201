#include "samplers/correlated_multi_jittered.h"

#include "samplers/multi_jittered_grid.h"
#include "samplers/padded.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

class CorrelatedMultiJittered final : public PairSet {
 public:
  void prepare(const PointRequest& request, int dim) override {
    grid_.prepare(request, dim);
    of_rows_.prepare(grid_.words(), dim, grid_.grid().rows, kSetWords);
    of_columns_.prepare(grid_.words(), dim, grid_.grid().columns, 2 * kSetWords);
  }
  void points(const PairRows& rows) override {
    grid_.fill(
        rows,
        [this](std::uint32_t, std::uint32_t row, int lane) {
          return static_cast<std::uint32_t>(of_rows_.at(row, lane));
        },
        [this](std::uint32_t column, std::uint32_t, int lane) {
          return static_cast<std::uint32_t>(of_columns_.at(column, lane));
        });
  }

 private:
  MultiJitteredGrid grid_;
  LanePermutation of_rows_, of_columns_;
};

}  // namespace

std::unique_ptr<Sampler> make_correlated_multi_jittered() {
  return padded({.name = "correlated-multi-jittered",
                 .description = "multi-jittered pairs whose columns share one shuffle, and rows one; any N = a*b",
                 .reference = "Kensler, Correlated multi-jittered sampling (2013)",
                 .max_dims = kPaddedDims,
                 .rate = stratified_pairs_rate},
                [] { return std::make_unique<CorrelatedMultiJittered>(); });
}

}  // namespace halfslope
