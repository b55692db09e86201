#include "samplers/stratified.h"

#include <cmath>
#include <vector>

#include "samplers/strata.h"
#include "samplers/theory.h"

namespace halfslope {
namespace {

class Stratified final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "stratified",
        .description = "one point in each cell of a grid for every 1-D and 2-D group, groups shuffled; any N = a*b",
        .reference = "Cook, Porter & Carpenter, Distributed ray tracing (1984)",
        .max_dims = 1024,
        .rate = grouped_grid_rate,
    };
    return kInfo;
  }

  void prepare(const PointRequest& request) override {
    words_.prepare(request);
    if (request.count != count_) {
      count_ = request.count;
      line_.reset(count_);
      grid_ = squarest_grid(count_);
      columns_.reset(grid_.columns);
      rows_.reset(grid_.rows);
    }
    layout_ = request.layout;
    permutations_.resize(layout_->groups.size());
    for (std::size_t g = 0; g < permutations_.size(); ++g) {
      permutations_[g].prepare(words_, static_cast<int>(g), request.count);
    }
  }

  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      words_.fill(Draw::kHigh, d, begin, block.samples(), block.high(d));
      if (block.has_low_words()) words_.fill_low(d, begin, block.samples(), block.low(d));
    }
    int dim = 0;
    for (std::size_t g = 0; g < permutations_.size(); ++g) {
      const LanePermutation& permutation = permutations_[g];
      const bool pair = layout_->groups[g] == 2;
      std::uint32_t* x = block.high(dim);
      std::uint32_t* y = pair ? block.high(dim + 1) : nullptr;
      for (int s = 0; s < block.samples(); ++s, x += kLanes) {
        std::uint32_t cells[kLanes];
        permutation.lanes(begin + static_cast<std::uint64_t>(s), cells);
        if (!pair) {
          line_.place_lanes(cells, x);
          continue;
        }
        std::uint32_t columns[kLanes], rows[kLanes];
        const auto width = static_cast<std::uint32_t>(grid_.columns);
        for (int l = 0; l < kLanes; ++l) {
          rows[l] = cells[l] / width;
          columns[l] = cells[l] - rows[l] * width;
        }
        columns_.place_lanes(columns, x);
        rows_.place_lanes(rows, y);
        y += kLanes;
      }
      dim += layout_->groups[g];
    }
  }

 private:
  WordSource words_;
  std::uint64_t count_ = 0;
  Grid grid_ = {1, 1};
  Strata line_, columns_, rows_;
  const Layout* layout_ = nullptr;
  std::vector<LanePermutation> permutations_;
};

}  // namespace

Grid squarest_grid(std::uint64_t count) {
  auto rows = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(count)));
  while (rows > 1 && count % rows != 0) --rows;
  return {count / rows, rows};
}

std::unique_ptr<Sampler> make_stratified() { return std::make_unique<Stratified>(); }

}  // namespace halfslope
