// The optimal weights: those of least variance, negative ones allowed (I. Kondapaneni, P. Vévoda, P. Grittmann,
// T. Skřivan, P. Slusallek and J. Křivánek, "Optimal multiple importance sampling", 2019).
//
// With c_k samples of technique k a round and c(x) = Σ_k c_k p_k(x), they are
//
//   w_i = c_i p_i / c + (α_i − c_i Σ_k α_k p_k / c) p_i / f,   A α = b,
//   A_ij = ∫ p_i p_j / c,   b_i = ∫ f p_i / c,
//
// and the round's estimator is the balance heuristic's with Σ_k α_k p_k, whose integral Σ_k α_k is known, as a control
// variate: F = Σ_k α_k + Σ_samples (f − Σ_k α_k p_k) / c. Since ∫ (f − Σ α_k p_k) p_i / c = 0 for every i, its variance
// is ∫ (f − Σ α_k p_k)² / c.
//
// Neither A nor b is known; the samples estimate both. Let w_k = c_k p_k / c now be the balance heuristic's weights,
// y = f / c the sample's contribution to the balance heuristic and α_k = c_k β_k. Then
//
//   F = Σ_k c_k β_k + Σ_samples (y − Σ_k β_k w_k)   and   Σ_samples w wᵀ β = Σ_samples y w:
//
// β is the least-squares fit of y to w, where all numbers lie in [0, 1] whatever the densities are. The right sum of F
// is 1ᵀ(b − A β), as Σ_k w_k = 1, so that sums over the samples of w wᵀ and y w are all there is to keep.
//
// Samples that are worth nothing count too: the fit has to know how often f is 0. Where one comes with every density 0,
// as those of rendered scenes do that meet no light, it stands for an outcome that its technique alone has: w is 1 for
// that technique and 0 for the others. On the space with such outcomes every density integrates to 1 again, so nothing
// above changes. Only where several techniques may draw the same worthless direction (bsdf and cosine; light and bsdf
// behind a blocker) does telling them apart cost something: the variance is then a little above the least.
//
//   direct        β from all the samples that it is used on. F is then Σ_k α_k, the paper's direct estimator. Its bias
//                 falls as 1/N, its standard error as 1/√N.
//   progressive   β from earlier samples, so that each round is unbiased where rounds are independent: 0 at first (the
//                 balance heuristic), then solved anew after m, 2m, 4m, … rounds, m the first power of two with 8
//                 samples a technique. N alone decides where, so a prefix of a run is the run of the prefix.
//
// A is singular where densities are linearly dependent (two of them equal, say) and wherever there are fewer samples
// than techniques. β is then the shortest solution: eigenvalues below a tolerance of the largest count as 0. The
// tolerance is above what rounding of the densities puts in their place (2⁻²⁰ in binary32, 2⁻⁴⁶ in binary64), and what
// it leaves out is made good by the right sum of F, which any β leaves right in the mean.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/point_block.h"

namespace halfslope {

/// Estimates by the optimal weights from sums over rounds, for kLanes replicates and each channel.
class OptimalSolver {
 public:
  /// `counts`: samples of each technique in a round, at most 16 techniques. `tolerance`: eigenvalues below it, times
  /// the largest, count as 0.
  OptimalSolver(std::span<const int> counts, int channels, double tolerance);
  static double tolerance(bool binary32) { return binary32 ? 0x1p-20 : 0x1p-46; }

  /// How many sums there are: of w_i w_j for i ≥ j, row by row, then for each channel of y w_i.
  std::size_t sums() const;

  /// `totals` here and below: kLanes numbers for each sum, over `rounds` rounds. out[c * kLanes + l] receives channel c
  /// of lane l.
  void direct(std::span<const double> totals, std::uint64_t rounds, double* out) const;

  /// Begins anew, with β = 0.
  void clear();
  /// The number of rounds, more than `rounds`, after which update() is due.
  std::uint64_t next_update(std::uint64_t rounds) const;
  /// Solves for the β of the rounds to come.
  void update(std::span<const double> totals, std::uint64_t rounds);
  void progressive(std::span<const double> totals, std::uint64_t rounds, double* out) const;

 private:
  static constexpr int kMostTechniques = 16, kMostChannels = 3;
  using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostTechniques, kMostTechniques>;
  using Moments =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostTechniques, kMostChannels>;
  using Channels = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMostChannels>;

  /// One lane's sums: Σ w wᵀ and, a column a channel, Σ y w.
  struct Regression {
    Gram gram;
    Moments moments;
  };
  /// One lane's progress: Σ F over the rounds to the last update, the sums then, and β since.
  struct Progress {
    Channels settled;
    Regression sums;
    Moments beta;
  };

  Regression regression(std::span<const double> totals, std::size_t lane) const;
  Moments solve(const Regression& sums) const;
  /// Σ F over rounds with these sums.
  Channels estimate(const Regression& sums, const Moments& beta, double rounds) const;
  Channels progress(const Progress& lane, const Regression& sums, std::uint64_t rounds) const;

  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostTechniques, 1> counts_;
  int channels_;
  double tolerance_;
  std::uint64_t first_update_;
  std::uint64_t updated_ = 0;  ///< rounds to the last update
  std::array<Progress, kLanes> lanes_;
};

}  // namespace halfslope
