#include "analysis/comparison_bootstrap.h"

#include <cmath>
#include <limits>

#include "analysis/bootstrap.h"

namespace halfslope {

ComparisonBootstrap::ComparisonBootstrap(const std::vector<std::vector<double>>& deviations,
                                         std::span<const ColumnPair> pairs)
    : rows_(deviations.at(0).size()), columns_(deviations.size()), pairs_(pairs.begin(), pairs.end()) {
  const std::size_t sums = 2 * columns_ + pairs_.size();
  products_.reserve((sums + sums % 2) * rows_);
  for (const auto& d : deviations) products_.insert(products_.end(), d.begin(), d.end());
  for (const auto& d : deviations) {
    for (const double x : d) products_.push_back(x * x);
  }
  for (const auto& [a, b] : pairs_) {
    for (std::size_t r = 0; r < rows_; ++r) {
      const double difference = deviations[a][r] - deviations[b][r];
      products_.push_back(difference * difference);
    }
  }
  products_.resize((sums + sums % 2) * rows_);
}

void ComparisonBootstrap::draw_weights(std::uint64_t seed, std::uint32_t first, std::vector<double>& weights) const {
  std::vector<std::uint32_t> indices(rows_);
  weights.assign(rows_ * kLanes, 0.0);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    draw_resample(seed, first + static_cast<std::uint32_t>(lane), static_cast<std::uint32_t>(rows_), indices);
    for (const std::uint32_t index : indices) weights[index * kLanes + lane] += 1;
  }
}

// Two columns at a time share the loads of the weights; each lane's sum runs over the rows in order, on any machine.
void ComparisonBootstrap::add_up(const std::vector<double>& weights, std::vector<double>& sums) const {
  for (std::size_t column = 0; column * rows_ < products_.size(); column += 2) {
    const double *x = &products_[column * rows_], *y = x + rows_;
    double sum_x[kLanes] = {}, sum_y[kLanes] = {};
    for (std::size_t r = 0; r < rows_; ++r) {
      const double* w = &weights[r * kLanes];
      for (std::size_t lane = 0; lane < kLanes; ++lane) sum_x[lane] += w[lane] * x[r];
      for (std::size_t lane = 0; lane < kLanes; ++lane) sum_y[lane] += w[lane] * y[r];
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sums[column * kLanes + lane] = sum_x[lane];
      sums[(column + 1) * kLanes + lane] = sum_y[lane];
    }
  }
}

float ComparisonBootstrap::studentised(const ColumnPair& pair, std::size_t index, std::size_t lane,
                                       const std::vector<double>& sums, const std::vector<double>& logs) const {
  const auto sum = [&](std::size_t column) { return sums[column * kLanes + lane]; };
  const auto n = static_cast<double>(rows_);
  const double ratio_a = 1 + sum(pair.a) / n, ratio_b = 1 + sum(pair.b) / n;
  if (!(ratio_a > 0 && ratio_b > 0)) return std::numeric_limits<float>::infinity();
  const double differences = sum(2 * columns_ + index), squares_a = sum(columns_ + pair.a),
               squares_b = sum(columns_ + pair.b);
  const double mean = (ratio_a - ratio_b) / (ratio_a * ratio_b);
  const double squares =
      (differences + (ratio_b - ratio_a) * (squares_a / ratio_a - squares_b / ratio_b)) / (ratio_a * ratio_b);
  const double spread = squares - n * mean * mean;
  // What is left of equal influences after rounding is no spread.
  if (!(spread > 1e-12 * squares)) return std::numeric_limits<float>::infinity();
  const double change = logs[pair.a * kLanes + lane] - logs[pair.b * kLanes + lane];
  return static_cast<float>(std::abs(change) / std::sqrt(spread / (n * (n - 1))));
}

std::vector<std::vector<float>> ComparisonBootstrap::studentised(std::uint64_t seed, int count) const {
  const auto resamples = static_cast<std::size_t>(count);
  std::vector<std::vector<float>> result(pairs_.size(), std::vector<float>(resamples));
  std::vector<double> weights, sums(products_.size() / rows_ * kLanes), logs(columns_ * kLanes);
  for (std::size_t first = 0; first < resamples; first += kLanes) {
    draw_weights(seed, static_cast<std::uint32_t>(first), weights);
    add_up(weights, sums);
    for (std::size_t i = 0; i < logs.size(); ++i) logs[i] = std::log1p(sums[i] / static_cast<double>(rows_));
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      for (std::size_t lane = 0; lane < kLanes && first + lane < resamples; ++lane)
        result[p][first + lane] = studentised(pairs_[p], p, lane, sums, logs);
    }
  }
  return result;
}

}  // namespace halfslope
