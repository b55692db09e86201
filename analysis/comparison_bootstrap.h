// The resamples of a table of errors, as comparisons of its columns see them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halfslope {

/// Two columns of a table, by their index.
struct ColumnPair {
  std::size_t a, b;
  bool operator==(const ColumnPair&) const = default;
};

/// |T*| of the comparisons of columns, resampling rows jointly over the whole table.
///
/// With deviations d_rk = (e²_rk − M_k)/(M_k − V̄_k) of R rows and a resample that takes row r w_r times, the columns'
/// ratios are ρ_k = 1 + Σ_r w_r d_rk / R, a pair's change is log ρ_a − log ρ_b, and its standard error that of the mean
/// of the resample's influences u_r = d_ra/ρ_a − d_rb/ρ_b:
///
///   Σ w u² = [Σ w (d_a − d_b)² + (ρ_b − ρ_a)(Σ w d_a²/ρ_a − Σ w d_b²/ρ_b)] / (ρ_a ρ_b),   Σ w u = R (1/ρ_b − 1/ρ_a),
///
/// which loses nothing where two columns are nearly equal, as common samples make them. So a resample costs sums of
/// three kinds of fixed columns, d, d² and (d_a − d_b)², with one vector of weights: a product of matrices.
class ComparisonBootstrap {
 public:
  /// `deviations`: one vector of R ≥ 2 for each column.
  ComparisonBootstrap(const std::vector<std::vector<double>>& deviations, std::span<const ColumnPair> pairs);

  /// |T*| of every pair, [pair][resample] for resamples 0 … count − 1 of `seed` (draw_resample). Infinite, the cautious
  /// side, where a ratio is not positive or all influences drawn are equal.
  std::vector<std::vector<float>> studentised(std::uint64_t seed, int count) const;

 private:
  static constexpr std::size_t kLanes = 8;  ///< resamples at once

  std::size_t rows_, columns_;
  std::vector<ColumnPair> pairs_;
  std::vector<double> products_;  ///< [column of sums][row]: d of every column, d² of every column, (d_a − d_b)²

  void draw_weights(std::uint64_t seed, std::uint32_t first, std::vector<double>& weights) const;
  void add_up(const std::vector<double>& weights, std::vector<double>& sums) const;
  float studentised(const ColumnPair& pair, std::size_t index, std::size_t lane, const std::vector<double>& sums,
                    const std::vector<double>& logs) const;
};

}  // namespace halfslope
