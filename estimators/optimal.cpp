#include "estimators/optimal.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace halfslope {
namespace {

constexpr std::uint64_t kFirstSamples = 8;  // a technique, before the first update

}  // namespace

OptimalSolver::OptimalSolver(std::span<const int> counts, int channels, double tolerance)
    : counts_(static_cast<Eigen::Index>(counts.size())), channels_(channels), tolerance_(tolerance) {
  for (std::size_t k = 0; k < counts.size(); ++k) counts_[static_cast<Eigen::Index>(k)] = counts[k];
  const auto round = static_cast<std::uint64_t>(std::accumulate(counts.begin(), counts.end(), 0));
  first_update_ = std::bit_ceil((kFirstSamples * counts.size() + round - 1) / round);
  clear();
}

std::size_t OptimalSolver::sums() const {
  const auto n = static_cast<std::size_t>(counts_.size());
  return n * (n + 1) / 2 + n * static_cast<std::size_t>(channels_);
}

OptimalSolver::Regression OptimalSolver::regression(std::span<const double> totals, std::size_t lane) const {
  const Eigen::Index n = counts_.size();
  Regression sums = {Gram(n, n), Moments(n, channels_)};
  std::size_t next = lane;
  const auto take = [&] {
    const double total = totals[next];
    next += kLanes;
    return total;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) sums.gram(i, j) = sums.gram(j, i) = take();
  }
  for (Eigen::Index c = 0; c < channels_; ++c) {
    for (Eigen::Index i = 0; i < n; ++i) sums.moments(i, c) = take();
  }
  return sums;
}

OptimalSolver::Moments OptimalSolver::solve(const Regression& sums) const {
  const Eigen::Index n = counts_.size();
  if (!sums.gram.allFinite()) return Moments::Constant(n, channels_, std::numeric_limits<double>::quiet_NaN());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(sums.gram);
  const auto& values = eigen.eigenvalues();  // ascending
  Moments beta = Moments::Zero(n, channels_);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!(values[k] > tolerance_ * values[n - 1])) continue;
    const auto direction = eigen.eigenvectors().col(k);
    for (Eigen::Index c = 0; c < channels_; ++c)
      beta.col(c) += direction * (direction.dot(sums.moments.col(c)) / values[k]);
  }
  return beta;
}

OptimalSolver::Channels OptimalSolver::estimate(const Regression& sums, const Moments& beta, double rounds) const {
  return rounds * (counts_.transpose() * beta) + (sums.moments - sums.gram * beta).colwise().sum();
}

OptimalSolver::Channels OptimalSolver::progress(const Progress& lane, const Regression& sums,
                                                std::uint64_t rounds) const {
  const Regression since = {sums.gram - lane.sums.gram, sums.moments - lane.sums.moments};
  return lane.settled + estimate(since, lane.beta, static_cast<double>(rounds - updated_));
}

void OptimalSolver::direct(std::span<const double> totals, std::uint64_t rounds, double* out) const {
  const auto count = static_cast<double>(rounds);
  for (std::size_t l = 0; l < kLanes; ++l) {
    const Regression sums = regression(totals, l);
    const Channels estimates = estimate(sums, solve(sums), count) / count;
    for (Eigen::Index c = 0; c < channels_; ++c) out[static_cast<std::size_t>(c) * kLanes + l] = estimates[c];
  }
}

void OptimalSolver::clear() {
  const Eigen::Index n = counts_.size();
  updated_ = 0;
  lanes_.fill(
      {Channels::Zero(channels_), {Gram::Zero(n, n), Moments::Zero(n, channels_)}, Moments::Zero(n, channels_)});
}

std::uint64_t OptimalSolver::next_update(std::uint64_t rounds) const {
  return std::max(first_update_, std::bit_floor(rounds) * 2);
}

void OptimalSolver::update(std::span<const double> totals, std::uint64_t rounds) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const Regression sums = regression(totals, l);
    lanes_[l].settled = progress(lanes_[l], sums, rounds);
    lanes_[l].beta = solve(sums);
    lanes_[l].sums = sums;
  }
  updated_ = rounds;
}

void OptimalSolver::progressive(std::span<const double> totals, std::uint64_t rounds, double* out) const {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const Channels estimates = progress(lanes_[l], regression(totals, l), rounds) / static_cast<double>(rounds);
    for (Eigen::Index c = 0; c < channels_; ++c) out[static_cast<std::size_t>(c) * kLanes + l] = estimates[c];
  }
}

}  // namespace halfslope
